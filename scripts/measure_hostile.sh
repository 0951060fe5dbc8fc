#!/usr/bin/env bash
# measure_hostile.sh [TEST]: how long the program takes for each of the hostile files and calls of tests/hostile, with
# kernels compiled before. Prints the slowest ten. Exit status: 1 where one takes more than two seconds or does not end
# as it should.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

test=${1:-build/release/hostile_test}
most=2 # seconds
[ -x "$test" ] || { echo "measure_hostile.sh: error: no program: $test: build it with ./test.sh" >&2; exit 1; }
times=$(mktemp)
trap 'rm -f "$times"' EXIT

"$test" --test-case='kernels are compiled*' > /dev/null || {
    echo "measure_hostile.sh: error: not even a small scene renders: run $test" >&2
    exit 1
}
status=0
WEDGE_HOSTILE_TIMES=$times "$test" --test-case-exclude='kernels are compiled*' || status=1

echo "seconds, the slowest ten of $(wc -l < "$times"):"
sort -rg "$times" | head
awk -F '\t' -v most="$most" '$1 > most { slow++ } END { exit slow > 0 }' "$times" || {
    echo "measure_hostile.sh: error: files or calls take more than $most s" >&2
    status=1
}
exit $status
