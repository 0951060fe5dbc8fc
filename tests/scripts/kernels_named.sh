#!/usr/bin/env bash
# kernels_named.sh ROOT: fails if one of the product's kernels is in no test: where tests name it, in quotes, they run it.
set -euo pipefail
cd "${1:?kernels_named.sh: error: no folder of the sources: name it}"

mapfile -t kernels < <(grep -rhoP --include='*.cl' '^__kernel void \K\w+(?=\()' kernels effects filters | sort -u)
if [ ${#kernels[@]} -eq 0 ]; then
    echo "kernels_named: there are no kernels" >&2
    exit 1
fi
status=0
for kernel in "${kernels[@]}"; do
    if ! grep -qrF --include='*.cpp' --include='*.h' "\"$kernel\"" tests; then
        echo "kernels_named: no test runs the kernel $kernel by itself" >&2
        status=1
    fi
done
exit $status
