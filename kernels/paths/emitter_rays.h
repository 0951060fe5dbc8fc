// Direct light of meshes that emit: a point on one of them and a reflected direction a sample, both weighted by the
// power heuristic.
#ifndef WEDGE_EMITTER_RAYS_H
#define WEDGE_EMITTER_RAYS_H

#include "light/scene_light.h"
#include "paths/path_state.h"

/// Which lanes follow reflected directions. Diffuse receivers of emitters do where these may be denser than points on
/// the nearest of them, were it overhead and face on; elsewhere points alone do as well, for one ray in the place of
/// two. Decided by the receiver alone, so that each sample's expectation is the same.
WEDGE_FN void followDirections(PathParams params, const ReceiverPacket* r, uint* follows)
{
    const bool both = params.component == WEDGE_COMPONENT_EMITTERS && params.lightSampling == WEDGE_LIGHTS_BOTH;
    const bool none = params.component >= WEDGE_COMPONENT_EMITTERS && params.lightSampling == WEDGE_LIGHTS_SAMPLED;
    const Vec3 low = params.emittersLow, high = params.emittersHigh;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 p = vec3(r->positionX[lane], r->positionY[lane], r->positionZ[lane]);
        const Vec3 d = vec3(fmax(fmax(low.x - p.x, p.x - high.x), 0.0f), fmax(fmax(low.y - p.y, p.y - high.y), 0.0f),
            fmax(fmax(low.z - p.z, p.z - high.z), 0.0f));
        const bool near = vecLength(d) <= params.directedWithin;
        follows[lane] = !none && (!both || near) ? 1u : 0u;
    }
}

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

/// A shadow ray of the lane to the point of the numbers u into `shadow`, and in *light what it brings if nothing is in
/// the way. follows: the lane's other technique is reflected directions. Returns the emitter's extent.
WEDGE_FN float emitterRay(EmitterData emitters, Vec2 u, const ReceiverPacket* r, uint lane, bool glossy, bool follows,
    Vec3 facing, RayPacket* shadow, Vec3* light)
{
    const Vec3 origin = vec3(r->originX[lane], r->originY[lane], r->originZ[lane]);
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
    const EmitterPoint p = sampleEmitter(emitters, u, receiverTime(r, lane));
    const Vec3 ray = vecSub(p.point, origin);
    const float distance = vecLength(ray);
    const Vec3 l = vecScale(ray, 1.0f / fmax(distance, 1e-30f));
    if (!(vecDot(n, l) > 0.0f) || !(vecDot(facing, l) > 0.0f) || !(p.density > 0.0f) || !(distance > 0.0f)
        || !emitsAgainst(&p, l)) {
        return p.extent;
    }
    const Reflected reflected = reflectedTo(r, lane, glossy, l);
    const float pdf = densityOfDirection(p.density, p.normal, l, distance);
    const float w = follows ? powerHeuristic(pdf, reflected.pdf) : 1.0f;
    *light = vecScale(p.radiance, w * reflected.value / pdf);
    if (luminance(*light) > 0.0f) {
        setRay(shadow, lane, origin, emitterShadowRay(&p, origin), 0.0f, p.end);
    }
    return p.extent;
}

/// What the lanes' rays meet of the quads that share the term.
typedef struct {
    VecLanes radiance; ///< weighted against points on them
    float distance[WEDGE_PACKET_SIZE]; ///< metres to the nearest; +inf where there is none
    bool any; ///< of the lanes; if not, the others are void
} QuadsMet;

WEDGE_FN void meetQuads(LightData lights, bool glossy, const ReceiverPacket* r, const RayPacket* rays,
    const PacketHits* hits, QuadsMet* out)
{
    out->any = lights.areaCount > 0u && lights.sampling != WEDGE_LIGHTS_SAMPLED;
    if (!out->any) {
        return;
    }
    float own[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        own[lane] = reflectedTo(r, lane, glossy, rayDirection(rays, lane)).pdf;
        setLaneVec(&out->radiance, lane, vec3(0.0f, 0.0f, 0.0f));
        out->distance[lane] = INFINITY;
    }
    for (uint i = 0u; i < lights.areaCount; ++i) {
        AreaLight light = lights.area[i];
        light.pick = light.sharedPick;
        if (light.pick < 0.0f) {
            continue;
        }
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const LightMeeting m = meetLight(light, rayStart(rays, lane), rayDirection(rays, lane));
            const bool meets = rays->tMax[lane] > 0.0f && isMetBefore(light, m, rayStart(rays, lane), hits->t[lane]);
            const float profile = metProfile(light, m);
            const float other = lightPdf(light, m.a, m.b, m.t, m.facing);
            const float w = lights.sampling == WEDGE_LIGHTS_MET ? 1.0f : powerHeuristic(own[lane], other);
            const Vec3 sum = vecMad(laneVec(&out->radiance, lane), light.radiance, w * profile);
            setLaneVecIf(&out->radiance, lane, meets, sum);
            out->distance[lane] = meets && profile > 0.0f ? fmin(out->distance[lane], m.t) : out->distance[lane];
        }
    }
}

