#!/usr/bin/env bash
# format.sh [--check]: lays out the sources with clang-format 14, since other versions lay them out otherwise. With --check it
# changes nothing and names the files that it would change; exit status 1 if there are any.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
    echo "format.sh: error: $*" >&2
    exit 2
}

if [ $# -gt 1 ] || [ "${1:---check}" != --check ]; then
    fail "wrong call: $*: give --check, or nothing"
fi
command -v clang-format-14 >/dev/null ||
    fail "clang-format 14: not installed: run scripts/install_dependencies.sh develop on Debian 12"

sources=(find kernels bvh host effects filters tests benchmarks data/generator "(" -name "*.cpp" -o -name "*.h" -o -name "*.cl" ")")
if [ $# -eq 0 ]; then
    exec "${sources[@]}" -exec clang-format-14 -i {} +
fi
# A line for each place goes to stderr: the files' names are enough.
said=$("${sources[@]}" -exec clang-format-14 --dry-run {} + 2>&1) || fail "clang-format-14: ${said##*$'\n'}"
unformatted=$(sed -nE 's/^([^ :]+):[0-9]+:[0-9]+: .*\[-Wclang-format-violations\]$/\1/p' <<<"$said" | sort -u)
if [ -n "$unformatted" ]; then
    echo "not formatted, run scripts/format.sh:"
    sed 's/^/  /' <<<"$unformatted"
    exit 1
fi
