#!/usr/bin/env bash
# kernel_lint.sh KERNELS PROGRAMS: runs the front end of three GPU targets over the programs that the command PROGRAMS
# writes, warnings as errors: those of frames of many kinds, for one target; and of each file of the folder KERNELS all
# kernels, for one with each set of defines that the host builds them with. Fails if one complains, or if a kernel is in none.
set -euo pipefail
programs=$(realpath "${2:?kernel_lint.sh: error: no command that writes programs: name it}")
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

lint() { # TARGET FOLDER FILE DEFINE...
    local target=$1 folder=$2
    shift 2
    "$clang" -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Werror -nogpulib \
        -I"$folder" -I"$(dirname "$folder")/none" -I. -target "$target" "$@" ||
        { echo "kernel_lint: failed: $target $folder $*" >&2; return 1; }
}
export -f lint

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$programs" "$work"
mkdir "$work/all.1.trace.trace_test.cl"
echo trace/trace_test.cl >"$work/all.1.trace.trace_test.cl/program"
for file in */*.cl; do
    [ -d "$work/all.1.${file//\//.}" ] || { echo "kernel_lint: no frame has a program of $file" >&2; exit 1; }
done
kernels=$(grep -hoP '^__kernel void \K\w+(?=\(PARAMETERS)' */*.cl)
for kernel in $kernels; do
    ls "$work"/all.*/pass/"$kernel.h" >/dev/null || { echo "kernel_lint: no frame has the kernel $kernel" >&2; exit 1; }
    grep -qF "#include \"pass/$kernel.h\"" */*.cl || { echo "kernel_lint: $kernel has no interface" >&2; exit 1; }
done

# Rooms include what is in rooms before them.
rooms=(shared core trace sinks light paths waves filter analysis frame)
allowed="|pass"
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
if lint spir64 . - <<<'kernel void f(global float* a) { int unused = *a; }' 2>/dev/null; then
    echo "kernel_lint: an unused variable went unnoticed" >&2
    exit 1
fi

for target in spir64 nvptx64 amdgcn; do
    for folder in "$work"/all.*; do
        program="lint $target $folder $(cat "$folder/program")"
        # Of a file that is compiled with several sets of defines one goes by what scenes have.
        case $folder in */all.1.*) ;; *) printf '%s\0' "$program" "$program -DWEDGE_SPECULAR=1" && continue ;; esac
        # Sets of defines read alike for all targets: one has them all, the others the least and the most of them.
        if [ $target != spir64 ]; then
            printf '%s\0' "$program" "$program -DWEDGE_TRAVERSAL_SCALAR=1 -DWEDGE_MOTION=1 -DWEDGE_SPECULAR=1 -DWEDGE_GGX=1"
            continue
        fi
        for family in '' -DWEDGE_TRAVERSAL_SCALAR=1; do
            for motion in '' -DWEDGE_MOTION=1; do
                for more in '' -DWEDGE_SPECULAR=1 '-DWEDGE_SPECULAR=1 -DWEDGE_ENVIRONMENT_MAP=1' \
                    '-DWEDGE_SPECULAR=1 -DWEDGE_GGX=1' -DWEDGE_NORMAL_MAPS=1 -DWEDGE_MIRRORS=1 \
                    '-DWEDGE_MIRRORS=1 -DWEDGE_TOUCHING_GLASS=1' -DWEDGE_CUTOUTS=1 \
                    '-DWEDGE_EMITTER_TREES=1 -DWEDGE_EMITTER_TABLES=1'; do
                    printf '%s\0' "$program $family $motion $more"
                done
            done
        done
    done
done >"$work/list"
frames=0
for folder in "$work"/*.cl; do
    case $folder in */all.*) continue ;; esac
    printf '%s\0' "lint spir64 $folder -Wno-unused-function $(cat "$folder/program")" # helpers of the kernels that it has not
    frames=$((frames + 1))
done >>"$work/list"
xargs -0 -n 1 -P "$(nproc)" bash -c <"$work/list"
echo "kernel_lint: $(wc -w <<<"$kernels") kernels pass with $clang $newest, under both families of traversals, at rest and moving, for spir64, nvptx64 and amdgcn; and $frames programs of frames"
