// A vector of each lane of a packet, number by number: loops over lanes are to become vectors.
#ifndef WEDGE_VEC_LANES_H
#define WEDGE_VEC_LANES_H

#include "core/packet_size.h"
#include "shared/vec.h"

typedef struct {
    float x[WEDGE_PACKET_SIZE], y[WEDGE_PACKET_SIZE], z[WEDGE_PACKET_SIZE];
} VecLanes;

WEDGE_INLINE Vec3 laneVec(const VecLanes* v, uint lane) { return vec3(v->x[lane], v->y[lane], v->z[lane]); }

WEDGE_INLINE void setLaneVec(VecLanes* v, uint lane, Vec3 a)
{
    v->x[lane] = a.x;
    v->y[lane] = a.y;
    v->z[lane] = a.z;
}

/// Sets a lane where the condition holds.
WEDGE_INLINE void setLaneVecIf(VecLanes* v, uint lane, bool condition, Vec3 a)
{
    setLaneVec(v, lane, vecChoose(condition, a, laneVec(v, lane)));
}

#endif
