#!/usr/bin/env bash
# fuzz.sh [--seconds N | --runs N] [--seed N] [TARGET...]: builds the fuzzing targets of tests/fuzz with clang, AddressSanitizer and
# UndefinedBehaviorSanitizer, and runs them from their corpora, as many at once as there are processors: for N seconds
# altogether (60 by default), or N executions each. What was found stays in build/fuzz: findings/TARGET-* is what a target
# fell over (run build/fuzz/fuzz_TARGET FILE), corpus/TARGET what it learnt. The seed is 1 by default. Exit status 1 if one fell over.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
    echo "fuzz.sh: error: $*" >&2
    exit 2
}

seconds=60
runs=
seed=1
while [ $# -gt 0 ]; do
    case $1 in
    --seconds | --runs | --seed)
        [[ ${2:-} =~ ^[1-9][0-9]*$ ]] || fail "$1: ${2:-nothing}: give a whole number above 0"
        printf -v "${1#--}" %s "$2"
        shift 2
        ;;
    -*) fail "unknown option: $1: choose --seconds, --runs or --seed" ;;
    *) break ;;
    esac
done
mapfile -t all < <(sed -nE 's/^wedge_fuzz\(([a-z_]+).*/\1/p' tests/fuzz/CMakeLists.txt)
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=("${all[@]}")
for target in "${targets[@]}"; do
    printf '%s\n' "${all[@]}" | grep -qxF "$target" || fail "no such target: $target: choose among ${all[*]}"
done

bash scripts/install_dependencies.sh build test
# The first clang that has the runtime of libFuzzer beside it.
compiler=
for name in clang++ $(compgen -c clang++- | grep -xE 'clang\+\+-[0-9]+' | sort -t- -k2 -rn -u); do
    version=$("$name" -dumpversion 2>/dev/null | cut -d. -f1) || version=0
    if [ "${version:-0}" -ge 15 ] && [ -e "$("$name" -print-resource-dir 2>/dev/null)/lib/linux/libclang_rt.fuzzer-$(uname -m).a" ]; then
        compiler=$name
        break
    fi
done
[ -n "$compiler" ] || fail "no clang++ of version 15 or newer with libFuzzer: run scripts/install_dependencies.sh test"
if [ ! -f build/fuzz/build.ninja ]; then
    cmake --preset fuzz --log-level=WARNING -DCMAKE_CXX_COMPILER="$compiler"
fi
cmake --build --preset fuzz --target "${targets[@]/#/fuzz_}"

jobs=$(nproc)
# Each takes its share of the time, in as many rounds as there are.
limit=$((seconds * jobs / ${#targets[@]}))
[ "$limit" -gt 0 ] || limit=1

fuzz() { # TARGET
    local target=$1 log=build/fuzz/$1.log
    local bound=${runs:+-runs=$runs}
    bound=${bound:--max_total_time=$limit}
    mkdir -p "build/fuzz/corpus/$target" build/fuzz/findings
    # Sanitized memory takes several times the room; the readers themselves are held to a tenth of it.
    if "build/fuzz/fuzz_$target" "$bound" \
        -seed="$seed" -timeout=10 -rss_limit_mb=2000 -malloc_limit_mb=400 -print_final_stats=1 -verbosity=0 \
        -artifact_prefix="build/fuzz/findings/$target-" "build/fuzz/corpus/$target" "tests/fuzz/corpus/$target" \
        >"$log" 2>&1; then
        echo "$target: $(awk '/number_of_executed_units/ { print $2 }' "$log") executions, nothing found"
    else
        echo "$target: FELL OVER after $(awk '/number_of_executed_units/ { print $2 }' "$log") executions:"
        grep -m 3 -E "ERROR|runtime error|SUMMARY" "$log" || tail -n 5 "$log"
        return 1
    fi
}
export -f fuzz
export limit runs seed
printf '%s\0' "${targets[@]}" | xargs -0 -n 1 -P "$jobs" bash -c 'fuzz "$1"' fuzz || exit 1
