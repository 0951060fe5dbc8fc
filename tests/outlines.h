#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "host/scene/orientation.h"

/// Outlines of faces that do not cross themselves.
namespace outlines {

using Outline = std::vector<glm::vec2>;
using Random = std::mt19937;

inline double uniform(Random& random, double least, double most)
{
    return std::uniform_real_distribution<double>(least, most)(random);
}

inline std::size_t number(Random& random, std::size_t least, std::size_t most)
{
    return std::uniform_int_distribution<std::size_t>(least, most)(random);
}

inline glm::vec2 at(double x, double y) { return { static_cast<float>(x), static_cast<float>(y) }; }

inline Outline star(Random& random, std::size_t corners)
{
    std::vector<double> angles(corners);
    for (std::size_t i = 0; i < corners; ++i)
        angles[i] = 2.0 * std::numbers::pi * (static_cast<double>(i) + uniform(random, 0.05, 0.95))
            / static_cast<double>(corners);
    Outline outline;
    for (const double angle : angles) {
        const double radius = uniform(random, 0.1, 1.0);
        outline.push_back(at(radius * std::cos(angle), radius * std::sin(angle)));
    }
    return outline;
}

inline bool cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d)
{
    using wedge::scene::orientation;
    return orientation(a, b, c) * orientation(a, b, d) <= 0 && orientation(c, d, a) * orientation(c, d, b) <= 0;
}

/// Random points, joined and then untangled: edges that cross are exchanged until none do.
inline Outline untangled(Random& random, std::size_t corners)
{
    Outline outline;
    for (std::size_t i = 0; i < corners; ++i)
        outline.push_back(at(uniform(random, 0.0, 1.0), uniform(random, 0.0, 1.0)));
    for (bool again = true; again;) {
        again = false;
        for (std::size_t i = 0; i < corners; ++i) {
            for (std::size_t k = i + 2; k < corners - (i == 0 ? 1 : 0); ++k) {
                if (cross(outline[i], outline[i + 1], outline[k], outline[(k + 1) % corners])) {
                    std::reverse(outline.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                        outline.begin() + static_cast<std::ptrdiff_t>(k) + 1);
                    again = true;
                }
            }
        }
    }
    return outline;
}

inline Outline comb(std::size_t teeth)
{
    Outline outline;
    for (std::size_t i = 0; i < teeth; ++i) {
        const double x = static_cast<double>(i);
        outline.insert(outline.end(), { at(x, 0.0), at(x + 0.25, 10.0) });
        outline.insert(outline.end(), { at(x + 0.5, 10.0), at(x + 0.75, 0.0) });
    }
    outline.push_back(at(static_cast<double>(teeth), -1.0));
    outline.push_back(at(0.0, -1.0));
    std::reverse(outline.begin(), outline.end());
    return outline;
}

inline Outline spiral(std::size_t corners)
{
    Outline outline;
    for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t i = 0; i < corners / 2; ++i) {
            const std::size_t step = side == 0 ? i : corners / 2 - 1 - i;
            const double angle = 0.3 * static_cast<double>(step);
            const double radius = 1.0 + angle + (side == 0 ? 0.0 : -0.5);
            outline.push_back(at(radius * std::cos(angle), radius * std::sin(angle)));
        }
    }
    return outline;
}

/// Integer corners on the sides too, so that many lie on one line.
inline Outline staircase(std::size_t steps)
{
    Outline outline;
    for (std::size_t i = 0; i < steps; ++i) {
        const double x = static_cast<double>(i);
        outline.insert(outline.end(), { at(x, x), at(x + 0.5, x), at(x + 1.0, x) });
    }
    const double top = static_cast<double>(steps);
    for (std::size_t i = 0; i <= steps; ++i)
        outline.push_back(at(top - static_cast<double>(i), top));
    std::reverse(outline.begin(), outline.end());
    return outline;
}

/// A square with square holes along its diagonal; a bridge walked twice leads from each to the next.
inline Outline withHoles(std::size_t holes)
{
    const double side = 2.0 * static_cast<double>(holes) + 1.0;
    Outline outline = { at(0, 0), at(side, 0), at(side, side), at(0, side), at(0, 0) };
    Outline back;
    for (std::size_t i = 0; i < holes; ++i) {
        const double lo = 2.0 * static_cast<double>(i) + 1.0, hi = lo + 1.0;
        outline.insert(outline.end(), { at(lo, lo), at(lo, hi), at(hi, hi) });
        back.insert(back.end(), { at(lo, lo), at(hi, lo) });
        if (i + 1 < holes)
            back.push_back(at(hi, hi));
    }
    outline.insert(outline.end(), back.rbegin(), back.rend());
    return outline;
}

/// The outer boundary of cells that grow at random on a grid, every grid point a corner. Where cells touch in a point
/// the boundary passes it twice, and goes on with the same cell or with the other.
inline Outline cells(Random& random, int count, bool sameCell)
{
    using Cell = std::pair<int, int>;
    const std::array<Cell, 4> ways = { Cell { 1, 0 }, Cell { 0, 1 }, Cell { -1, 0 }, Cell { 0, -1 } };
    std::set<Cell> grown = { { 0, 0 } };
    while (grown.size() < static_cast<std::size_t>(count)) {
        const Cell& from = *std::next(grown.begin(), static_cast<std::ptrdiff_t>(number(random, 0, grown.size() - 1)));
        const Cell& way = ways[number(random, 0, 3)];
        grown.emplace(from.first + way.first, from.second + way.second);
    }
    // Whether a step from a point has a cell on its left and none on its right.
    const auto isEdge = [&](const Cell& at, std::size_t way) {
        const auto [x, y] = at;
        const std::array<Cell, 4> left = { Cell { x, y }, Cell { x - 1, y }, Cell { x - 1, y - 1 }, Cell { x, y - 1 } };
        return grown.contains(left[way]) && !grown.contains(left[(way + 3) % 4]);
    };
    Outline outline;
    Cell point = *grown.begin(); // the leftmost column's lowest: the step to the right is one of the outer boundary
    std::size_t way = 0;
    const Cell first = point;
    do {
        outline.push_back(at(point.first, point.second));
        point = { point.first + ways[way].first, point.second + ways[way].second };
        const std::size_t turn = sameCell ? 1 : 3;
        way = (way + turn) % 4;
        while (!isEdge(point, way))
            way = (way + 4 - turn) % 4;
    } while (point != first || way != 0);
    return outline;
}

/// Corners repeated, and others added in the middle of sides.
inline Outline withExtras(Random& random, const Outline& outline, bool middles)
{
    Outline out;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        out.push_back(outline[i]);
        if (number(random, 0, 4) == 0)
            out.push_back(outline[i]);
        if (middles && number(random, 0, 4) == 0)
            out.push_back(0.5f * (outline[i] + outline[(i + 1) % outline.size()]));
    }
    return out;
}

} // namespace outlines
