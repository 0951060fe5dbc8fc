#include "host/render/hierarchy.h"

#include "bvh/narrow_tree.h"
#include "host/render/cutouts.h"

#include <cassert>
#include <cstring>

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

void Hierarchy::append(std::span<const std::uint32_t> cutouts)
{
    if (cutouts.empty()) {
        return;
    }
    hasCutouts = true;
    const auto appendTo = [&](auto& blocks) {
        const std::size_t first = blocks.size(), size = sizeof(blocks[0]);
        blocks.resize(first + (cutouts.size_bytes() + size - 1) / size);
        std::memcpy(static_cast<void*>(&blocks[first]), cutouts.data(), cutouts.size_bytes());
        return static_cast<std::uint32_t>(first);
    };
    const std::uint32_t first = moves ? appendTo(moving.blocks) : appendTo(bvh.blocks);
    const auto tellRoot = [&](auto& nodes) {
        if (!nodes.empty()) {
            nodes[0].cutouts = first;
        }
    };
    tellRoot(bvh.nodes);
    tellRoot(narrow);
    tellRoot(moving.nodes);
    tellRoot(movingNarrow);
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
    Hierarchy out = scene::geometryMoves(scene)
        ? Hierarchy(bvh::buildMoving(mesh, g.positionsAtClose, bvh::config(mode)), family)
        : Hierarchy(bvh::build(mesh, bvh::config(mode)), family);
    out.append(cutoutTable(scene));
    return out;
}

} // namespace wedge::render
