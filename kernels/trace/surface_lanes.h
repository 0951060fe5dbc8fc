// The triangles that a packet's rays hit, for loops over lanes: what is fetched is fetched one by one, and facetOf() of
// each lane becomes a vector.
#ifndef WEDGE_SURFACE_LANES_H
#define WEDGE_SURFACE_LANES_H

#include "core/vec_lanes.h"
#include "trace/packet.h"
#include "trace/surface.h"

/// Corners of each lane's triangle.
typedef struct {
    VecLanes a, b, c, normalA, normalB, normalC;
} CornerLanes;

WEDGE_INLINE Corners laneCorners(const CornerLanes* k, uint lane)
{
    Corners out;
    out.a = laneVec(&k->a, lane);
    out.b = laneVec(&k->b, lane);
    out.c = laneVec(&k->c, lane);
    out.normalA = laneVec(&k->normalA, lane);
    out.normalB = laneVec(&k->normalB, lane);
    out.normalC = laneVec(&k->normalC, lane);
    return out;
}

WEDGE_INLINE void setLaneCorners(CornerLanes* k, uint lane, Corners of)
{
    setLaneVec(&k->a, lane, of.a);
    setLaneVec(&k->b, lane, of.b);
    setLaneVec(&k->c, lane, of.c);
    setLaneVec(&k->normalA, lane, of.normalA);
    setLaneVec(&k->normalB, lane, of.normalB);
    setLaneVec(&k->normalC, lane, of.normalC);
}

/// Of lanes that hit nothing.
WEDGE_FN Corners noCorners(void)
{
    Corners k;
    k.a = k.b = k.c = k.normalA = k.normalB = k.normalC = vec3(0.0f, 0.0f, 0.0f);
    return k;
}

WEDGE_FN Finish noFinish(void)
{
    Finish finish;
    finish.diffuse = finish.specular = finish.emission = vec3(0.0f, 0.0f, 0.0f);
    finish.gloss = makeGloss(1.0f, WEDGE_LAMBERT);
    return finish;
}

/// As Surface, lane by lane.
typedef struct {
    uint live[WEDGE_PACKET_SIZE]; ///< 1: the lane's ray met a surface; else all else is void, and directions finite
    VecLanes position, origin, normal, geometric;
    VecLanes diffuse, specular, emission;
    uint gloss[WEDGE_PACKET_SIZE]; ///< packGloss()
#ifdef WEDGE_NORMAL_MAPS
    VecLanes unmapped; ///< normals without their maps
#endif
} SurfaceLanes;

#ifdef WEDGE_NORMAL_MAPS
/// mappedNormal() of each live lane, from its normals.
WEDGE_FN void mapNormals(SurfaceData data, const PacketHits* hits, const CornerLanes* corners, const uint* live,
    const VecLanes* geometric, VecLanes* normal)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (live[lane] != 0u) {
            setLaneVec(normal, lane,
                mappedNormal(data, packetHit(hits, lane), laneCorners(corners, lane), laneVec(normal, lane),
                    laneVec(geometric, lane)));
        }
    }
}
#endif

/// surfaceAt() of each lane's hit.
WEDGE_FN void surfacesAt(SurfaceData data, const RayPacket* rays, const PacketHits* hits, SurfaceLanes* s)
{
    CornerLanes corners;
#ifdef WEDGE_GGX
    Gloss gloss[WEDGE_PACKET_SIZE];
#endif
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Hit hit = packetHit(hits, lane);
        Corners k = noCorners();
        Finish finish = noFinish();
        s->live[lane] = hit.triangle != WEDGE_NO_TRIANGLE ? 1u : 0u;
        if (s->live[lane] != 0u) {
            k = cornersOf(data, hit.triangle, timeOf(rays, lane));
            finish = finishOf(data, hit);
        }
        setLaneCorners(&corners, lane, k);
        setLaneVec(&s->diffuse, lane, finish.diffuse);
        setLaneVec(&s->specular, lane, finish.specular);
        setLaneVec(&s->emission, lane, finish.emission);
        s->gloss[lane] = packGloss(finish.gloss);
#ifdef WEDGE_GGX
        gloss[lane] = finish.gloss;
#endif
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 direction = rayDirection(rays, lane);
        Facet f = facetOf(laneCorners(&corners, lane), hits->u[lane], hits->v[lane], direction);
#ifdef WEDGE_MIRRORS
        mirrorFacet(laneCorners(&corners, lane), hits->u[lane], hits->v[lane], direction, &f, &s->gloss[lane]);
#endif
        const bool live = s->live[lane] != 0u;
        const Vec3 facing = vecScale(vecNormalize(direction), -1.0f);
#ifdef WEDGE_GGX
        microfacetFacet(gloss[lane], facing, &f);
#endif
        setLaneVec(&s->position, lane, f.position);
        setLaneVec(&s->origin, lane, f.origin);
        setLaneVec(&s->normal, lane, vecChoose(live, f.normal, facing));
        setLaneVec(&s->geometric, lane, vecChoose(live, f.geometric, facing));
    }
#ifdef WEDGE_NORMAL_MAPS
    s->unmapped = s->normal;
    mapNormals(data, hits, &corners, s->live, &s->geometric, &s->normal);
#endif
}

#endif
