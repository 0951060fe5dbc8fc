// Where a packet's paths are: the surfaces there, and how they scatter. What differs from lane to lane in kind (the
// surface, the light) is fetched one by one; arithmetic is in loops over lanes without branches, which become
// vectors. What no lane needs, such as lobes, is left out for all of them.
#ifndef WEDGE_PATH_VERTICES_H
#define WEDGE_PATH_VERTICES_H

#include "paths/path_state.h"
#include "shared/mirror.h"
#include "trace/surface_lanes.h"

/// Scattering is Lambert and one specular lobe; or that of a mirror or glass, which has neither.
typedef struct {
    uint live[WEDGE_PACKET_SIZE]; ///< 1: the lane's path is at a surface; else all else of it is void, and finite
    VecLanes origin, normal, geometric; ///< as of Surface
    VecLanes view; ///< unit, to where the path came from
    VecLanes diffuse, specular; ///< reflectances
    float exponent[WEDGE_PACKET_SIZE], normalization[WEDGE_PACKET_SIZE], leastCosine[WEDGE_PACKET_SIZE];
    uint kind[WEDGE_PACKET_SIZE], glossy[WEDGE_PACKET_SIZE]; ///< of lobes, and 1 where there is one
    float diffuseShare[WEDGE_PACKET_SIZE]; ///< probability that the path goes on by the diffuse part
    bool any, anyGlossy; ///< of the live lanes
#ifdef WEDGE_MIRRORS
    VecLanes position; ///< as of Surface
    bool anyMirror;
#endif
} VertexPacket;

WEDGE_INLINE Lobe vertexLobe(const VertexPacket* at, uint lane)
{
    Lobe lobe;
    lobe.exponent = at->exponent[lane];
    lobe.kind = at->kind[lane];
    lobe.normalization = at->normalization[lane];
    lobe.leastCosine = at->leastCosine[lane];
    return lobe;
}

/// Which part a path goes on by, and the lobes' numbers.
WEDGE_FN void prepareScattering(VertexPacket* at)
{
    uint any = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const float d = luminance(laneVec(&at->diffuse, lane));
        const float g = luminance(laneVec(&at->specular, lane));
        at->glossy[lane] = g > 0.0f ? 1u : 0u;
        at->diffuseShare[lane] = g > 0.0f ? d / (d + g) : 1.0f;
        at->exponent[lane] = g > 0.0f ? at->exponent[lane] : 1.0f;
        at->normalization[lane] = at->leastCosine[lane] = 1.0f;
        any |= at->glossy[lane];
    }
    at->anyGlossy = any != 0u;
    if (at->anyGlossy) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const Lobe lobe = makeLobe(at->exponent[lane], at->kind[lane]);
            at->normalization[lane] = lobe.normalization;
            at->leastCosine[lane] = lobe.leastCosine;
        }
#ifdef WEDGE_GGX
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const float rise = fresnelRise(laneVec(&at->diffuse, lane), laneVec(&at->specular, lane));
            at->normalization[lane] = at->kind[lane] == WEDGE_MICROFACETS ? rise : at->normalization[lane];
        }
#endif
    }
}

/// Fetches what the rays hit; where they hit nothing, zeros.
WEDGE_FN void fetchSurfaces(
    SurfaceData surfaces, const RayPacket* rays, const PacketHits* hits, CornerLanes* corners, VertexPacket* at)
{
    at->any = false;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Hit hit = packetHit(hits, lane);
        const bool live = hit.triangle != WEDGE_NO_TRIANGLE;
        at->live[lane] = live ? 1u : 0u;
        at->any |= live;
        Corners k = noCorners();
        Finish finish = noFinish();
        if (live) {
            k = cornersOf(surfaces, hit.triangle, timeOf(rays, lane));
            finish = finishOf(surfaces, hit);
        }
        setLaneCorners(corners, lane, k);
        setLaneVec(&at->diffuse, lane, finish.diffuse);
        setLaneVec(&at->specular, lane, finish.specular);
        at->exponent[lane] = finish.gloss.exponent;
        at->kind[lane] = finish.gloss.kind;
    }
}

