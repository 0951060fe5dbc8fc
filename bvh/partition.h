#pragma once

#include "bvh/chunks.h"
#include "bvh/reference.h"

#include <span>

namespace wedge::bvh::detail {

/// What is left and right of a split.
struct Halves {
    std::uint32_t leftCount = 0, rightCount = 0;
    Bounds left, right;
};

/// Copies the references of from for which isLeft holds to left and the others to right, which do not overlap from, and
/// finds the bounds of both. Keeps their order, which makes the result independent of threads and leaves triangles in
/// ascending order in every leaf. leftCount is how many are left.
template <typename IsLeft>
Halves partition(
    std::span<const Reference> from, std::uint32_t leftCount, Reference* left, Reference* right, const IsLeft& isLeft)
{
    const Chunks chunks(from.size());
    std::size_t firstLeft[Chunks::most + 1];
    firstLeft[0] = 0;
    if (chunks.count() > 1) {
        chunks.forEach([&](std::size_t chunk) {
            std::size_t count = 0;
            for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++)
                count += isLeft(from[i]);
            firstLeft[chunk + 1] = count;
        });
        for (std::size_t chunk = 0; chunk < chunks.count(); chunk++)
            firstLeft[chunk + 1] += firstLeft[chunk];
    }
    struct Sides {
        Bounds bounds[2];
    };
    std::unique_ptr<Sides[]> many(chunks.count() > 1 ? new Sides[chunks.count()] : nullptr);
    Sides one;
    Sides* sides = many ? many.get() : &one;
    chunks.forEach([&](std::size_t chunk) {
        Sides found;
        Reference* out[2] = { right + (chunks.begin(chunk) - firstLeft[chunk]), left + firstLeft[chunk] };
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++) {
            const bool side = isLeft(from[i]);
            *out[side]++ = from[i];
            found.bounds[side].add(from[i]);
        }
        sides[chunk] = found;
    });
    for (std::size_t chunk = 1; chunk < chunks.count(); chunk++)
        for (int side = 0; side < 2; side++)
            sides[0].bounds[side].merge(sides[chunk].bounds[side]);
    return { leftCount, static_cast<std::uint32_t>(from.size()) - leftCount, sides[0].bounds[1], sides[0].bounds[0] };
}

} // namespace wedge::bvh::detail
