#!/usr/bin/env bash
# test.sh [--long] [CTEST ARGUMENTS]: installs what is missing, builds everything and runs the tests, for instance -R bvh. With
# --long, or where CI is set, also those of a quarter of an hour (label "long").
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

which=(--label-exclude '^long$')
if [ -n "${CI:-}" ]; then which=(); fi
if [ "${1:-}" = --long ]; then
    which=()
    shift
fi

bash scripts/build.sh build,test
exec ctest --test-dir build/release --output-on-failure --no-tests=error --parallel "$(nproc)" "${which[@]}" "$@"
