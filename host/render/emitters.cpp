#include "host/render/emitters.h"

#include "kernels/shared/bsdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace wedge::render {
namespace {

// Numbers an axis that a triangle's texture is looked up at.
constexpr int textureSamples = 8;

float luminanceOf(glm::vec3 c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

/// Of the texture's colours over a triangle, nearest texels; never quite 0, where something bright may lie between.
glm::vec3 meanColour(const scene::Scene& scene, const scene::Texture& texture, std::size_t triangle)
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
    // 2.2 in the place of the sRGB curve: these are probabilities.
    static const std::array<double, 256> linear = [] {
        std::array<double, 256> out {};
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = std::pow(static_cast<double>(i) / 255.0, 2.2);
        }
        return out;
    }();
    glm::dvec3 sum(0);
    for (int i = 0; i < textureSamples * textureSamples; ++i) {
        const shared::Vec2 w =
            shared::squareToTriangle(shared::vec2((static_cast<float>(i % textureSamples) + 0.5f) / textureSamples,
                (static_cast<float>(i / textureSamples) + 0.5f) / textureSamples));
        const glm::dvec2 at = a + ab * static_cast<double>(w.x) + ac * static_cast<double>(w.y);
        const std::uint32_t rgba =
            texture.rgba[static_cast<std::size_t>(texel(at.y, texture.height)) * static_cast<std::size_t>(texture.width)
                + static_cast<std::size_t>(texel(at.x, texture.width))];
        for (int channel = 0; channel < 3; ++channel) {
            sum[channel] += linear[(rgba >> (8 * channel)) & 255u];
        }
    }
    return glm::max(glm::vec3(sum / static_cast<double>(textureSamples * textureSamples)), glm::vec3(1e-3f));
}

glm::dvec3 cornerOf(const scene::Geometry& g, std::size_t triangle, std::size_t k)
{
    const std::size_t v = g.indices[3 * triangle + k];
    return { g.positions[3 * v], g.positions[3 * v + 1], g.positions[3 * v + 2] };
}

/// When the shutter opens.
double areaOf(const scene::Geometry& g, std::size_t triangle)
{
    const glm::dvec3 a = cornerOf(g, triangle, 0);
    return 0.5 * glm::length(glm::cross(cornerOf(g, triangle, 1) - a, cornerOf(g, triangle, 2) - a));
}

/// 0 of what has no area, or more than numbers can hold.
double powerOf(double area, float luminance)
{
    const double power = area * luminance;
    return std::isfinite(power) && power > 1e-30 ? power : 0.0;
}

/// A triangle's corners in an order that does not depend on where it begins or which way it winds.
using Corners = std::array<float, 9>;
Corners cornersOf(const scene::Geometry& g, std::size_t triangle)
{
    std::array<std::array<float, 3>, 3> corners {};
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3 c(cornerOf(g, triangle, k));
        corners[k] = { c.x, c.y, c.z };
    }
    std::ranges::sort(corners);
    Corners out {};
    for (std::size_t i = 0; i < 9; ++i) {
        out[i] = corners[i / 3][i % 3];
    }
    return out;
}

/// What is added up of an object's triangles.
struct Moments {
    double power = 0, squares = 0; ///< squares: of the distance from the origin of coordinates, times power
    glm::dvec3 centre { 0 }; ///< times power

    double extent() const
    {
        const glm::dvec3 middle = centre / power;
        return std::sqrt(std::max(squares / power - glm::dot(middle, middle), 0.0));
    }
};

/// One triangle before it is part of the list.
struct Emitting {
    std::size_t triangle;
    double power;
};

/// WEDGE_PAIR_* of two that are a quadrilateral's and emit about as much.
std::uint32_t pairOf(const scene::Geometry& g, const Emitting& one, const Emitting& other)
{
    if (other.triangle != one.triangle + 1 || g.objectIds[one.triangle] != g.objectIds[other.triangle]
        || std::abs(one.power - other.power) > 0.1 * std::max(one.power, other.power)) {
        return WEDGE_PAIR_NONE;
    }
    // By where they are: readers may split corners.
    const auto corner = [&](const Emitting& e, std::size_t k) { return cornerOf(g, e.triangle, k); };
    if (corner(one, 0) == corner(other, 0) && corner(one, 2) == corner(other, 1)) {
        return WEDGE_PAIR_FIRST;
    }
    const bool second = corner(one, 1) == corner(other, 0) && corner(one, 2) == corner(other, 2);
    return second ? WEDGE_PAIR_SECOND : WEDGE_PAIR_NONE;
}

