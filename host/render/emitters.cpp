#include "host/render/emitters.h"

#include "host/render/luminance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wedge::render {
namespace {

const scene::Material& materialOf(const scene::Scene& scene, std::size_t triangle)
{
    return scene.materials[scene.geometry.materialIds[triangle]];
}

} // namespace

glm::dvec3 cornerOf(const scene::Geometry& g, std::size_t triangle, std::size_t k)
{
    const std::size_t v = g.indices[3 * triangle + k];
    return { g.positions[3 * v], g.positions[3 * v + 1], g.positions[3 * v + 2] };
}

double areaOf(const scene::Geometry& g, std::size_t triangle)
{
    const glm::dvec3 a = cornerOf(g, triangle, 0);
    return 0.5 * glm::length(glm::cross(cornerOf(g, triangle, 1) - a, cornerOf(g, triangle, 2) - a));
}

double powerOf(double area, glm::vec3 radiance)
{
    const double power = area * luminanceOf(radiance);
    return std::isfinite(power) && power > 1e-30 ? power : 0.0;
}

double plainPower(const scene::Scene& scene, std::size_t triangle)
{
    // Most do not emit, and what they measure is far away in memory.
    return mayEmit(scene, triangle) ? powerOf(areaOf(scene.geometry, triangle),
               materialOf(scene, triangle).emission * materialOf(scene, triangle).opacity)
                                    : 0.0;
}

bool mayEmit(const scene::Scene& scene, std::size_t triangle)
{
    return luminanceOf(materialOf(scene, triangle).emission) > 0 && materialOf(scene, triangle).opacity > 0;
}

bool movesAt(const scene::Geometry& g, std::size_t vertex)
{
    for (std::size_t axis = 3 * vertex; !g.positionsAtClose.empty() && axis < 3 * vertex + 3; ++axis) {
        if (g.positions[axis] != g.positionsAtClose[axis]) {
            return true;
        }
    }
    return false;
}

bool triangleMoves(const scene::Geometry& g, std::size_t triangle)
{
    return movesAt(g, g.indices[3 * triangle]) || movesAt(g, g.indices[3 * triangle + 1])
        || movesAt(g, g.indices[3 * triangle + 2]);
}

std::uint32_t pairAt(const scene::Geometry& g, std::size_t triangle)
{
    const std::size_t next = triangle + 1;
    if (next >= g.objectIds.size() || g.objectIds[triangle] != g.objectIds[next]) {
        return WEDGE_PAIR_NONE;
    }
    // By where they are: readers may split corners.
    const auto same = [&](std::size_t k, std::size_t l) { return cornerOf(g, triangle, k) == cornerOf(g, next, l); };
    if (same(0, 0) && same(2, 1)) {
        return WEDGE_PAIR_FIRST;
    }
    return same(1, 0) && same(2, 2) ? WEDGE_PAIR_SECOND : WEDGE_PAIR_NONE;
}

bool isFoundAlone(const scene::Scene& scene, std::size_t triangle)
{
    const scene::Geometry& g = scene.geometry;
    if (!mayEmit(scene, triangle) || plainPower(scene, triangle) > 0) {
        return false;
    }
    const std::uint32_t* corner = &g.indices[3 * triangle];
    return areaOf(g, triangle) > 0 || std::any_of(corner, corner + 3, [&](std::uint32_t v) { return movesAt(g, v); });
}

} // namespace wedge::render
