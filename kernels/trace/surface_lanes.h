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

#endif
