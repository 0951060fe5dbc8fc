#!/usr/bin/env bash
# second_driver.sh WEDGE TEST...: runs test programs once more with an OpenCL driver of another vendor beside the first:
# rusticl on llvmpipe, which shares no compiler with PoCL but LLVM itself, and folds and fuses otherwise.
set -euo pipefail
wedge=${1:?second_driver.sh: error: no program: name wedge}
shift

export RUSTICL_ENABLE=llvmpipe
if ! "$wedge" devices | grep -q llvmpipe; then
    echo "second_driver: llvmpipe is missing: run scripts/install_dependencies.sh test" >&2
    exit 1
fi
for test in "$@"; do
    "$test"
done
