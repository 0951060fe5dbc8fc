#include "host/render/hierarchy.h"

#include "bvh/narrow_tree.h"

#include <cassert>

namespace wedge::render {

Traversal resolveTraversal(Traversal wanted, const device::DeviceInfo& device)
{
    if (wanted != Traversal::Automatic) {
        return wanted;
    }
    return device.type == device::DeviceType::Cpu ? Traversal::Wide : Traversal::Scalar;
}

std::string traversalName(Traversal traversal)
{
    switch (traversal) {
    case Traversal::Wide:
        return "wide";
    case Traversal::Scalar:
        return "scalar";
    default:
        return "auto";
    }
}

std::size_t packetSize(Traversal family) { return family == Traversal::Scalar ? 1 : WEDGE_WIDE_PACKET_SIZE; }

Hierarchy::Hierarchy(bvh::Bvh built, Traversal family)
    : moves(false)
    , traversal(family)
    , bvh(std::move(built))
{
    assert(family != Traversal::Automatic);
    if (family == Traversal::Scalar) {
        narrow = bvh::narrow(bvh);
    }
}

Hierarchy::Hierarchy(bvh::MovingBvh built, Traversal family)
    : moves(true)
    , traversal(family)
    , moving(std::move(built))
{
    assert(family != Traversal::Automatic);
    bvh.statistics = moving.statistics;
    if (family == Traversal::Scalar) {
        movingNarrow = bvh::narrow(moving);
    }
}

std::span<const std::byte> Hierarchy::blocks() const
{
    return moves ? std::as_bytes(std::span(moving.blocks)) : std::as_bytes(std::span(bvh.blocks));
}

std::span<const std::byte> Hierarchy::nodes() const
{
    if (moves) {
        return traversal == Traversal::Scalar ? std::as_bytes(std::span(movingNarrow))
                                              : std::as_bytes(std::span(moving.nodes));
    }
    return traversal == Traversal::Scalar ? std::as_bytes(std::span(narrow)) : std::as_bytes(std::span(bvh.nodes));
}

Hierarchy buildHierarchy(const scene::Scene& scene, bvh::Mode mode, Traversal family)
{
    const scene::Geometry& g = scene.geometry;
    const bvh::Mesh mesh { g.positions, g.indices };
    return scene::geometryMoves(scene)
        ? Hierarchy(bvh::buildMoving(mesh, g.positionsAtClose, bvh::config(mode)), family)
        : Hierarchy(bvh::build(mesh, bvh::config(mode)), family);
}

} // namespace wedge::render
