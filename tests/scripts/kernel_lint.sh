#!/usr/bin/env bash
# kernel_lint.sh KERNELS: runs the front end of three GPU targets over every program in the folder KERNELS, with each
# set of defines the host builds it with, warnings as errors. Fails if one complains.
set -euo pipefail
cd "${1:?kernel_lint.sh: error: no folder of kernels: name it}"

# Any clang from 15 on; the newest that is here.
least=15
newest=0
for name in clang $(compgen -c clang- | grep -xE 'clang-[0-9]+' | sort -u); do
    version=$("$name" -dumpversion 2>/dev/null | cut -d. -f1) || version=0
    if [ "${version:-0}" -gt "$newest" ]; then
        newest=$version
        clang=$name
    fi
done
if [ "$newest" -lt $least ]; then
    echo "kernel_lint: no clang of version $least or newer: run scripts/install_dependencies.sh test" >&2
    exit 1
fi
export clang

lint() { # TARGET FILE DEFINE...
    "$clang" -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Werror -nogpulib -I. \
        -target "$@" || { echo "kernel_lint: failed: $*" >&2; return 1; }
}
export -f lint

files=(*/*.cl)
[ -f "${files[0]}" ] || { echo "kernel_lint: no .cl file in $PWD" >&2; exit 1; }

# Rooms include what is in rooms before them.
rooms=(shared core trace sinks light paths waves filter analysis frame)
allowed=
for room in "${rooms[@]}"; do
    allowed="$allowed|$room"
    if grep -nE '#include "[a-z_]+/' "$room"/* | grep -vE "#include \"(${allowed#|})/"; then
        echo "kernel_lint: $room/ includes what is in none of${allowed//|/ }" >&2
        exit 1
    fi
done
for room in */; do
    [[ " ${rooms[*]} " == *" ${room%/} "* ]] || { echo "kernel_lint: no order is known for the room $room" >&2; exit 1; }
done

# The linter itself must complain where there is something to complain of.
if lint spir64 - <<<'kernel void f(global float* a) { int unused = *a; }' 2>/dev/null; then
    echo "kernel_lint: an unused variable went unnoticed" >&2
    exit 1
fi

for target in spir64 nvptx64 amdgcn; do
    for file in "${files[@]}"; do
        for family in '' -DWEDGE_TRAVERSAL_SCALAR=1; do
            for motion in '' -DWEDGE_MOTION=1; do
                printf '%s\0' "lint $target $file $family $motion" "lint $target $file $family $motion -DWEDGE_SPECULAR=1" \
                    "lint $target $file $family $motion -DWEDGE_SPECULAR=1 -DWEDGE_ENVIRONMENT_MAP=1" \
                    "lint $target $file $family $motion -DWEDGE_SPECULAR=1 -DWEDGE_GGX=1" \
                    "lint $target $file $family $motion -DWEDGE_NORMAL_MAPS=1" \
                    "lint $target $file $family $motion -DWEDGE_MIRRORS=1" \
                    "lint $target $file $family $motion -DWEDGE_MIRRORS=1 -DWEDGE_TOUCHING_GLASS=1" \
                    "lint $target $file $family $motion -DWEDGE_CUTOUTS=1" \
                    "lint $target $file $family $motion -DWEDGE_EMITTER_TREES=1 -DWEDGE_EMITTER_TABLES=1"
            done
        done
    done
    # What passes hand the programs of a file besides.
    for channels in 1 2 3 4; do
        for more in '' -DWEDGE_GATHER_SHEARED '-DWEDGE_GATHER_SHEARED -DWEDGE_GATHER_CURVED' -DWEDGE_GATHER_MEAN_SQUARE \
            -DWEDGE_PACKED '-DWEDGE_PACKED -DWEDGE_GATHER_VALUE_ONLY'; do
            printf '%s\0' "lint $target filter/filter.cl -DWEDGE_GATHER_CHANNELS=$channels $more"
        done
    done
    printf '%s\0' "lint $target filter/filter_counts.cl -DWEDGE_PACKED" "lint $target filter/compare_widths.cl -DWEDGE_PACKED"
    for components in 1 5 7; do
        printf '%s\0' "lint $target filter/components.cl -DWEDGE_COMPONENTS=$components" \
            "lint $target filter/components.cl -DWEDGE_COMPONENTS=$components -DWEDGE_SPECULAR=1"
    done
done | xargs -0 -n 1 -P "$(nproc)" bash -c
echo "kernel_lint: ${#files[@]} programs pass with $clang $newest, under both families of traversals, at rest and moving, for spir64, nvptx64 and amdgcn"
