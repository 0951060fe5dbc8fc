// The bounding volume hierarchy as it lies in device memory: 8-wide or 4-wide nodes and blocks of triangles, all
// as structures of arrays, so that one ray tests a node's boxes or a block of triangles with one vector each.
#ifndef WEDGE_SHARED_BVH_TYPES_H
#define WEDGE_SHARED_BVH_TYPES_H

#include "compat.h"

/// Children of a node.
#define WEDGE_BVH_WIDTH 8
/// Children of a node of the narrow tree, which the scalar family of traversals walks.
#define WEDGE_BVH_NARROW_WIDTH 4
/// Triangles of a block: one vector of 8, which measured faster than 4 for single rays (docs/bvh.md).
#define WEDGE_BLOCK_SIZE 8
/// A child reference is an inner node's index, or, with this bit, a leaf: LEAF | firstBlock << 3 | blockCount.
/// A leaf of no blocks is an empty slot.
#define WEDGE_BVH_LEAF 0x80000000u
#define WEDGE_BVH_MAX_LEAF_BLOCKS 7
/// Marks an unused lane of a block, and the primitive of a ray that hit nothing.
#define WEDGE_NO_TRIANGLE 0xffffffffu
/// Stack entries of a single ray; the builder guarantees that none needs more. Packets need one more.
#define WEDGE_BVH_STACK 96

/// Rays that the wide family traces together: a block of 4x4 pixels.
#define WEDGE_WIDE_PACKET_SIZE 16

WEDGE_SHARED_BEGIN

/// Unused slots have lo = +1e30 and hi = -1e30 (no ray enters them) and child = WEDGE_BVH_LEAF.
typedef struct {
    float loX[WEDGE_BVH_WIDTH], hiX[WEDGE_BVH_WIDTH];
    float loY[WEDGE_BVH_WIDTH], hiY[WEDGE_BVH_WIDTH];
    float loZ[WEDGE_BVH_WIDTH], hiZ[WEDGE_BVH_WIDTH];
    uint child[WEDGE_BVH_WIDTH];
    float unit; ///< of the root: coordinates here are the mesh's times this power of two, and lie within +-1
    uint cutouts; ///< of the root: the block behind the triangles' where the table of cut-outs begins, if any
    uint padding[WEDGE_BVH_WIDTH - 2];
} BvhNode;

/// A node of the narrow tree: half as wide, over the same blocks, with references and empty slots of the same form.
typedef struct {
    float loX[WEDGE_BVH_NARROW_WIDTH], hiX[WEDGE_BVH_NARROW_WIDTH];
    float loY[WEDGE_BVH_NARROW_WIDTH], hiY[WEDGE_BVH_NARROW_WIDTH];
    float loZ[WEDGE_BVH_NARROW_WIDTH], hiZ[WEDGE_BVH_NARROW_WIDTH];
    uint child[WEDGE_BVH_NARROW_WIDTH];
    float unit; ///< of the root, as in BvhNode
    uint cutouts; ///< of the root, as in BvhNode
    uint padding[WEDGE_BVH_NARROW_WIDTH - 2];
} BvhNode4;

/// Nodes over geometry that moves while the shutter is open: the node at its opening, and how far each plane moves from
/// there until it closes, rounded outwards. A child's box at time t in [0, 1] is plane + t move. Empty slots do not
/// move.
typedef struct {
    float loX[WEDGE_BVH_WIDTH], hiX[WEDGE_BVH_WIDTH];
    float loY[WEDGE_BVH_WIDTH], hiY[WEDGE_BVH_WIDTH];
    float loZ[WEDGE_BVH_WIDTH], hiZ[WEDGE_BVH_WIDTH];
    uint child[WEDGE_BVH_WIDTH];
    float unit; ///< of the root, as in BvhNode; coordinates lie within +-1 at all times
    uint cutouts; ///< of the root, as in BvhNode
    uint padding[WEDGE_BVH_WIDTH - 2];
    float moveLoX[WEDGE_BVH_WIDTH], moveHiX[WEDGE_BVH_WIDTH];
    float moveLoY[WEDGE_BVH_WIDTH], moveHiY[WEDGE_BVH_WIDTH];
    float moveLoZ[WEDGE_BVH_WIDTH], moveHiZ[WEDGE_BVH_WIDTH];
} MovingNode;

