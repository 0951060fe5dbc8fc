#pragma once

#include <cstdint>
#include <vector>

namespace wedge::graph {

/// What needs memory, and when: from one step of a sequence to another, both included.
struct Tenant {
    std::uint64_t bytes = 0;
    std::uint32_t first = 0, last = 0;

    bool meets(const Tenant& other) const { return first <= other.last && other.first <= last; }
};

/// Where a tenant lies: in which piece of memory, at which byte.
struct Place {
    std::uint32_t slab = 0;
    std::uint64_t offset = 0;
};

struct Placement {
    std::vector<Place> places; ///< of the tenants, in their order
    std::vector<std::uint64_t> slabs; ///< bytes of each piece of memory
};

/// Places tenants so that no two that meet overlap: in several orders, each in the smallest gap that holds it; the
/// order that takes least memory counts. Every
/// offset and every slab's size is a multiple of `alignment`. One slab, or as many as it takes where one would be
/// larger than mostSlabBytes; what is larger by itself gets one of its own. 0: each tenant gets one, so that a
/// simulator of a device sees who works past an end.
Placement place(const std::vector<Tenant>& tenants, std::uint64_t alignment, std::uint64_t mostSlabBytes);

} // namespace wedge::graph
