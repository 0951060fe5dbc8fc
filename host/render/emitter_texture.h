#pragma once

#include "host/render/texel_means.h"
#include "host/scene/scene.h"
#include "kernels/shared/emitter.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::render {

/// A triangle that emits, or it and the next one: pair is WEDGE_PAIR_*.
struct EmitterFaces {
    std::size_t triangle;
    std::uint32_t pair;
};

/// How the square that an entry of emitters is spread over (shared::squareToPair(), squareToTriangle()) lies in space,
/// or in a texture: one affine map for each of the two parts that a diagonal divides it into.
template <typename Point>
struct SquareMap {
    std::array<Point, 2> origin, alongX, alongY;

    Point at(std::size_t part, double x, double y) const { return origin[part] + x * alongX[part] + y * alongY[part]; }
};

/// corners: of the triangle, and of the next one where they are a pair.
template <typename Point>
SquareMap<Point> squareMap(std::uint32_t pair, const std::array<std::array<Point, 3>, 2>& corners)
{
    const auto side = [&](std::size_t triangle, std::size_t k) { return corners[triangle][k] - corners[triangle][0]; };
    if (pair == WEDGE_PAIR_FIRST) { // weights (x - y, y); beyond y = x (x, y - x)
        return { { corners[0][0], corners[1][0] }, { side(0, 1), side(1, 1) - side(1, 2) },
            { side(0, 2) - side(0, 1), side(1, 2) } };
    }
    if (pair == WEDGE_PAIR_SECOND) { // (x, y); beyond x + y = 1 (x + y - 1, 1 - x)
        return { { corners[0][0], corners[1][0] - side(1, 1) + side(1, 2) }, { side(0, 1), side(1, 1) - side(1, 2) },
            { side(0, 2), side(1, 1) } };
    }
    // (x - y / 2, y / 2); beyond y = x (x / 2, y - x / 2)
    return { { corners[0][0], corners[0][0] }, { side(0, 1), 0.5 * (side(0, 1) - side(0, 2)) },
        { 0.5 * (side(0, 2) - side(0, 1)), side(0, 2) } };
}

/// The part of the square that a place is in.
inline std::size_t partOfSquare(std::uint32_t pair, double x, double y)
{
    return (pair == WEDGE_PAIR_SECOND ? x + y > 1.0 : y > x) ? 1 : 0;
}

/// Integrals over a part of the square, of what is emitted times 1, x, y, x^2, x y and y^2.
using SquareMoments = std::array<double, 6>;

/// What faces emit over their square, W/(sr m^2): luminance times opacity times what of their area a place stands for.
struct EmittedOverSquare {
    std::uint32_t columns = 1, rows = 1;
    std::vector<float> cells; ///< means over cells, row by row, 0 where nothing emits; empty: alike everywhere
    double mean = 0, meanSquare = 0;
    std::array<SquareMoments, 2> moments {};
};

/// What textures say of faces, for points on them that are chosen by brightness. A table has about as many cells as
/// its faces cover texels; those of all faces together have at most about mostCells.
class EmitterTextures {
public:
    static constexpr std::size_t mostCells = std::size_t { 1 } << 22;

    /// Whether a triangle's material has a texture of emission or opacity.
    static bool has(const scene::Scene& scene, std::size_t triangle);

    /// Of faces that have().
    EmitterTextures(const scene::Scene& scene, std::span<const EmitterFaces> faces);

    /// Which of those that take() returns is that of faces i: faces that show the same of a texture share one.
    std::size_t numberOf(std::size_t i) const { return numbers_[i]; }
    std::vector<EmittedOverSquare> take() { return std::move(all_); }

private:
    std::vector<std::size_t> numbers_;
    std::vector<EmittedOverSquare> all_;
};

/// As kernels read it: see WEDGE_PICK_TABLE. Of one that has cells.
std::vector<float> emitterTable(const EmittedOverSquare& emitted);

} // namespace wedge::render
