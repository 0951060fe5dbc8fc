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
    : bvh(std::move(built))
    , traversal(family)
{
    assert(family != Traversal::Automatic);
    if (family == Traversal::Scalar) {
        narrow = bvh::narrow(bvh);
    }
}

std::span<const std::byte> Hierarchy::nodes() const
{
    return traversal == Traversal::Scalar ? std::as_bytes(std::span(narrow)) : std::as_bytes(std::span(bvh.nodes));
}

} // namespace wedge::render
