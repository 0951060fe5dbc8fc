#include "host/render/emitters.h"

#include "host/render/cutouts.h"
#include "kernels/shared/bsdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace wedge::render {
namespace {

// Numbers an axis that a triangle's texture is looked up at.
constexpr int textureSamples = 8;

float luminanceOf(glm::vec3 c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

const scene::Material& materialOf(const scene::Scene& scene, std::size_t triangle)
{
    return scene.materials[scene.geometry.materialIds[triangle]];
}

/// Calls add(i) for texels i of a triangle's texture, the nearest to even points of it.
template <typename Add>
void forTexels(const scene::Scene& scene, const scene::Texture& texture, std::size_t triangle, const Add& add)
{
    const scene::Geometry& g = scene.geometry;
    const auto coordinates = [&](int corner) {
        const std::size_t v = g.indices[3 * triangle + static_cast<std::size_t>(corner)];
        return glm::dvec2(g.texcoords[2 * v], g.texcoords[2 * v + 1]);
    };
    const glm::dvec2 a = coordinates(0), ab = coordinates(1) - a, ac = coordinates(2) - a;
    const auto texel = [](double x, int size) {
        const double within = x - std::floor(x);
        return std::isfinite(within) ? std::min(static_cast<int>(within * size), size - 1) : 0;
    };
    for (int i = 0; i < textureSamples * textureSamples; ++i) {
        const int row = i / textureSamples, column = i % textureSamples;
        const shared::Vec2 w = shared::squareToTriangle(shared::vec2(
            (static_cast<float>(column) + 0.5f) / textureSamples, (static_cast<float>(row) + 0.5f) / textureSamples));
        const glm::dvec2 at = a + ab * static_cast<double>(w.x) + ac * static_cast<double>(w.y);
        add(static_cast<std::size_t>(texel(at.y, texture.height)) * static_cast<std::size_t>(texture.width)
            + static_cast<std::size_t>(texel(at.x, texture.width)));
    }
}

constexpr double textureShare = 1.0 / (textureSamples * textureSamples);

/// Of the texture's colours over a triangle, nearest texels; never quite 0, where something bright may lie between.
glm::vec3 meanColour(const scene::Scene& scene, const scene::Texture& texture, std::size_t triangle)
{
    // 2.2 in the place of the sRGB curve: these are probabilities.
    static const std::array<double, 256> linear = [] {
        std::array<double, 256> out {};
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = std::pow(static_cast<double>(i) / 255.0, 2.2);
        }
        return out;
    }();
    glm::dvec3 sum(0);
    forTexels(scene, texture, triangle, [&](std::size_t texel) {
        for (int channel = 0; channel < 3; ++channel) {
            sum[channel] += linear[(texture.rgba[texel] >> (8 * channel)) & 255u];
        }
    });
    return glm::max(glm::vec3(sum * textureShare), glm::vec3(1e-3f));
}

/// Of the texture's opacities likewise.
float meanOpacity(const scene::Scene& scene, const scene::Texture& texture, std::size_t triangle)
{
    double sum = 0;
    forTexels(scene, texture, triangle, [&](std::size_t texel) { sum += opacityOf(texture, texel) / 255.0; });
    return std::max(static_cast<float>(sum * textureShare), 1e-3f);
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

double texturedPower(const scene::Scene& scene, std::size_t triangle)
{
    const scene::Material& m = materialOf(scene, triangle);
    const glm::vec3 radiance = m.emissionTexture < 0
        ? m.emission
        : m.emission * meanColour(scene, scene.textures[static_cast<std::size_t>(m.emissionTexture)], triangle);
    const float opacity = m.opacityTexture < 0
        ? 1.0f
        : meanOpacity(scene, scene.textures[static_cast<std::size_t>(m.opacityTexture)], triangle);
    return powerOf(areaOf(scene.geometry, triangle), radiance * (m.opacity * opacity));
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

bool hasEmitters(const scene::Scene& scene)
{
    for (std::size_t t = 0; t < scene.geometry.materialIds.size(); ++t) {
        if (plainPower(scene, t) > 0) {
            return true;
        }
    }
    return false;
}

} // namespace wedge::render