/// twins: triangles that lie in the place of another one, and that one.
std::vector<Emitting> emitting(const scene::Scene& scene, std::map<std::uint32_t, Moments>& objects,
    std::vector<std::pair<std::size_t, std::size_t>>& twins)
{
    const scene::Geometry& g = scene.geometry;
    std::vector<Emitting> out;
    std::map<Corners, std::size_t> known;
    for (std::size_t t = 0; t < g.materialIds.size(); ++t) {
        const scene::Material& m = scene.materials[g.materialIds[t]];
        if (!(luminanceOf(m.emission) > 0)) {
            continue;
        }
        const glm::dvec3 a = cornerOf(g, t, 0), b = cornerOf(g, t, 1), c = cornerOf(g, t, 2),
                         middle = (a + b + c) / 3.0;
        const glm::vec3 colour = m.emissionTexture < 0
            ? m.emission
            : m.emission * meanColour(scene, scene.textures[static_cast<std::size_t>(m.emissionTexture)], t);
        const double power = powerOf(areaOf(g, t), luminanceOf(colour));
        if (!(power > 0)) {
            continue;
        }
        // Faces that exporters write twice, once each way round, are one: rays meet one of them.
        if (const auto [first, isFirst] = known.try_emplace(cornersOf(g, t), t); !isFirst) {
            twins.emplace_back(t, first->second);
            continue;
        }
        out.push_back({ t, power });
        Moments& object = objects[g.objectIds[t]];
        object.power += power;
        object.centre += power * middle;
        // The mean square over a triangle: that of its middle and a twelfth of those of the corners from there.
        const auto squared = [&](const glm::dvec3& p) { return glm::dot(p - middle, p - middle); };
        object.squares += power * (glm::dot(middle, middle) + (squared(a) + squared(b) + squared(c)) / 12.0);
    }
    return out;
}

} // namespace

bool hasEmitters(const scene::Scene& scene)
{
    std::vector<bool> emits;
    for (const scene::Material& m : scene.materials) {
        emits.push_back(luminanceOf(m.emission) > 0);
    }
    for (std::size_t t = 0; t < scene.geometry.materialIds.size(); ++t) {
        const std::uint32_t id = scene.geometry.materialIds[t];
        if (emits[id] && powerOf(areaOf(scene.geometry, t), luminanceOf(scene.materials[id].emission)) > 0) {
            return true;
        }
    }
    return false;
}

EmitterList emitterList(const scene::Scene& scene)
{
    EmitterList out;
    std::map<std::uint32_t, Moments> objects;
    std::vector<std::pair<std::size_t, std::size_t>> twins;
    const std::vector<Emitting> triangles = emitting(scene, objects, twins);
    if (triangles.empty()) {
        return out;
    }
    double total = 0;
    for (const Emitting& e : triangles) {
        total += e.power;
    }
    std::vector<float>& picks = out.picks;
    out.power = 2.0 * total;
    picks.assign(scene.geometry.materialIds.size(), 0.0f);
    double sum = 0;
    float before = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Emitting& e = triangles[i];
        const std::uint32_t pair =
            i + 1 < triangles.size() ? pairOf(scene.geometry, e, triangles[i + 1]) : WEDGE_PAIR_NONE;
        const bool paired = pair != WEDGE_PAIR_NONE;
        sum += e.power + (paired ? triangles[i + 1].power : 0.0);
        i += paired ? 1 : 0;
        const float upTo = i + 1 == triangles.size() ? 1.0f : std::min(static_cast<float>(sum / total), 1.0f);
        const std::uint32_t object = scene.geometry.objectIds[e.triangle];
        out.list.push_back(
            { upTo, static_cast<std::uint32_t>(e.triangle), static_cast<float>(objects[object].extent()), pair });
        // The probability as it is after rounding: what is never chosen is found by reflected directions alone.
        picks[e.triangle] = paired ? 0.5f * (upTo - before) : upTo - before;
        if (paired) {
            picks[e.triangle + 1] = picks[e.triangle];
        }
        before = upTo;
    }
    for (const auto& [twin, first] : twins) {
        picks[twin] = picks[first];
    }
    return out;
}

} // namespace wedge::render
