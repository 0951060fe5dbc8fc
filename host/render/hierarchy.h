#pragma once

#include "bvh/bvh.h"
#include "bvh/moving.h"
#include "host/device/limits.h"
#include "host/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace wedge::render {

/// Which family of traversals kernels are built with, docs/traversal.md. Both find the same hits.
enum class Traversal {
    Automatic, ///< by the device's type
    Wide, ///< 8-wide nodes, vectors of 8, packets of 16 rays: for CPUs
    Scalar, ///< 4-wide nodes, one triangle at a time: for GPUs
};

/// What Automatic comes to on a device: wide on CPUs, scalar on all others. Anything else stays as it is.
Traversal resolveTraversal(Traversal wanted, const device::DeviceInfo& device);

/// "auto", "wide" or "scalar".
std::string traversalName(Traversal traversal);

/// Rays that a work-item of a family traces together, and so the pixels that it takes of a pass over tiles.
std::size_t packetSize(Traversal family);

/// A hierarchy with the nodes that one family of traversals walks.
struct Hierarchy {
    /// wide by default; never Automatic.
    explicit Hierarchy(bvh::Bvh built, Traversal family = Traversal::Wide);
    /// Over geometry that moves, for programs with WEDGE_MOTION.
    explicit Hierarchy(bvh::MovingBvh built, Traversal family = Traversal::Wide);

    /// The nodes as they go to the device: BvhNode for the wide family, BvhNode4 for the scalar one; MovingNode and
    /// MovingNode4 where geometry moves.
    std::span<const std::byte> nodes() const;
    /// The blocks as they go to the device: TriangleBlock, or MovingTriangleBlock; behind them the table of cut-outs.
    std::span<const std::byte> blocks() const;

    /// Puts a table of cut-outs (cutoutTable()) behind the blocks, for programs with WEDGE_CUTOUTS. Once at most.
    void append(std::span<const std::uint32_t> cutouts);

    bool moves;
    bool hasCutouts = false; ///< what append() put behind the blocks
    Traversal traversal;
    bvh::Bvh bvh; ///< only its statistics where geometry moves
    std::vector<shared::BvhNode4> narrow; ///< empty for the wide family
    bvh::MovingBvh moving; ///< where geometry moves, and its nodes of the scalar family:
    std::vector<shared::MovingNode4> movingNarrow;
};

/// The hierarchy of a scene's geometry, over its motion where it moves, with its cut-outs.
Hierarchy buildHierarchy(const scene::Scene& scene, bvh::Mode mode, Traversal family = Traversal::Wide);

} // namespace wedge::render
