// Direct light from beyond the scene: a direction of the map and a reflected one a sample, both weighted by the power
// heuristic.
#ifndef WEDGE_ENVIRONMENT_RAYS_H
#define WEDGE_ENVIRONMENT_RAYS_H

#include "light/unshadowed_environment.h"
#include "paths/emitter_rays.h"

/// Of what hides a direction, a metre away: how far a reflector would be whose light varies as what the occluder lets
/// through does. What the map has around the direction is as wide as a disk of even density: the penumbra of a small
/// sun is narrow, that of an even sky as wide as the occluder is far (B_e of (6.13), by direction). occluders: 1 / (cos
/// theta), z / cos^2 theta of (6.13) at the height z = r cos theta. Infinite where the map is dark. cosine: with the
/// normal
WEDGE_FN float penumbraOf(BeyondData beyond, BeyondSample seen, uint occluders, float cosine)
{
    const float extent = fmin(1.0f, rsqrt(fmax(6.28318531f * seen.pdf, 1e-20f)));
    const float reach = occluders != 0u ? 1.0f / fmax(cosine, 1e-6f) : extent;
    return luminance(seen.radiance) > beyond.map.dark ? reach : INFINITY;
}

/// Divides what lanes' samples bring by what would come to their receivers if nothing were hidden.
WEDGE_FN void divideByUnshadowed(
    __global const EnvironmentMap* environment, BeyondData beyond, const ReceiverPacket* r, PathPacket* paths)
{
    // Packets may have fewer lanes than vectors.
    float x[16] = { 0.0f }, y[16] = { 0.0f }, z[16] = { 0.0f };
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        x[lane] = r->normalX[lane];
        y[lane] = r->normalY[lane];
        z[lane] = r->normalZ[lane];
    }
    Vec3x16 n;
    n.x = vload16(0, x);
    n.y = vload16(0, y);
    n.z = vload16(0, z);
    const Vec3x16 whole = unshadowedLight(environment, beyond.table, n);
    vstore16(1.0f / whole.x, 0, x);
    vstore16(1.0f / whole.y, 0, y);
    vstore16(1.0f / whole.z, 0, z);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 share = vec3(x[lane], y[lane], z[lane]);
        setLaneVec(&paths->radiance, lane, vecMul(laneVec(&paths->radiance, lane), share));
    }
}

/// One sample a lane, whose reflected direction is that of `rays` and counts `weight`, which becomes 1: fills
/// paths->radiance, counts of rays, and in paths->distance, where sinks take distances, what widths follow from: see
/// penumbraOf(). whole: of `fractions`, luminance of what would be seen if nothing were hidden.
WEDGE_FN void traceEnvironment(__global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, BeyondData beyond, SampleParams sampling, bool glossy,
    bool fractions, uint occluders, const ReceiverPacket* r, const VecLanes* facing, const uint* last,
    const RayPacket* rays, float* weight, PathPacket* paths, float* whole)
{
    const bool both = sampling.lightSampling == WEDGE_LIGHTS_BOTH;
    PacketHits hits;
    closestHits(nodes, blocks, rays, &hits);
    RayPacket shadow;
    VecLanes light;
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE], extent[WEDGE_PACKET_SIZE];
    uint live[WEDGE_PACKET_SIZE];
    beginDirect(sampling, r, last, rays, paths, live, u, v, &shadow, &light);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        extent[lane] = INFINITY;
        whole[lane] = 0.0f;
        if (live[lane] == 0u) {
            continue;
        }
        const Vec3 direction = rayDirection(rays, lane);
        const bool follows = rays->tMax[lane] > 0.0f, open = hits.triangle[lane] == WEDGE_NO_TRIANGLE;
        if (follows && (open || fractions)) {
            const BeyondSample seen = seenBeyond(beyond, direction);
            const float own = reflectedTo(r, lane, glossy, direction).pdf;
            const float w = both ? powerHeuristic(own, seen.pdf) : 1.0f;
            const Vec3 brought = vecScale(seen.radiance, w * weight[lane]);
            whole[lane] = luminance(brought);
            setLaneVecIf(&paths->radiance, lane, open, brought);
        }
#ifdef WEDGE_SINK_TAKES_DISTANCES
        if (follows && !open) {
            const float cosine = vecDot(vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]), direction);
            const float reach = penumbraOf(beyond, seenBeyond(beyond, direction), occluders, cosine);
            paths->distance[lane] = fmax(reach * hits.t[lane], 1e-20f);
        }
#endif
        weight[lane] = 1.0f;
        if (sampling.lightSampling == WEDGE_LIGHTS_MET) {
            continue;
        }
        const BeyondSample chosen = chooseBeyond(beyond, vec2(u[lane], v[lane]));
        const Vec3 l = chosen.direction, n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        if (vecDot(n, l) > 0.0f && vecDot(laneVec(facing, lane), l) > 0.0f && chosen.pdf > 0.0f) {
            const Reflected reflected = reflectedTo(r, lane, glossy, l);
            const float w = both ? powerHeuristic(chosen.pdf, reflected.pdf) : 1.0f;
            const Vec3 brought = vecScale(chosen.radiance, w * reflected.value / chosen.pdf);
            if (luminance(brought) > 0.0f) {
                whole[lane] += luminance(brought);
                setLaneVec(&light, lane, brought);
                const Vec3 origin = vec3(r->originX[lane], r->originY[lane], r->originZ[lane]);
                setRay(&shadow, lane, origin, l, 0.0f, INFINITY);
                extent[lane] = penumbraOf(beyond, chosen, occluders, vecDot(n, l));
                paths->shadowRays[lane] = 1u;
            }
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
#ifdef WEDGE_SINK_TAKES_DISTANCES
        const bool hidden = hits.triangle[lane] != WEDGE_NO_TRIANGLE;
        paths->distance[lane] =
            hidden ? fmin(paths->distance[lane], fmax(extent[lane] * hits.t[lane], 1e-20f)) : paths->distance[lane];
#else
        const bool hidden = occluded[lane] != 0u;
#endif
        setLaneVecIf(&paths->radiance, lane, !hidden, vecAdd(laneVec(&paths->radiance, lane), laneVec(&light, lane)));
    }
}

#endif