typedef struct {
    float loX[WEDGE_BVH_NARROW_WIDTH], hiX[WEDGE_BVH_NARROW_WIDTH];
    float loY[WEDGE_BVH_NARROW_WIDTH], hiY[WEDGE_BVH_NARROW_WIDTH];
    float loZ[WEDGE_BVH_NARROW_WIDTH], hiZ[WEDGE_BVH_NARROW_WIDTH];
    uint child[WEDGE_BVH_NARROW_WIDTH];
    float unit; ///< of the root, as in BvhNode
    uint cutouts; ///< of the root, as in BvhNode
    uint padding[WEDGE_BVH_NARROW_WIDTH - 2];
    float moveLoX[WEDGE_BVH_NARROW_WIDTH], moveHiX[WEDGE_BVH_NARROW_WIDTH];
    float moveLoY[WEDGE_BVH_NARROW_WIDTH], moveHiY[WEDGE_BVH_NARROW_WIDTH];
    float moveLoZ[WEDGE_BVH_NARROW_WIDTH], moveHiZ[WEDGE_BVH_NARROW_WIDTH];
} MovingNode4;

// Device code knows one sort of blocks, by one name: those of its program.
#ifndef WEDGE_MOTION

/// Vertices, in the root's unit: triangles that share one have the same floats there, which the watertight test
/// relies on. A triangle without area has its first vertex three times; unused lanes are all zero with
/// triangle = WEDGE_NO_TRIANGLE.
typedef struct {
    float v0x[WEDGE_BLOCK_SIZE], v0y[WEDGE_BLOCK_SIZE], v0z[WEDGE_BLOCK_SIZE];
    float v1x[WEDGE_BLOCK_SIZE], v1y[WEDGE_BLOCK_SIZE], v1z[WEDGE_BLOCK_SIZE];
    float v2x[WEDGE_BLOCK_SIZE], v2y[WEDGE_BLOCK_SIZE], v2z[WEDGE_BLOCK_SIZE];
    uint triangle[WEDGE_BLOCK_SIZE];
} TriangleBlock;

#endif

/// As TriangleBlock, with vertices when the shutter opens and their displacement until it closes: floats that triangles
/// which share a vertex have in common, too. Triangles without area are as the others.
typedef struct {
    float v0x[WEDGE_BLOCK_SIZE], v0y[WEDGE_BLOCK_SIZE], v0z[WEDGE_BLOCK_SIZE];
    float v1x[WEDGE_BLOCK_SIZE], v1y[WEDGE_BLOCK_SIZE], v1z[WEDGE_BLOCK_SIZE];
    float v2x[WEDGE_BLOCK_SIZE], v2y[WEDGE_BLOCK_SIZE], v2z[WEDGE_BLOCK_SIZE];
    uint triangle[WEDGE_BLOCK_SIZE];
    float move0x[WEDGE_BLOCK_SIZE], move0y[WEDGE_BLOCK_SIZE], move0z[WEDGE_BLOCK_SIZE];
    float move1x[WEDGE_BLOCK_SIZE], move1y[WEDGE_BLOCK_SIZE], move1z[WEDGE_BLOCK_SIZE];
    float move2x[WEDGE_BLOCK_SIZE], move2y[WEDGE_BLOCK_SIZE], move2z[WEDGE_BLOCK_SIZE];
} MovingTriangleBlock;

#ifdef WEDGE_MOTION
typedef MovingTriangleBlock TriangleBlock;
#endif

WEDGE_SHARED_END

#endif