/// The random numbers of one sample a lane, and what it brings before anything is known of it: no light, no shadow ray.
WEDGE_FN void beginDirect(SampleParams sampling, const ReceiverPacket* r, const uint* last, const RayPacket* rays,
    PathPacket* paths, uint* live, float* u, float* v, RayPacket* shadow, VecLanes* light)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        live[lane] = r->pixel[lane] != WEDGE_NO_PIXEL && paths->index[lane] < last[lane] ? 1u : 0u;
    }
    pathPairs(sampling, paths, live, 0u, WEDGE_DIMENSION_LIGHT, u, v);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(&paths->radiance, lane, vec3(0.0f, 0.0f, 0.0f));
        setLaneVec(light, lane, vec3(0.0f, 0.0f, 0.0f));
        paths->distance[lane] = INFINITY;
        paths->rays[lane] = rays->tMax[lane] > 0.0f ? 1u : 0u;
        paths->shadowRays[lane] = 0u;
        setRay(shadow, lane, rayStart(rays, lane), rayDirection(rays, lane), 0.0f, 0.0f);
        setTime(shadow, lane, receiverTime(r, lane));
    }
}

/// One sample a lane, whose reflected direction, if it follows one, is that of `rays` and counts `weight`, which
/// becomes 1: fills paths->radiance and counts of rays, and, where sinks take distances, in paths->distance what widths
/// follow from: how far it is to what emits; or, where something is in between, how far from there a reflector would be
/// whose light varies as the penumbra does, (the emitter's extent) t / (T - t) for an occluder t on a way of T metres.
WEDGE_FN void traceEmitters(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    LightData lights, SampleParams sampling, bool glossy, const ReceiverPacket* r, const VecLanes* facing,
    const uint* last, const uint* follows, const RayPacket* rays, float* weight, PathPacket* paths)
{
    const EmitterData emitters = lights.emitters;
    PacketHits hits;
    closestHits(nodes, blocks, rays, &hits);
    QuadsMet quads;
    meetQuads(lights, glossy, r, rays, &hits, &quads);
    RayPacket shadow;
    VecLanes light;
    float extent[WEDGE_PACKET_SIZE], u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE];
    uint live[WEDGE_PACKET_SIZE];
    beginDirect(sampling, r, last, rays, paths, live, u, v, &shadow, &light);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        Vec3 brought = vec3(0.0f, 0.0f, 0.0f);
        extent[lane] = 0.0f;
        const Vec3 direction = rayDirection(rays, lane);
        if (live[lane] == 0u) {
            continue;
        }
        const Hit hit = packetHit(&hits, lane);
        const Vec3 emitted = rays->tMax[lane] > 0.0f ? emittedOf(emitters, hit) : vec3(0.0f, 0.0f, 0.0f);
        const bool met = luminance(emitted) > 0.0f && emitters.picks[hit.triangle] >= 0.0f;
        if (met && sampling.lightSampling != WEDGE_LIGHTS_SAMPLED) {
            const float own = reflectedTo(r, lane, glossy, direction).pdf;
            const float other = emitterPdf(emitters, hit, direction, receiverTime(r, lane));
            const float w = sampling.lightSampling == WEDGE_LIGHTS_BOTH ? powerHeuristic(own, other) : 1.0f;
            setLaneVec(&paths->radiance, lane, vecScale(emitted, w * weight[lane]));
            paths->distance[lane] = hit.t;
        }
        if (quads.any) {
            const Vec3 more = vecScale(laneVec(&quads.radiance, lane), weight[lane]);
            setLaneVec(&paths->radiance, lane, vecAdd(laneVec(&paths->radiance, lane), more));
            paths->distance[lane] = fmin(paths->distance[lane], quads.distance[lane]);
        }
        weight[lane] = 1.0f;
        if (sampling.lightSampling != WEDGE_LIGHTS_MET && emitters.count > 0u) {
            extent[lane] = emitterRay(emitters, vec2(u[lane], v[lane]), r, lane, glossy, follows[lane] != 0u,
                laneVec(facing, lane), &shadow, &brought);
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
