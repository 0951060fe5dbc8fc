#pragma once

#include <cstdint>
#include <limits>
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

/// How tenants share memory.
enum class Sharing {
    Parts, ///< a slab holds several at once, each a part of it
    Turns, ///< a slab holds one after the other, and each may use all of it: for drivers that fail with parts
    Apart, ///< each has a slab: a simulator of a device sees who works past an end
};

struct SlabRules {
    std::uint64_t mostBytes = std::numeric_limits<std::uint64_t>::max(); ///< of a slab that holds several at once
    Sharing sharing = Sharing::Parts;
};

/// Places tenants so that no two that meet overlap: in several orders, each in the smallest gap that holds it; the
/// order that takes least memory counts. Every offset and every slab's size is a multiple of `alignment`. One slab, or
/// as many as it takes where one would be larger than the rules allow; what is larger by itself gets one of its own.
Placement place(const std::vector<Tenant>& tenants, std::uint64_t alignment, const SlabRules& rules = {});

} // namespace wedge::graph
