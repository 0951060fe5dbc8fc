#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests. Arguments go to ctest, for instance -R bvh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

bash scripts/build.sh build,test
exec ctest --test-dir build/release --output-on-failure --no-tests=error --parallel "$(nproc)" "$@"
