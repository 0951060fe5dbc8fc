#!/usr/bin/env bash
# tidy_changed.sh SOURCE: scripts/tidy.sh of that source folder finds what is wrong in the files that changed, and only in
# them, in a small repository of its own. Exit status 77 where it cannot be tried.
set -euo pipefail
source=$1

command -v clang-tidy-14 >/dev/null && command -v git >/dev/null || exit 77
folder=$(cd -P "$(mktemp -d)" && pwd)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p scripts host build/release
cp "$source/scripts/tidy.sh" scripts
cp "$source/.clang-tidy" .
echo /build/ >.gitignore
git init --quiet
commit() { # the id of a commit of all files
    git add -A
    git -c user.name=test -c user.email=test@localhost commit --quiet --message "$1"
    git rev-parse HEAD
}
# Files that are compiled; the database has them all, in the form that CMake gives it.
compiles() { # FILE...
    local file separator='['
    for file in "$@"; do
        printf '%s\n{\n  "directory": "%s",\n  "command": "c++ -std=c++20 -I. -c %s",\n  "file": "%s"\n}' "$separator" "$folder" \
            "$folder/$file" "$folder/$file"
        separator=,
    done >build/release/compile_commands.json
    printf ']\n' >>build/release/compile_commands.json
}
# expect STATUS TEXT ARGUMENT...: what the script says, and ends with.
expect() {
    local wanted=$1 text=$2 said status=0
    shift 2
    said=$(bash scripts/tidy.sh "$@" 2>&1) || status=$?
    if [ "$status" -ne "$wanted" ] || [[ $said != *"$text"* ]]; then
        echo "tidy.sh $*: status $status in place of $wanted, or no '$text': $said"
        exit 1
    fi
    if [ "$wanted" -eq 2 ] && { [[ $said != "tidy.sh: error: "* ]] || [ "$(wc -l <<<"$said")" -ne 1 ]; }; then
        echo "tidy.sh $*: not one line of an error: $said"
        exit 1
    fi
}
good() { printf 'const int* %s() { return nullptr; }\n' "$1"; }
bad() { printf 'const int* %s() { return 0; }\n' "$1"; } # modernize-use-nullptr

bad old >host/old.cpp
good first >host/first.cpp
compiles host/old.cpp host/first.cpp host/second.cpp
printf '# what it is\n%s\n' 0123456789012345678901234567890123456789 >scripts/last_release
released=$(commit "what was there")
expect 0 "no tag, nor commit 0123456789012345678901234567890123456789, in this clone: looking at uncommitted changes alone"
sed -i "2s/.*/$released/" scripts/last_release

expect 2 "unknown argument: --nope" --nope
expect 2 "unknown argument: host/first.cpp" host/first.cpp
expect 2 "--since: nothing" --since
expect 2 "--since: nowhere: no such commit" --since nowhere
expect 2 "--all --since: give one of them" --all --since HEAD
expect 2 "--seconds: 0" --seconds 0
expect 2 "elsewhere/compile_commands.json: not there" --build elsewhere

# Nothing changed but a file that is not compiled; then two that are good, and one that is not.
expect 0 "no files to look at (since $released)"
echo >>host/first.cpp
good second >host/second.cpp
expect 0 "2 files (since $released): nothing found"
bad second >host/second.cpp
expect 1 "host/second.cpp:1:30: error: use nullptr"
changed=$(commit "a second file")
expect 1 "2 files (since $released): findings above"
expect 0 "no files to look at (since $changed)" --since "$changed"
expect 1 "host/old.cpp:1:27: error: use nullptr" --all

# A tag goes before the file.
git tag v9
expect 0 "no files to look at (since v9)"

# A header that changed counts through a file that includes it.
good inHeader | sed 's/^/inline /' >host/part.h
mkdir app
printf '#include "host/part.h"\nint* far() { return 0; }\n' >app/far.cpp
printf '#include "host/part.h"\n' >host/old.cpp # the one beside it
compiles app/far.cpp host/old.cpp host/first.cpp host/second.cpp
commit "a header" >/dev/null
git tag v10
expect 0 "no files to look at (since v10)"
bad inHeader | sed 's/^/inline /' >host/part.h
expect 1 "host/part.h:1:39: error: use nullptr"
expect 1 "1 files (since v10): findings above"
[[ $(bash scripts/tidy.sh || true) != *app/far.cpp* ]] || { echo "a header was looked at from afar"; exit 1; }

# Slow files: what is not begun in time is left out, and said so.
mkdir tools
printf '#!/bin/sh\nsleep 2\n' >tools/clang-tidy-14
chmod +x tools/clang-tidy-14
files=()
for ((i = 0; i <= $(nproc); ++i)); do
    good "slow$i" >"host/slow$i.cpp"
    files+=("host/slow$i.cpp")
done
compiles "${files[@]}"
PATH=$folder/tools:$PATH expect 0 "files (since v10) were left out" --seconds 1
