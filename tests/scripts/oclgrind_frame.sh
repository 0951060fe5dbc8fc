#!/usr/bin/env bash
# oclgrind_frame.sh WEDGE SOURCES WORK PART PARTS: renders tiny frames with the program WEDGE on Oclgrind, a simulated
# device that notices accesses out of bounds, data races, diverging barriers and wrong calls of OpenCL. Fails if its log
# says anything (its exit status is always 0). Of PARTS such runs that share the frames this one is PART, from 1;
# what they make stays in the folder WORK. PART kernels, after them: fails if some kernel never ran.
#
# Without optimisation, since Oclgrind 21.10 does not know intrinsics that the optimiser puts in. Without
# --uninitialized, which in this version takes constants that an earlier kernel stored for uninitialised, and without
# --inst-counts, which corrupts its own memory; the program's reports say which kernels ran.
set -euo pipefail
wedge=${1:?oclgrind_frame.sh: error: no program: name wedge}
sources=${2:?oclgrind_frame.sh: error: no source folder: name the one above kernels/ and data/}
work=${3:?oclgrind_frame.sh: error: no folder to work in}
part=${4:?oclgrind_frame.sh: error: no part: name one from 1 to PARTS, or kernels}
parts=${5:?oclgrind_frame.sh: error: no number of parts}

if ! command -v oclgrind >/dev/null; then
    if [ -n "$(apt-cache policy oclgrind 2>/dev/null | grep Candidate | grep -v none)" ]; then
        echo "oclgrind_frame: oclgrind is missing: run scripts/install_dependencies.sh test" >&2
        exit 1
    fi
    echo "skipped: this system has no oclgrind"
    exit 0
fi
reports=$work
work=$work/$part
rm -rf "$work"
mkdir -p "$work"
number=0
# Cached binaries would hide the build options below; an empty name means no cache.
export WEDGE_CACHE_DIR=

# Renders one frame; its name, then the arguments of wedge render. Leaves NAME.log and NAME.out. Frames called ..._image have
# no layers, and so keep less; ..._%d are two frames of a sequence.
simulate() {
    local name=$1 layers=(--layers all)
    shift
    case $name in *_image) layers=() ;; esac
    oclgrind --build-options -cl-opt-disable --data-races --check-api --max-errors 20 \
        --log "$work/$name.log" "$wedge" render "$@" --check-launches "${layers[@]}" -o "$work/$name.exr" \
        --report "$work/$name.json" >"$work/$name.out" 2>&1
}

check() {
    number=$((number + 1))
    if [ $((number % parts + 1)) -ne "$part" ]; then return 0; fi
    local began=$SECONDS
    if ! simulate "$@" || ! grep -q "Oclgrind" "$work/$1.out" || [ ! -s "$work/${1/\%d/1}.exr" ] || [ -s "$work/$1.log" ]; then
        echo "oclgrind_frame: failed: $*" >&2
        cat "$work/$1.log" >&2
        cat "$work/$1.out" >&2
        return 1
    fi
    echo "$1: nothing to report, $((SECONDS - began)) s"
}

# The check itself must fail where a kernel writes past the end of a buffer.
checkSabotaged() {
    cp -r "$sources/kernels" "$work/kernels"
    sed -i 's/objectId\[i\] = /objectId[i + frame.planeSize] = /' "$work/kernels/frame/primary.cl"
    if cmp -s "$sources/kernels/frame/primary.cl" "$work/kernels/frame/primary.cl"; then
        echo "oclgrind_frame: primary.cl no longer has the line to sabotage: name another" >&2
        return 1
    fi
    simulate sabotaged "$scenes/penumbra.toml" --size 9x7 --method mc --spp 1 --kernel-dir "$work/kernels" || true
    if ! grep -q "Invalid write" "$work/sabotaged.log"; then
        echo "oclgrind_frame: a write past the end went unnoticed" >&2
        return 1
    fi
}

