// Coordinates at a ray's time, where geometry moves while the shutter is open: programs with WEDGE_MOTION, whose nodes
// and blocks hold what they are at the opening and how far they move (shared/bvh_types.h). In programs without, each of
// these is the load that it stands for, and times do not exist.
#ifndef WEDGE_MOTION_H
#define WEDGE_MOTION_H

#ifdef WEDGE_MOTION

/// From planes and vertices to their displacements, in floats.
#define WEDGE_NODE_MOTION (8 * WEDGE_NODE_WIDTH)
#define WEDGE_BLOCK_MOTION (10 * WEDGE_BLOCK_SIZE)

/// The time of a ray, or of each of a packet's.
#define WEDGE_TIME_OF(ray) ((ray)->time)
/// The type of a vertex' coordinate as the rays of a packet see it.
#define WEDGE_PACKET_COORDINATE float16

/// A plane of 4 or 8 boxes, or of one, and a coordinate of 8 vertices, or of one. Multiply-adds must not be fused for
/// vertices: triangles that share one must agree on it to the last bit.
#define WEDGE_PLANES4(p, time) (vload4(0, p) + vload4(0, (p) + WEDGE_NODE_MOTION) * (time))
#define WEDGE_PLANES8(p, time) (vload8(0, p) + vload8(0, (p) + WEDGE_NODE_MOTION) * (time))
#define WEDGE_PLANE(p, i, time) (*((p) + (i)) + *((p) + (i) + WEDGE_NODE_MOTION) * (time))
#define WEDGE_CORNERS8(p, time) (vload8(0, p) + vload8(0, (p) + WEDGE_BLOCK_MOTION) * (time))
#define WEDGE_CORNER(p, i, time) (*((p) + (i)) + *((p) + (i) + WEDGE_BLOCK_MOTION) * (time))

/// A plane of 8 boxes where it is lowest (highest) of all times.
#define WEDGE_LOWEST8(p) (vload8(0, p) + WEDGE_MIN(vload8(0, (p) + WEDGE_NODE_MOTION), (float8)(0.0f)))
#define WEDGE_HIGHEST8(p) (vload8(0, p) + WEDGE_MAX(vload8(0, (p) + WEDGE_NODE_MOTION), (float8)(0.0f)))

/// Whether the edges e1 and e2 with the cross product n span an area, lane by lane. Triangles that have none for a
/// moment cannot be taken out beforehand, and where n is nothing but rounding so is t. Largest components stand for
/// lengths, so that nothing leaves a float's range: sines below 4.8e-7 never pass, those above 2.6e-6 always.
#define WEDGE_LARGEST(x, y, z) WEDGE_MAX(WEDGE_MAX(fabs(x), fabs(y)), fabs(z))
#define WEDGE_SPANS_AREA(nx, ny, nz, e1x, e1y, e1z, e2x, e2y, e2z)                                                     \
    (WEDGE_LARGEST(nx, ny, nz) > 1.46e-6f * WEDGE_LARGEST(e1x, e1y, e1z) * WEDGE_LARGEST(e2x, e2y, e2z))

#else

#define WEDGE_TIME_OF(ray) 0.0f
#define WEDGE_PACKET_COORDINATE float
#define WEDGE_PLANES4(p, time) vload4(0, p)
#define WEDGE_PLANES8(p, time) vload8(0, p)
#define WEDGE_PLANE(p, i, time) p[i]
#define WEDGE_CORNERS8(p, time) vload8(0, p)
#define WEDGE_CORNER(p, i, time) p[i]

#endif

#endif
