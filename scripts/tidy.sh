#!/usr/bin/env bash
# tidy.sh [--all | --since REV] [--seconds N] [--build DIR]: looks for likely mistakes with clang-tidy 14, in as many files at
# once as there are processors. The files are the .cpp that changed since REV, the last changed ones first, and of each header
# that did one that includes it; REV is the last tag, or in a clone without tags the commit in scripts/last_release. --all looks
# at every file: an hour on two cores. After N seconds no further file is begun. DIR is the build folder whose
# compile_commands.json says how files are compiled, build/release. Exit status 1 if something was found.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
    echo "tidy.sh: error: $*" >&2
    exit 2
}

all=
since=
seconds=
build=build/release
while [ $# -gt 0 ]; do
    case $1 in
    --all)
        all=yes
        shift
        continue
        ;;
    --since | --seconds | --build) [ -n "${2:-}" ] || fail "$1: nothing: give it a value" ;;
    *) fail "unknown argument: $1: choose --all, --since, --seconds or --build" ;;
    esac
    printf -v "${1#--}" %s "$2"
    shift 2
done
[ -z "$all" ] || [ -z "$since" ] || fail "--all --since: give one of them"
[[ $seconds =~ ^([1-9][0-9]*)?$ ]] || fail "--seconds: $seconds: give a whole number above 0"
command -v clang-tidy-14 >/dev/null ||
    fail "clang-tidy 14: not installed: run scripts/install_dependencies.sh develop on Debian 12"
[ -f "$build/compile_commands.json" ] || fail "$build/compile_commands.json: not there: configure that folder first"

# The revision that changes count from. Says so where there is none, and prints HEAD.
base() {
    local revision
    revision=$(git describe --tags --abbrev=0 2>/dev/null) || revision=$(grep -v '^#' scripts/last_release)
    if ! git rev-parse --verify --quiet "$revision^{commit}" >/dev/null; then
        echo "tidy.sh: no tag, nor commit $revision, in this clone: looking at uncommitted changes alone" >&2
        revision=HEAD
    fi
    echo "$revision"
}

# Files that are compiled, below this folder.
compiled() {
    sed -nE 's|^ *"file": "(.*)",?$|\1|p' "$build/compile_commands.json" |
        awk -v root="$PWD/" 'index($0, root) == 1 { print substr($0, length(root) + 1) }' | grep -v '^build/' | sort -u
}

# Files that changed since a revision, the last changed ones first.
changed() { # REV
    {
        git diff --name-only HEAD
        git ls-files --others --exclude-standard
        git log --format= --name-only "$1..HEAD"
        git diff --name-only "$1"
    } | awk '!seen[$0]++'
}

# The file itself, or of a header one that includes it: best that of the same name, else one beside it.
unit() { # FILE
    local source=${1%.h}.cpp
    case $1 in
    *.cpp) echo "$1" ;;
    *.h)
        if [ -f "$source" ]; then
            echo "$source"
        else
            { { compiled | grep "^$(dirname "$1")/[^/]*$" || true; compiled; } |
                xargs -d '\n' grep -lF "#include \"$1\"" || true; } | sed -n 1p
        fi
        ;;
    esac
}

if [ -n "$all" ]; then
    mapfile -t files < <(compiled)
    which="all"
else
    git rev-parse --verify --quiet HEAD >/dev/null || fail "no git repository: $PWD: give --all"
    if [ -n "$since" ]; then
        git rev-parse --verify --quiet "$since^{commit}" >/dev/null || fail "--since: $since: no such commit in this clone"
    else
        since=$(base)
    fi
    mapfile -t files < <(changed "$since" | while read -r file; do unit "$file"; done | awk '!seen[$0]++' |
        grep -xFf <(compiled))
    which="since $since"
fi
if [ ${#files[@]} -eq 0 ]; then
    echo "no files to look at ($which)"
    exit 0
fi

later=$(mktemp)
# The compiler's headers that were compiled ahead are nothing that clang can read.
commands=$(mktemp -d)
sed -E 's| -Winvalid-pch||; s| -include [^ ]*/cmake_pch\.hxx||' "$build/compile_commands.json" >"$commands/compile_commands.json"
trap 'rm -rf "$later" "$commands"' EXIT
deadline=${seconds:+$((EPOCHSECONDS + seconds))}

# One file's findings at once, so that those of several do not mix.
look() { # FILE
    if [ -n "$deadline" ] && [ "$EPOCHSECONDS" -ge "$deadline" ]; then
        echo "$1" >>"$later"
        return
    fi
    local said
    if ! said=$(clang-tidy-14 -quiet -p "$commands" --warnings-as-errors='*' "$1" 2>&1); then
        printf '%s\n' "$1:" "$(grep -vE '^[0-9]+ warnings? (generated|treated as errors?)\.?$' <<<"$said")"
        return 1
    fi
}
export -f look
export commands deadline later
status=0
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc)" bash -c 'look "$1"' look || status=1

left=$(wc -l <"$later")
[ "$left" -eq 0 ] || echo "after $seconds seconds $left of ${#files[@]} files ($which) were left out: scripts/tidy.sh without --seconds"
if [ "$status" -eq 0 ]; then
    echo "$((${#files[@]} - left)) files ($which): nothing found"
else
    echo "$((${#files[@]} - left)) files ($which): findings above"
fi
exit "$status"
