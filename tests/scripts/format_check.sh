#!/usr/bin/env bash
# format_check.sh SOURCE: scripts/format.sh of that source folder names what is not laid out, and lays it out, in a small tree of
# its own. Exit status 77 where it cannot be tried.
set -euo pipefail
source=$1

command -v clang-format-14 >/dev/null || exit 77
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p scripts kernels/core bvh host effects filters tests benchmarks data/generator
cp "$source/scripts/format.sh" scripts
cp "$source/.clang-format" .

# expect STATUS TEXT ARGUMENT...: what the script says, all of it, and ends with.
expect() {
    local wanted=$1 text=$2 said status=0
    shift 2
    said=$(bash scripts/format.sh "$@" 2>&1) || status=$?
    if [ "$status" -ne "$wanted" ] || [ "$said" != "$text" ]; then
        echo "format.sh $*: status $status in place of $wanted, or not '$text': $said"
        exit 1
    fi
}

printf 'int one();\n' >host/one.cpp
expect 0 "" --check
expect 2 "format.sh: error: wrong call: --chekc: give --check, or nothing" --chekc
expect 2 "format.sh: error: wrong call: --check host: give --check, or nothing" --check host
for file in host/two.h kernels/core/two.cl data/generator/two.cpp; do
    printf 'int  two();\nint  three();\n' >"$file"
    expect 1 "not formatted, run scripts/format.sh:
  $file" --check
    grep -q 'int  two' "$file" # as it was
    expect 0 ""
    [ "$(cat "$file")" = $'int two();\nint three();' ]
    expect 0 "" --check
done
