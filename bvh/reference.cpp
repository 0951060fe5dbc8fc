#include "bvh/reference.h"

#include "bvh/partition.h"

#include <cassert>
#include <cmath>

namespace wedge::bvh::detail {
namespace {

/// lo[0] is NaN for triangles to skip.
Reference makeReference(const Mesh& mesh, std::uint32_t triangle)
{
    bool valid;
    Reference reference(boxOf(mesh, triangle, valid), triangle);
    if (!valid)
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
    arrays.current.resize(room);
    arrays.other.resize(room);
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
        divide({ arrays.current.data(), count }, arrays.other.data(), arrays.other.data() + arrays.count, isValid);
        std::swap(arrays.current, arrays.other);
    }
    return arrays;
}

} // namespace wedge::bvh::detail
