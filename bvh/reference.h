#pragma once

#include "bvh/box.h"
#include "bvh/bvh.h"

#include <cstring>
#include <memory>

namespace wedge::bvh::detail {

/// The box of a triangle, of a part of one, or of a run of several, and its index. The index lies in the fourth lane as
/// an integer and is cleared before any arithmetic: as a float it would be a denormal, which costs a hundred cycles an
/// addition.
struct alignas(32) Reference {
    float lo[3];
    std::uint32_t index;
    float hi[3];
    std::uint32_t unused;

    Reference() = default;
    Reference(const Box& box, std::uint32_t i)
    {
        std::memcpy(lo, &box.lo, sizeof box.lo);
        std::memcpy(hi, &box.hi, sizeof box.hi);
        index = i;
        unused = 0;
    }

    Box box() const { return { load(lo), load(hi) }; }
    /// Twice the centre of the box.
    Float4 centre() const { return load(lo) + load(hi); }

private:
    static Float4 load(const float* xyz)
    {
        Int4 bits;
        std::memcpy(&bits, __builtin_assume_aligned(xyz, 16), sizeof bits);
        bits &= Int4 { -1, -1, -1, 0 };
        Float4 lanes;
        std::memcpy(&lanes, &bits, sizeof lanes);
        return lanes;
    }
};

/// The box of references and the box of their doubled centres.
struct Bounds {
    Box box = Box::empty(), centres = Box::empty();

    void add(const Reference& reference)
    {
        const Box other = reference.box();
        box.grow(other);
        centres.grow(other.lo + other.hi);
    }
    void merge(const Bounds& other)
    {
        box.grow(other.box);
        centres.grow(other.centres);
    }
};

/// Arrays that are written before they are read, in parallel: nobody clears them first.
using References = std::unique_ptr<Reference[]>;

/// Two arrays of room references; the builder moves references from one to the other at each split.
struct ReferenceArrays {
    References current, other;
    std::uint32_t count = 0; ///< in current, in ascending order of their index
    Bounds bounds;
};

/// A reference for each triangle whose vertices are finite and within maxCoordinate. room, at least the triangles:
/// how many the arrays can hold.
ReferenceArrays makeReferences(const Mesh& mesh, std::size_t room);

/// The vertex of a triangle; -0 becomes 0, since which of the two a minimum returns would depend on the order.
inline Float4 vertexOf(const Mesh& mesh, std::uint32_t triangle, std::size_t corner)
{
    const float* p = &mesh.positions[3 * std::size_t { mesh.indices[3 * std::size_t { triangle } + corner] }];
    return Float4 { p[0], p[1], p[2], 0 } + Float4 {};
}

} // namespace wedge::bvh::detail
