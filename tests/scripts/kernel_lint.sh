#!/usr/bin/env bash
# kernel_lint.sh KERNELS: runs the front end of three GPU targets over every program in the folder KERNELS, with each
# set of defines the host builds it with, warnings as errors. Fails if one complains.
set -euo pipefail
cd "${1:?kernel_lint.sh: error: no folder of kernels: name it}"

if ! command -v clang-15 >/dev/null; then
    echo "kernel_lint: clang-15 is missing: run scripts/install_dependencies.sh test" >&2
    exit 1
fi

lint() { # TARGET FILE DEFINE...
    clang-15 -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Werror -nogpulib -I. \
        -target "$@" || { echo "kernel_lint: failed: $*" >&2; return 1; }
}
export -f lint

files=(*.cl)
[ -f "${files[0]}" ] || { echo "kernel_lint: no .cl file in $PWD" >&2; exit 1; }

# The linter itself must complain where there is something to complain of.
if lint spir64 - <<<'kernel void f(global float* a) { int unused = *a; }' 2>/dev/null; then
    echo "kernel_lint: an unused variable went unnoticed" >&2
    exit 1
fi

for target in spir64 nvptx64 amdgcn; do
    for file in "${files[@]}"; do
        for family in '' -DWEDGE_TRAVERSAL_SCALAR=1; do
            for motion in '' -DWEDGE_MOTION=1; do
                printf '%s\0' "lint $target $file $family $motion" "lint $target $file $family $motion -DWEDGE_SPECULAR=1"
            done
        done
    done
done | xargs -0 -n 1 -P "$(nproc)" bash -c
echo "kernel_lint: ${#files[@]} programs pass, under both families of traversals, at rest and moving, for spir64, nvptx64 and amdgcn"
