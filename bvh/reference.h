#pragma once

#include "bvh/box.h"
#include "bvh/bvh.h"

#include <cassert>
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

    Reference() = default; // leaves everything as it is
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

/// Two arrays of room references; the builder moves references from one to the other at each split.
struct ReferenceArrays {
    Array<Reference> current, other;
    std::uint32_t count = 0; ///< in current, in ascending order of their index
    Bounds bounds;
};

/// A reference for each triangle whose vertices are finite and within maxCoordinate. room, at least the triangles:
/// how many the arrays can hold.
ReferenceArrays makeReferences(const Mesh& mesh, std::size_t room);

/// The vertex of a triangle; -0 becomes 0, since which of the two a minimum returns would depend on the order.
inline Float4 vertexOf(const Mesh& mesh, std::uint32_t triangle, std::size_t corner)
{
    const std::size_t vertex = mesh.indices[3 * std::size_t { triangle } + corner];
    assert(vertex < mesh.positions.size() / 3);
    const float* p = &mesh.positions[3 * vertex];
    return Float4 { p[0], p[1], p[2], 0 } + Float4 {};
}

/// The box of a triangle. Where a vertex is not finite or beyond maxCoordinate, valid becomes false.
inline Box boxOf(const Mesh& mesh, std::uint32_t triangle, bool& valid)
{
    constexpr Float4 limit = { maxCoordinate, maxCoordinate, maxCoordinate, maxCoordinate };
    const Float4 a = vertexOf(mesh, triangle, 0), b = vertexOf(mesh, triangle, 1), c = vertexOf(mesh, triangle, 2);
    const auto within = [&](Float4 v) { return (v <= limit) & (-v <= limit); };
    const Int4 all = within(a) & within(b) & within(c);
    valid = (all[0] & all[1] & all[2]) != 0;
    return { minOf(minOf(a, b), c), maxOf(maxOf(a, b), c) };
}

} // namespace wedge::bvh::detail
