#include "bvh/reference.h"

#include "bvh/partition.h"

#include <cassert>
#include <cmath>

namespace wedge::bvh::detail {
namespace {

/// lo[0] is NaN for triangles to skip.
Reference makeReference(const Mesh& mesh, std::uint32_t triangle)
{
    constexpr Float4 limit = { maxCoordinate, maxCoordinate, maxCoordinate, maxCoordinate };
    Box box;
    Int4 valid = { -1, -1, -1, -1 };
    for (std::size_t corner = 0; corner < 3; corner++) {
        assert(mesh.indices[3 * std::size_t { triangle } + corner] < mesh.positions.size() / 3);
        const Float4 vertex = vertexOf(mesh, triangle, corner);
        valid &= (vertex <= limit) & (-vertex <= limit);
        if (corner == 0)
            box = { vertex, vertex };
        else
            box.grow(vertex);
    }
    Reference reference(box, triangle);
    if (!(valid[0] & valid[1] & valid[2]))
        reference.lo[0] = NAN;
    return reference;
}

bool isValid(const Reference& reference) { return !std::isnan(reference.lo[0]); }

} // namespace

ReferenceArrays makeReferences(const Mesh& mesh, std::size_t room)
{
    const std::size_t count = mesh.indices.size() / 3;
    assert(room >= count);
    ReferenceArrays arrays;
    arrays.current.reset(new Reference[room]);
    arrays.other.reset(new Reference[room]);
    const Chunks chunks(count);
    struct Part {
        Bounds bounds;
        std::uint32_t valid = 0;
    };
    const auto parts = std::make_unique<Part[]>(chunks.count());
    chunks.forEach([&](std::size_t chunk) {
        Part part;
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++) {
            const Reference reference = makeReference(mesh, static_cast<std::uint32_t>(i));
            arrays.current[i] = reference;
            if (isValid(reference)) {
                part.bounds.add(reference);
                part.valid++;
            }
        }
        parts[chunk] = part;
    });
    for (std::size_t chunk = 0; chunk < chunks.count(); chunk++) {
        arrays.bounds.merge(parts[chunk].bounds);
        arrays.count += parts[chunk].valid;
    }
    if (arrays.count < count) {
        divide({ arrays.current.get(), count }, arrays.other.get(), arrays.other.get() + arrays.count, isValid);
        std::swap(arrays.current, arrays.other);
    }
    return arrays;
}

} // namespace wedge::bvh::detail
