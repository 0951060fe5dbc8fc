#pragma once

#include "bvh/moving.h"

namespace wedge::bvh {

/// The hierarchy with 4 children a node instead of 8, for the scalar family of traversals
/// (kernels/trace/traverse_scalar.h). It refers to the same blocks: only nodes differ. Each node of up to 4 children
/// becomes one node; those of more become one whose children are grouped, each group a node of its own, so that the
/// boxes of the groups are small. nodes[0] is the root, has the hierarchy's unit and is always there; children follow
/// their parents. Takes time in proportion to the nodes.
///
/// A traversal's stack needs no more entries than in the wide tree, and so WEDGE_BVH_STACK suffices. It leaves at most
/// c - 1 entries at a wide node of c children when it goes on into one of them. Here it passes the root of the node's
/// little tree, of k children, and perhaps a group of s: k - 1 + s - 1 entries. The other k - 1 children have at least
/// one of the c each, so k - 1 + s <= c, and k + s - 2 <= c - 1.
std::vector<shared::BvhNode4> narrow(const Bvh& bvh);

/// The same of a hierarchy that moves; areas are means over time.
std::vector<shared::MovingNode4> narrow(const MovingBvh& bvh);

} // namespace wedge::bvh
