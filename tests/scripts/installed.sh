#!/usr/bin/env bash
# installed.sh CMAKE BUILD: what `cmake --install` puts in place is whole, and the program runs from there: it lists devices and
# renders an installed scene, and bash completes its calls.
set -euo pipefail
cmake=$1
build=$2

prefix=$build/installed
rm -rf "$prefix"
"$cmake" --install "$build" --prefix "$prefix" >/dev/null
trap 'rm -rf "$prefix"' EXIT
export WEDGE_CACHE_DIR=$build/app_test_cache

fail() {
    echo "$*"
    exit 1
}
for file in bin/wedge share/wedge/scenes/cornell.toml share/doc/wedge/README.md share/doc/wedge/LICENSE \
    share/doc/wedge/docs/command-line.md share/bash-completion/completions/wedge; do
    [ -f "$prefix/$file" ] || fail "not installed: $file"
done

mkdir "$prefix/work"
cd "$prefix/work"
wedge=../bin/wedge
"$wedge" devices | grep -q '^ *0' || fail "wedge devices lists none: $("$wedge" devices)"
for scene in ../share/wedge/scenes/*.toml; do
    "$wedge" info "$scene" >/dev/null || fail "not whole: $scene"
done
"$wedge" render ../share/wedge/scenes/cornell.toml --size 32x24 --spp 9 -o a.exr -o a.png --quiet
"$wedge" compare a.exr a.exr >/dev/null

# completes WORD...: $expected is what completes the last of them.
# shellcheck source=/dev/null
source "$prefix/share/bash-completion/completions/wedge"
completes() {
    COMP_WORDS=("$wedge" "$@")
    COMP_CWORD=$#
    _wedge
    [ "${COMPREPLY[*]}" = "$expected" ] || fail "completing '$*': '${COMPREPLY[*]}' in place of '$expected'"
}
complete -p wedge >/dev/null
expected="render" completes re
expected="--bounces" completes render x.toml --boun
expected="--no-antialias" completes render --no-a
expected="mc aaf maaf" completes render --method ""
expected="aaf" completes render --method aa
expected="fast" completes render --bvh = f
expected="rmse relmse" completes compare --metric r
expected="a.exr" completes compare a.e
expected="" completes render --nothing
