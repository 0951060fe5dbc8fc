// Which place of emitters numbers choose, and the densities that are told of places.
#include "light/emitters.h"

WEDGE_FN EmitterData emitterData(
    SurfaceData surfaces, __global const Emitter* emitters, __global const float* emitterPicks, uint listed)
{
    EmitterData e;
    e.surfaces = surfaces;
    e.quads = 0;
    e.list = emitters;
    e.picks = emitterPicks;
    e.count = listed;
    e.share = 1.0f;
    return e;
}

/// numbers: 2 each. out: triangle, weights of its second and third corner, what is told of the place when it is chosen
/// and when a ray meets it; 5 each.
__kernel void choosePlaces(WEDGE_SURFACE_PARAMETERS, WEDGE_EMITTER_PARAMETERS, uint listed,
    __global const float* restrict numbers, uint count, __global float* restrict out)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const EmitterData e = emitterData(WEDGE_SURFACE_ARGUMENTS, emitters, emitterPicks, listed);
    const EmitterPlace place = placeOf(e, chooseEmitter(e, vec2(numbers[2u * i], numbers[2u * i + 1u])));
    out[5u * i] = (float)place.triangle;
    out[5u * i + 1u] = place.weights.x;
    out[5u * i + 2u] = place.weights.y;
    out[5u * i + 3u] = place.pick;
    out[5u * i + 4u] = pickAt(e, place.triangle, place.weights);
}

/// places: triangle, weights of its second and third corner, 3 each. out: what is told of them when a ray meets them,
/// and the luminance of what is emitted there; 2 each.
__kernel void meetPlaces(WEDGE_SURFACE_PARAMETERS, WEDGE_EMITTER_PARAMETERS, uint listed,
    __global const float* restrict places, uint count, __global float* restrict out)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const EmitterData e = emitterData(WEDGE_SURFACE_ARGUMENTS, emitters, emitterPicks, listed);
    const uint triangle = (uint)places[3u * i];
    const Vec2 weights = vec2(places[3u * i + 1u], places[3u * i + 2u]);
    const Vec3 emitted = emittedAt(e.surfaces, triangle, weights);
    out[2u * i] = pickAt(e, triangle, weights);
    out[2u * i + 1u] = fmax(emitted.x, fmax(emitted.y, emitted.z));
}