checkAllKernelsRan() {
    local kernel missing=0
    for kernel in $(grep -hoP '__kernel void \K\w+' $(ls "$sources"/kernels/*/*.cl | grep -v _test.cl)); do
        grep -qF "\"$kernel\"" "$reports"/*/*.json || { echo "oclgrind_frame: kernel never ran: $kernel" >&2; missing=1; }
    done
    return $missing
}

scenes=$sources/data/scenes
if [ "$part" = kernels ]; then
    checkAllKernelsRan
    exit
fi
if [ "$part" = 1 ]; then checkSabotaged; fi
# Odd sizes, so that tiles and vectors reach over the border. The materials have textures, gloss, two area lights, a
# point light and a directional one.
for family in wide scalar; do
    check plain_$family "$scenes/materials.toml" --size 19x13 --method mc --spp 1 --traversal $family
    check filtered_$family "$scenes/materials.toml" --size 19x13 --method aaf --spp 10 --traversal $family
    check paths_$family "$scenes/materials.toml" --size 17x5 --method mc --spp 2 --bounces 2 --traversal $family
    check bounced_$family "$scenes/materials.toml" --size 17x3 --method aaf --spp 17 --bounces 2 --traversal $family
done
# Several filters of a light at once.
check two_slopes "$scenes/materials.toml" --traversal wide --size 19x13 --method maaf --spp 10
check two_slopes_scalar "$scenes/penumbra.toml" --traversal scalar --size 9x7 --method maaf --spp 10
check components "$scenes/penumbra.toml" --traversal wide --size 9x7 --method maaf --maaf refitted --components 3 --spp 10
check components_printed "$scenes/penumbra.toml" --traversal scalar --size 7x5 --method maaf --maaf printed --components 5 --spp 9
# Through a lens and a shutter.
check moving_plain "$scenes/motion.toml" --traversal wide --size 9x7 --method mc --spp 2 --bounces 1
check moving_filtered "$scenes/motion.toml" --traversal wide --size 11x7 --method aaf --spp 16 --bounces 1
check moving_image "$scenes/motion.toml" --traversal wide --size 11x7 --method aaf --spp 16 --bounces 1
check plain_image "$scenes/motion.toml" --traversal wide --size 9x7 --method mc --spp 2
check moving_scalar "$scenes/motion.toml" --traversal scalar --size 9x5 --method aaf --spp 10
check moving_published "$scenes/motion.toml" --traversal wide --size 9x5 --method aaf --as-published --bounces 1 --max-spp 24
check moving_steps "$scenes/motion.toml" --traversal wide --size 9x5 --method aaf --progressive --spp 32 --bounces 1
check moving_steps_image "$scenes/motion.toml" --traversal wide --size 9x5 --method aaf --progressive --spp 32 --bounces 1
check plain_steps_image "$scenes/motion.toml" --traversal wide --size 9x5 --method mc --progressive --spp 32
check published_image "$scenes/motion.toml" --traversal wide --size 9x5 --method aaf --as-published --max-spp 24
# The rest by the wide family, whose vectors reach farther over the ends of things.
check cropped "$scenes/penumbra.toml" --traversal wide --size 33x17 --crop 5,3,22,12 --method aaf --counts variance --spp 10
check published "$scenes/penumbra.toml" --traversal wide --size 9x7 --method aaf --as-published
check fixed "$scenes/penumbra.toml" --traversal wide --size 9x7 --method aaf --sampling uniform --filter fixed --spp 9
check ambient "$scenes/materials.toml" --traversal wide --size 17x3 --method aaf --spp 17 --integrator ao
check published_bounce "$scenes/penumbra.toml" --traversal wide --size 9x3 --method aaf --as-published --bounces 1 --max-spp 24
check one_pixel "$scenes/penumbra.toml" --traversal wide --size 1x1 --method aaf --spp 16 --bounces 1
check sky "$scenes/sky.toml" --traversal wide --size 9x5 --method aaf --spp 16
check sky_precomputed "$scenes/sky.toml" --traversal wide --size 9x5 --method mc --spp 2 --environment-sampling precomputed
check sky_published "$scenes/sky.toml" --traversal wide --size 9x5 --method aaf --as-published
check sky_corrected "$scenes/sky.toml" --traversal wide --size 9x5 --method aaf --spp 16 --environment-widths corrected
check sky_lights "$scenes/sky.toml" --traversal wide --size 5x4 --method mc --spp 1 --shadows ratio --shadow-lights 5
check sky_lights_prefiltered "$scenes/sky.toml" --traversal wide --size 7x5 --method mc --spp 1 --shadows ratio --shadow-lights 2 --shadow-complete prefiltered
check sky_lights_few "$scenes/sky.toml" --traversal wide --size 7x5 --method mc --spp 1 --shadows subtractive --shadow-lights 5 --shadow-scale 1/4
check sky_lights_chosen "$scenes/sky.toml" --traversal wide --size 7x5 --method mc --spp 1 --shadows ratio --shadow-lights 5:2 --shadow-scale 1/16
check sky_lights_scalar "$scenes/sky.toml" --traversal scalar --size 7x5 --method aaf --spp 16 --shadows subtractive --shadow-lights 5
# By tables of normals, which the simulated device would take hours for: they are made smaller.
cp -r "$sources/kernels" "$work/small_tables"
sed -i 's/define WEDGE_CACHE_SIDE 128u/define WEDGE_CACHE_SIDE 8u/' "$work/small_tables/shared/shadow_lights.h"
grep -q "WEDGE_CACHE_SIDE 8u" "$work/small_tables/shared/shadow_lights.h"
check sky_lights_cache "$scenes/sky.toml" --traversal wide --size 7x5 --method mc --spp 1 --shadows ratio --shadow-lights 2 --shadow-complete cache --kernel-dir "$work/small_tables"
check styled "$scenes/styled.toml" --traversal wide --size 19x13 --method mc --spp 1
# By how far away what throws the shadow is; of some things on some things.
sed -e "s|meshes/|$scenes/meshes/|" -e "s|^inflation = .*|inflation = { at = [0, 0.05, 0] }|" \
    -e "s|^abstraction = .*|abstraction = { at = [0, 0.1, 0] }|" "$scenes/styled.toml" >"$work/styled_away.toml"
check styled_away "$work/styled_away.toml" --traversal wide --size 19x13 --method mc --spp 1
sed "s|^brightness = .*|casters = 'fence'\nreceivers = 'floor'\n[[light.style]]\nsoftness = 0.1|" "$work/styled_away.toml" >"$work/styled_lists.toml"
check styled_lists "$work/styled_lists.toml" --traversal wide --size 19x13 --method mc --spp 1
sed -e "s#\"meshes/#\"$scenes/meshes/#" -e 's/^softness = .*/&\nkey = [{ time = 0 }, { time = 1, inflation = 0.1 }]/' \
    "$scenes/styled.toml" >"$work/styled_keys.toml"
check styled_keys "$work/styled_keys.toml" --traversal wide --size 19x13 --method mc --spp 1
# Soft shadows in a style, of matt surfaces and of lobes.
sed -e "s#\"meshes/#\"$scenes/meshes/#" -e 's/^diffuse = .*/&\nmodel = "phong"\nspecular = 0.2\nexponent = 20/' \
    -e 's/^type = "quad"/&\nstyle = [{ inflation = 0.1, softness = 0.1, abstraction = 0.2, weight = 0.5 }, { penumbra = 0, inflation = 0.1, weight = 0.5 }]/' \
    "$scenes/penumbra.toml" >"$work/styled_soft.toml"
check styled_soft "$work/styled_soft.toml" --traversal wide --size 11x9 --method aaf --spp 16
check styled_scalar "$scenes/styled.toml" --traversal scalar --size 9x7 --method mc --spp 1
check sky_waves "$scenes/sky.toml" --traversal wide --size 7x3 --method aaf --spp 16 --antialias
# Microfacets, normal maps and heights, and cut-outs.
cat >"$work/bumps.toml" <<END
[camera]
eye = [0.5, 0.9, 1.5]
look_at = [0, 0, 0]
[[material]]
name = "normals"
model = "ggx"
roughness = 0.4
specular = 0.3
normal_texture = "$scenes/textures/tiles.png"
[[material]]
name = "heights"
bump_texture = "$scenes/textures/tiles.png"
normal_strength = 5
opacity = 0.7
[[mesh]]
file = "$scenes/meshes/quad.obj"
material = "normals"
[[mesh]]
file = "$scenes/meshes/quad.obj"
material = "heights"
transform = [{ scale = 0.4 }, { rotate = [1, 0, 0, 50] }, { translate = [0, 0.3, 0] }]
[[light]]
type = "quad"
centre = [0.3, 2, 0.5]
half_u = [0.3, 0, 0]
half_v = [0, 0, 0.3]
radiance = 5
two_sided = true
END
for family in wide scalar; do
    check bumps_$family "$work/bumps.toml" --size 9x5 --method aaf --spp 16 --bounces 1 --traversal $family
    check bumps_waves_$family "$work/bumps.toml" --size 7x3 --method aaf --spp 16 --antialias --traversal $family
done
# Mirrors and glass.
check mirrors "$scenes/mirrors.toml" --traversal wide --size 9x7 --method mc --spp 2
check mirrors_scalar "$scenes/mirrors.toml" --traversal scalar --size 9x5 --method aaf --spp 16 --bounces 1
check mirrors_waves "$scenes/mirrors.toml" --traversal wide --size 7x3 --method aaf --spp 16 --bounces 1 --antialias
check over_time_%d "$scenes/motion.toml" --traversal wide --size 9x5 --method aaf --spp 10 --frames 0:1 --temporal on
check over_time_%d_image "$work/bumps.toml" --traversal wide --size 7x3 --method aaf --spp 10 --antialias --frames 0:1 --temporal on
check bounced_over_time_%d "$scenes/penumbra.toml" --traversal wide --size 9x5 --method aaf --spp 16 --bounces 1 --frames 0:1 --temporal on
# All filters of the image. With its defaults colour has nothing to do.
mapfile -t filters < <("$wedge" render --help | sed -n '/^Filters of the image/,/^$/ s/^  \([a-z][a-z-]*\) .*/--add-filter=\1/p' | sed 's/=colour$/=colour:red=0.5/')
check image_filters "$scenes/penumbra.toml" --traversal wide --size 19x13 --method mc --spp 1 "${filters[@]}"
# Filters of samples: stored with the analysis and twice, and without; with layers, which ask for all neighbours, and without.
check term_filters "$scenes/materials.toml" --traversal wide --size 9x5 --method aaf --spp 16 --bounces 1 --add-filter box:on=indirectDiffuse+indirectGlossy --add-filter gaussian:on=direct
check term_filters_antialiased "$scenes/materials.toml" --traversal wide --size 9x5 --method aaf --spp 16 --bounces 1 --antialias --add-filter box:on=indirectDiffuse --add-filter box:on=direct+indirect
check sample_density "$scenes/materials.toml" --traversal wide --size 9x5 --method mc --spp 3 --bounces 1 --add-filter path-density
check sample_density_rgb "$scenes/materials.toml" --traversal wide --size 7x3 --method mc --spp 3 --bounces 1 --add-filter path-density:rgb=1,approximate=1
check sample_density_image "$scenes/penumbra.toml" --traversal wide --size 9x3 --method aaf --spp 18 --bounces 1 --add-filter path-density
check sample_clamp "$scenes/penumbra.toml" --traversal scalar --size 7x3 --method mc --spp 2 --bounces 1 --add-filter clamp
check sample_trim "$scenes/penumbra.toml" --traversal wide --size 7x3 --method mc --spp 5 --bounces 1 --add-filter trim:share=0.3
check sample_gmon "$scenes/penumbra.toml" --traversal wide --size 7x3 --method mc --spp 5 --bounces 1 --add-filter gmon:groups=3
check sample_reweight "$scenes/penumbra.toml" --traversal wide --size 7x3 --method mc --spp 2 --bounces 1 --add-filter reweight:spread=1,widest=4
# The same by brightness: with layers and without, in few bits and in many, and from step to step.
check binned_density "$scenes/materials.toml" --traversal wide --size 9x5 --method mc --spp 3 --bounces 1 --antialias --add-filter path-density
check binned_density_image "$scenes/motion.toml" --traversal wide --size 9x5 --method aaf --spp 16 --bounces 1 --add-filter path-density
check binned_steps "$scenes/motion.toml" --traversal wide --size 7x5 --method aaf --progressive --spp 32 --bounces 1 --add-filter path-density
check binned_clamp "$scenes/penumbra.toml" --traversal scalar --size 7x3 --method mc --spp 2 --bounces 1 --antialias --add-filter clamp
check binned_reweight "$scenes/motion.toml" --traversal wide --size 7x3 --method mc --spp 2 --bounces 1 --add-filter reweight:spread=1
