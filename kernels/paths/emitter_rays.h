// Direct light of meshes that emit: a point on one of them and a reflected direction a sample, both weighted by the
// power heuristic.
#ifndef WEDGE_EMITTER_RAYS_H
#define WEDGE_EMITTER_RAYS_H

#include "light/scene_light.h"
#include "paths/path_state.h"

/// What a receiver reflects.
typedef struct {
    bool glossy; ///< the lobe, without its colour; else the diffuse part, over the reflectance
    float value; ///< times the cosine
    float pdf; ///< density of reflected directions, 1/sr
} Reflected;

/// Of a lane's receiver in the direction l, unit, above both horizons.
WEDGE_FN Reflected reflectedTo(const ReceiverPacket* r, uint lane, bool glossy, Vec3 l)
{
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
    const float cosine = fmax(vecDot(n, l), 0.0f);
    Reflected out;
    out.glossy = glossy;
    out.value = out.pdf = cosine * WEDGE_INV_PI;
#ifdef WEDGE_SPECULAR
    if (glossy) {
        const LobeAt at = lobeAt(laneLobe(r, lane), n, laneView(r, lane), l);
        out.value = at.value * cosine;
        out.pdf = at.pdf;
    }
#endif
    return out;
}

/// A shadow ray of the lane to a point of an emitter into `shadow`, and in *light what it brings if nothing is in the
/// way. Returns the emitter's extent.
WEDGE_FN float emitterRay(EmitterData emitters, SampleParams sampling, const PathPacket* paths, const ReceiverPacket* r,
    uint lane, bool glossy, Vec3 facing, RayPacket* shadow, Vec3* light)
{
    const Vec3 origin = vec3(r->originX[lane], r->originY[lane], r->originZ[lane]);
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
    const EmitterPoint p =
        sampleEmitter(emitters, pathPair(sampling, paths, lane, 0u, WEDGE_DIMENSION_LIGHT), receiverTime(r, lane));
    const Vec3 ray = vecSub(p.point, origin);
    const float distance = vecLength(ray);
    const Vec3 l = vecScale(ray, 1.0f / fmax(distance, 1e-30f));
    if (!(vecDot(n, l) > 0.0f) || !(vecDot(facing, l) > 0.0f) || !(p.density > 0.0f) || !(distance > 0.0f)) {
        return p.extent;
    }
    const Reflected reflected = reflectedTo(r, lane, glossy, l);
    const float pdf = densityOfDirection(p.density, p.normal, l, distance);
    const float w = sampling.lightSampling == WEDGE_LIGHTS_BOTH ? powerHeuristic(pdf, reflected.pdf) : 1.0f;
    *light = vecScale(p.radiance, w * reflected.value / pdf);
    if (luminance(*light) > 0.0f) {
        setRay(shadow, lane, origin, emitterShadowRay(&p, origin), 0.0f, 1.0f);
    }
    return p.extent;
}

/// One sample a lane, whose reflected direction is that of `rays` and counts `weight`, which becomes 1: fills
/// paths->radiance and counts of rays, and, where sinks take distances, in paths->distance what widths follow from: how
/// far it is to what emits; or, where something is in between, how far from there a reflector would be whose light
/// varies as the penumbra does, (the emitter's extent) t / (T - t) for an occluder t on a way of T metres.
WEDGE_FN void traceEmitters(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    EmitterData emitters, SampleParams sampling, bool glossy, const ReceiverPacket* r, const VecLanes* facing,
    const uint* last, const RayPacket* rays, float* weight, PathPacket* paths)
{
    PacketHits hits;
    closestHits(nodes, blocks, rays, &hits);
    RayPacket shadow;
    VecLanes light;
    float extent[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(&paths->radiance, lane, vec3(0.0f, 0.0f, 0.0f));
        Vec3 brought = vec3(0.0f, 0.0f, 0.0f);
        setLaneVec(&light, lane, brought);
        paths->distance[lane] = INFINITY;
        paths->rays[lane] = rays->tMax[lane] > 0.0f ? 1u : 0u;
        paths->shadowRays[lane] = 0u;
        extent[lane] = 0.0f;
        const Vec3 direction = rayDirection(rays, lane);
        setRay(&shadow, lane, rayStart(rays, lane), direction, 0.0f, 0.0f);
        setTime(&shadow, lane, receiverTime(r, lane));
        if (r->pixel[lane] == WEDGE_NO_PIXEL || paths->index[lane] >= last[lane]) {
            continue;
        }
        const Hit hit = packetHit(&hits, lane);
        const Vec3 emitted = rays->tMax[lane] > 0.0f ? emittedOf(emitters, hit) : vec3(0.0f, 0.0f, 0.0f);
        if (luminance(emitted) > 0.0f && sampling.lightSampling != WEDGE_LIGHTS_SAMPLED) {
            const float own = reflectedTo(r, lane, glossy, direction).pdf;
            const float other = emitterPdf(emitters, hit, direction, receiverTime(r, lane));
            const float w = sampling.lightSampling == WEDGE_LIGHTS_BOTH ? powerHeuristic(own, other) : 1.0f;
            setLaneVec(&paths->radiance, lane, vecScale(emitted, w * weight[lane]));
            paths->distance[lane] = hit.t;
        }
        weight[lane] = 1.0f;
        if (sampling.lightSampling != WEDGE_LIGHTS_MET && emitters.count > 0u) {
            extent[lane] =
                emitterRay(emitters, sampling, paths, r, lane, glossy, laneVec(facing, lane), &shadow, &brought);
            setLaneVec(&light, lane, brought);
            paths->shadowRays[lane] = shadow.tMax[lane] > 0.0f ? 1u : 0u;
        }
    }
#ifdef WEDGE_SINK_TAKES_DISTANCES
    closestHits(nodes, blocks, &shadow, &hits);
#else
    uint occluded[WEDGE_PACKET_SIZE];
    anyHits(nodes, blocks, &shadow, occluded);
#endif
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (!(shadow.tMax[lane] > 0.0f)) {
            continue;
        }
        const float far = vecLength(rayDirection(&shadow, lane));
#ifdef WEDGE_SINK_TAKES_DISTANCES
        const bool hidden = hits.triangle[lane] != WEDGE_NO_TRIANGLE;
        const float penumbra = hidden ? extent[lane] * hits.t[lane] / fmax(1.0f - hits.t[lane], 1e-6f) : far;
#else
        const bool hidden = occluded[lane] != 0u;
        const float penumbra = far;
#endif
        setLaneVecIf(&paths->radiance, lane, !hidden, vecAdd(laneVec(&paths->radiance, lane), laneVec(&light, lane)));
        paths->distance[lane] = fmin(paths->distance[lane], fmax(fmin(penumbra, far), 1e-20f));
    }
}

#endif