/// The surfaces that the rays hit, as seen from where they come from.
WEDGE_FN void loadVertices(SurfaceData surfaces, const RayPacket* rays, const PacketHits* hits, VertexPacket* at)
{
    CornerLanes corners;
    fetchSurfaces(surfaces, rays, hits, &corners, at);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 direction = rayDirection(rays, lane);
        Facet f = facetOf(laneCorners(&corners, lane), hits->u[lane], hits->v[lane], direction);
#ifdef WEDGE_MIRRORS
        mirrorFacet(laneCorners(&corners, lane), hits->u[lane], hits->v[lane], direction, &f, &at->kind[lane]);
        setLaneVec(&at->position, lane, f.position);
#endif
#ifdef WEDGE_GGX
        microfacetFacet(makeGloss(at->exponent[lane], at->kind[lane]), vecScale(direction, -1.0f), &f);
#endif
        setLaneVec(&at->origin, lane, f.origin);
        setLaneVec(&at->normal, lane, f.normal);
        setLaneVec(&at->geometric, lane, f.geometric);
        setLaneVec(&at->view, lane, vecScale(direction, -1.0f));
    }
#ifdef WEDGE_NORMAL_MAPS
    mapNormals(surfaces, hits, &corners, at->live, &at->geometric, &at->normal);
#endif
    prepareScattering(at);
#ifdef WEDGE_MIRRORS
    at->anyMirror = false;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        at->anyMirror |= at->live[lane] != 0u && WEDGE_IS_MIRROR(at->kind[lane]);
    }
#endif
}

#ifdef WEDGE_MIRRORS
/// A ray from a mirror or glass: its start, and Deflection.
typedef struct {
    Vec3 start;
    Deflection to;
} MirrorRay;

/// Follows the unit view v at a surface of that kind. origin: on v's side, as far from the surface as rays start
WEDGE_FN MirrorRay mirrorRay(__global const MaterialData* materials, uint kind, Vec3 position, Vec3 origin, Vec3 normal,
    Vec3 geometric, Vec3 v, float choice)
{
    const MaterialData material = materials[kind >> WEDGE_MIRROR_BITS];
    const bool glass = (kind & 7u) == WEDGE_GLASS, behind = (kind & WEDGE_MIRROR_BEHIND) != 0u;
    const float index = glass ? (behind ? 1.0f / material.exponent : material.exponent) : 0.0f;
    MirrorRay ray;
    ray.to = deflect(normal, geometric, v, index, material.specular, material.diffuse, choice);
    const float off = vecDot(vecSub(origin, position), geometric);
    ray.start = vecMad(origin, geometric, ray.to.through != 0u ? -2.0f * off : 0.0f);
    return ray;
}

/// Of a lane's vertex.
WEDGE_FN MirrorRay vertexMirrorRay(
    __global const MaterialData* materials, const VertexPacket* at, uint lane, float choice)
{
    return mirrorRay(materials, at->kind[lane], laneVec(&at->position, lane), laneVec(&at->origin, lane),
        laneVec(&at->normal, lane), laneVec(&at->geometric, lane), laneVec(&at->view, lane), choice);
}
#endif

/// What the surfaces reflect from unit directions l, in 1/sr, and the densities at which paths go on in them. Holds
/// for directions above the horizons of both normals.
WEDGE_FN void scatter(const VertexPacket* at, const VecLanes* l, VecLanes* value, float* pdf)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(value, lane, vecScale(laneVec(&at->diffuse, lane), WEDGE_INV_PI));
        const float cosine = vecDot(laneVec(&at->normal, lane), laneVec(l, lane));
        pdf[lane] = at->diffuseShare[lane] * fmax(0.0f, cosine) * WEDGE_INV_PI;
    }
    if (!at->anyGlossy) {
        return;
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool glossy = at->glossy[lane] != 0u;
        const LobeAt lobe =
            lobeAt(vertexLobe(at, lane), laneVec(&at->normal, lane), laneVec(&at->view, lane), laneVec(l, lane));
        const Vec3 sum = vecMad(laneVec(value, lane), laneVec(&at->specular, lane), lobe.value);
        setLaneVecIf(value, lane, glossy, sum);
        pdf[lane] += glossy ? (1.0f - at->diffuseShare[lane]) * lobe.pdf : 0.0f;
    }
}

/// A direction of each lane to go on in, by either part, for the numbers (u, v); those of `choice` choose the part.
WEDGE_FN void sampleScattering(const VertexPacket* at, const float* u, const float* v, const float* choice, VecLanes* l)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(l, lane, cosineDirection(laneVec(&at->normal, lane), vec2(u[lane], v[lane])));
    }
    if (!at->anyGlossy) {
        return;
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 reflected = sampleLobe(
            vertexLobe(at, lane), laneVec(&at->normal, lane), laneVec(&at->view, lane), vec2(u[lane], v[lane]));
        setLaneVecIf(l, lane, choice[lane] >= at->diffuseShare[lane], reflected);
    }
}

#endif
