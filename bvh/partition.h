#pragma once

#include "bvh/chunks.h"
#include "bvh/reference.h"

#include <span>

namespace wedge::bvh::detail {

/// The boxes of the doubled centres left and right of a split.
struct CentreBoxes {
    Box left, right;
};

/// Copies the references of from for which isLeft holds to left and the others to right, which do not overlap from, and
/// finds the boxes of their centres. Keeps their order, which makes the result independent of threads and leaves
/// triangles in ascending order in every leaf.
template <typename IsLeft>
CentreBoxes divide(std::span<const Reference> from, Reference* left, Reference* right, const IsLeft& isLeft)
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
        Box centres[2] = { Box::empty(), Box::empty() };
    };
    const std::unique_ptr<Sides[]> many(chunks.count() > 1 ? new Sides[chunks.count()] : nullptr);
    Sides one;
    Sides* sides = many ? many.get() : &one;
    chunks.forEach([&](std::size_t chunk) {
        Sides found;
        Reference* out[2] = { right + (chunks.begin(chunk) - firstLeft[chunk]), left + firstLeft[chunk] };
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++) {
            const bool side = isLeft(from[i]);
            *out[side]++ = from[i];
            found.centres[side].grow(from[i].centre());
        }
        sides[chunk] = found;
    });
    for (std::size_t chunk = 1; chunk < chunks.count(); chunk++)
        for (int side = 0; side < 2; side++)
            sides[0].centres[side].grow(sides[chunk].centres[side]);
    return { sides[0].centres[1], sides[0].centres[0] };
}

} // namespace wedge::bvh::detail
