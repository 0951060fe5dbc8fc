#!/usr/bin/env bash
# Installs what is missing, builds, and renders three scenes, one of them with indirect light, at equal samples with and
# without filtering, beside a reference; and two small ones, through a lens and with motion, with and without filtering.
# Images, logs and reports go to out/. What is there already, made by this program from these files, stays.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

readonly wedge=build/release/wedge
readonly size=640x480
readonly small=320x240
readonly spp=28
readonly small_spp=16
readonly reference_spp=1024
readonly indirect_reference_spp=256 # rays of paths, and six of them a sample

# What an image depends on: the program, the scene's files and the call.
fingerprint() { # SCENE ARGUMENT...
    local scene=$1
    shift
    { sha256sum "$wedge" data/generated/"$scene"[._]*; printf '%s\n' "$@"; } | sha256sum
}

# Renders out/SCENE_NAME.exr and .png, with what was said in .txt, unless they are there; and says it again if so.
render() { # SCENE NAME ARGUMENT...
    local scene=$1 name=$1_$2
    shift 2
    local inputs
    local -a reference=() compared=()
    if [ "$name" != "${scene}_reference" ] && [ -f "out/.made/${scene}_reference" ]; then
        reference=(--reference "out/${scene}_reference.exr")
        compared=("$(cat "out/.made/${scene}_reference")")
    fi
    inputs=$(fingerprint "$scene" "$size" "$@" "${compared[@]}")
    echo
    if [ -f "out/$name.exr" ] && [ -f "out/$name.png" ] && [ -f "out/$name.txt" ] && [ -f "out/$name.json" ] &&
        [ "$(cat "out/.made/$name" 2>/dev/null)" = "$inputs" ]; then
        echo "== $name: unchanged"
        cat "out/$name.txt"
        return
    fi
    echo "== $name"
    rm -f "out/.made/$name"
    "$wedge" render "data/generated/$scene.toml" --size "$size" "$@" "${reference[@]}" -o "out/$name.exr" \
        -o "out/$name.png" --report "out/$name.json" | tee "out/$name.txt.part"
    mv "out/$name.txt.part" "out/$name.txt"
    echo "$inputs" >"out/.made/$name"
}

# One line an image: time, overhead and error, from what the renderer said.
summary() {
    printf '\n%-18s %10s %10s %10s %9s %9s\n' image "wall ms" "overhead" rmse "psnr dB" flip
    local name
    for name in "$@"; do
        awk -v name="$name" '
            /^wall clock/ { wall = $3 }
            /^overhead/ { overhead = $(NF - 1) " " $NF }
            /^error against/ { for (i = 1; i < NF; ++i) value[$i] = $(i + 1) }
            END { printf "%-18s %10s %10s %10s %9s %9s\n", name, wall, overhead, value["rmse"], value["psnr"],
                         value["flip"] }' "out/$name.txt"
    done
}

bash scripts/build.sh build wedge wedge_scenes
build/release/wedge_scenes data/generated
mkdir -p out/.made
threeWays() { # SCENE REFERENCE_SPP ARGUMENT...
    local scene=$1 most=$2
    shift 2
    render "$scene" reference --method mc --spp "$most" --seed 1 "$@"
    render "$scene" mc --method mc --spp "$spp" --seed 2 "$@"
    render "$scene" aaf --method aaf --spp "$spp" --seed 2 "$@"
}
threeWays grids "$reference_spp"
threeWays bench "$reference_spp"
threeWays cornell_glossy "$indirect_reference_spp" --bounces 2
twoWays() { # SCENE ARGUMENT...
    local scene=$1
    shift
    render "$scene" mc --method mc --spp "$small_spp" --seed 2 --size "$small" "$@"
    render "$scene" aaf --method aaf --spp "$small_spp" --seed 2 --size "$small" "$@"
}
twoWays chess
twoWays moving_cornell
summary grids_mc grids_aaf bench_mc bench_aaf cornell_glossy_mc cornell_glossy_aaf chess_mc chess_aaf moving_cornell_mc \
    moving_cornell_aaf
echo
echo "The images are in out/: SCENE_reference (not of chess and moving_cornell), SCENE_mc (plain Monte Carlo) and SCENE_aaf"
echo "(filtered), each .exr and .png."
