// What emits, by object, before it is a list.
#include "host/render/emitter_groups.h"

#include "host/render/device_scene.h"
#include "host/render/emitters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

namespace wedge::render {
namespace {

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

struct CornersHash {
    std::size_t operator()(const Corners& corners) const
    {
        std::size_t hash = 0;
        for (const float c : corners) {
            hash = (hash ^ std::bit_cast<std::uint32_t>(c + 0.0f)) * 0x9e3779b97f4a7c15u; // + 0: -0 is 0
            hash ^= hash >> 32;
        }
        return hash;
    }
};

/// What is added up of an object's triangles.
struct Moments {
    double power = 0, squares = 0; ///< squares: of the distance from the origin of coordinates, times power
    glm::dvec3 centre { 0 }; ///< times power
    double brightness = 0; ///< power times radiance
    bool textured = false;

    double extent() const
    {
        const glm::dvec3 middle = centre / power;
        const double all = std::sqrt(std::max(squares / power - glm::dot(middle, middle), 0.0));
        // As far as a square reaches that has all of the power at the brightness that it is emitted with: where bright
        // spots lie scattered over something large, shadows are as sharp as those of the spots.
        return textured ? std::min(all, std::sqrt(power * power / std::max(brightness, 1e-300) / 6.0)) : all;
    }
};

/// Power of an area light, W/sr of one side, as triangles' is counted, and the root of the mean squared distance of its
/// light from its middle, metres.
struct QuadMoments {
    double power, extent;
};

QuadMoments momentsOf(const scene::AreaLight& quad)
{
    // Of a Gaussian cut at c deviations: 1 - c phi(c) / (Phi(c) - 1/2), of its variance; of a uniform profile a third.
    const double c = quad.cut, half = 0.5 * std::erf(c / std::sqrt(2.0));
    const double density = std::exp(-0.5 * c * c) / std::sqrt(2.0 * std::acos(-1.0));
    const bool uniform = quad.profile == scene::LightProfile::Uniform;
    const double square = uniform ? 1.0 / 3.0 : (1.0 - c * density / half) / (c * c);
    const glm::dvec3 u(quad.halfU), v(quad.halfV);
    return { powerOf(profileArea(quad), quad.radiance) * (quad.twoSided ? 1.0 : 0.5),
        std::sqrt(square * (glm::dot(u, u) + glm::dot(v, v))) };
}

/// Bits of a 10-bit number, three apart.
std::uint32_t spreadBits(std::uint32_t x)
{
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

/// Along a Morton curve.
std::vector<EmitterGroup> sortedInSpace(std::vector<EmitterGroup> groups)
{
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const EmitterGroup& g : groups) {
        low = glm::min(low, g.at);
        high = glm::max(high, g.at);
    }
    const glm::vec3 extent = high - low;
    const float largest = std::max({ extent.x, extent.y, extent.z, std::numeric_limits<float>::min() });
    std::ranges::stable_sort(groups, {}, [&](const EmitterGroup& g) {
        const glm::uvec3 cell(glm::clamp((g.at - low) / largest * 1024.0f, 0.0f, 1023.0f));
        return spreadBits(cell.x) | (spreadBits(cell.y) << 1) | (spreadBits(cell.z) << 2);
    });
    return groups;
}

/// Triangles that emit and are not elsewhere, each place once.
std::vector<std::size_t> emitting(
    const scene::Scene& scene, std::span<const std::size_t> elsewhere, std::vector<EmitterTwin>& twins)
{
    const scene::Geometry& g = scene.geometry;
    std::vector<std::size_t> out;
    std::unordered_map<Corners, std::size_t, CornersHash> known;
    for (std::size_t t = 0; t < g.materialIds.size(); ++t) {
        if (!(plainPower(scene, t) > 0) || std::ranges::binary_search(elsewhere, t)) {
            continue;
        }
        // Faces that exporters write twice, once each way round, are one: rays meet one of them.
        if (const auto [first, isFirst] = known.try_emplace(cornersOf(g, t), t); !isFirst) {
            twins.push_back({ t, first->second });
            continue;
        }
        out.push_back(t);
    }
    return out;
}

/// WEDGE_PAIR_* of a triangle and the next one. Without textures they are to emit about as much; with one a table
/// knows.
std::uint32_t pairOf(const scene::Scene& scene, std::size_t triangle)
{
    const std::vector<std::uint32_t>& materials = scene.geometry.materialIds;
    if (EmitterTextures::has(scene, triangle) || EmitterTextures::has(scene, triangle + 1)) {
        return materials[triangle] == materials[triangle + 1] ? pairAt(scene.geometry, triangle) : WEDGE_PAIR_NONE;
    }
    const double one = plainPower(scene, triangle), other = plainPower(scene, triangle + 1);
    const bool alike = !(std::abs(one - other) > 0.1 * std::max(one, other));
    return alike ? pairAt(scene.geometry, triangle) : WEDGE_PAIR_NONE;
}

std::vector<EmitterFaces> facesOf(const scene::Scene& scene, std::span<const std::size_t> triangles)
{
    std::vector<EmitterFaces> out;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const bool next = i + 1 < triangles.size() && triangles[i + 1] == triangles[i] + 1;
        const std::uint32_t pair = next ? pairOf(scene, triangles[i]) : WEDGE_PAIR_NONE;
        out.push_back({ triangles[i], pair });
        i += pair == WEDGE_PAIR_NONE ? 0 : 1;
    }
    return out;
}

glm::dvec3 middleOf(const scene::Geometry& g, std::size_t triangle)
{
    return (cornerOf(g, triangle, 0) + cornerOf(g, triangle, 1) + cornerOf(g, triangle, 2)) / 3.0;
}

/// Adds a triangle that emits evenly.
void addTriangle(Moments& object, const scene::Scene& scene, std::size_t t, double power)
{
    const scene::Geometry& g = scene.geometry;
    const glm::dvec3 middle = middleOf(g, t);
    object.power += power;
    object.centre += power * middle;
    // The mean square over a triangle: that of its middle and a twelfth of those of the corners from there.
    double corners = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 d = cornerOf(g, t, k) - middle;
        corners += glm::dot(d, d);
    }
    object.squares += power * (glm::dot(middle, middle) + corners / 12.0);
    object.brightness += power * power / areaOf(g, t);
}

/// Adds what has a texture.
void addTextured(
    Moments& object, const scene::Geometry& g, const EmitterFaces& faces, double area, const EmittedOverSquare& emitted)
{
    std::array<std::array<glm::dvec3, 3>, 2> corners {};
    for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            corners[i][k] = cornerOf(g, faces.triangle + (faces.pair == WEDGE_PAIR_NONE ? 0 : i), k);
        }
    }
    const SquareMap<glm::dvec3> map = squareMap(faces.pair, corners);
    for (std::size_t part = 0; part < 2; ++part) {
        const SquareMoments& m = emitted.moments[part];
        const glm::dvec3 &o = map.origin[part], &x = map.alongX[part], &y = map.alongY[part];
        object.centre += area * (m[0] * o + m[1] * x + m[2] * y);
        object.squares += area
            * (m[0] * glm::dot(o, o) + 2.0 * (m[1] * glm::dot(o, x) + m[2] * glm::dot(o, y) + m[4] * glm::dot(x, y))
                + m[3] * glm::dot(x, x) + m[5] * glm::dot(y, y));
    }
    object.power += area * emitted.mean;
    object.brightness += area * emitted.meanSquare;
    object.textured = true;
}

/// Everything that numbers choose, object by object in the order of the scene, then quads.
class Groups {
public:
    Groups(const scene::Scene& scene, std::span<const EmitterFaces> faces, std::span<const std::uint32_t> quads)
        : scene_(scene)
    {
        std::vector<EmitterFaces> textured;
        std::ranges::copy_if(faces, std::back_inserter(textured),
            [&](const EmitterFaces& f) { return EmitterTextures::has(scene, f.triangle); });
        EmitterTextures textures(scene, textured);
        textures_ = textures.take();
        std::size_t next = 0;
        for (const EmitterFaces& f : faces) {
            add(f, EmitterTextures::has(scene, f.triangle) ? textures.numberOf(next++) : EmitterEntry::none);
        }
        for (auto& [id, object] : objects_) {
            object.group.power = object.moments.power;
            object.group.extent = object.moments.extent();
            object.group.at = glm::vec3(object.moments.centre / object.moments.power);
            groups_.push_back(std::move(object.group));
        }
        for (const std::uint32_t i : quads) {
            const QuadMoments quad = momentsOf(scene.areaLights[i]);
            const glm::vec3 at = scene.areaLights[i].centre;
            groups_.push_back({ quad.power, quad.extent, { { quad.power, i, WEDGE_PAIR_QUAD, at } }, at });
        }
    }
    std::vector<EmitterGroup> takeGroups() { return std::move(groups_); }
    std::vector<EmittedOverSquare> takeTextures() { return std::move(textures_); }

private:
    struct Object {
        Moments moments;
        EmitterGroup group;
    };

    void add(const EmitterFaces& f, std::size_t texture)
    {
        const scene::Geometry& g = scene_.geometry;
        const bool paired = f.pair != WEDGE_PAIR_NONE;
        double power = plainPower(scene_, f.triangle) + (paired ? plainPower(scene_, f.triangle + 1) : 0.0);
        const double area = areaOf(g, f.triangle) + (paired ? areaOf(g, f.triangle + 1) : 0.0);
        if (texture != EmitterEntry::none) {
            power = powerOf(area, glm::vec3(static_cast<float>(textures_[texture].mean)));
        }
        if (!(power > 0)) {
            return; // its texture is black here
        }
        Object& object = objects_[g.objectIds[f.triangle]];
        glm::dvec3 middle = middleOf(g, f.triangle);
        if (paired) {
            middle = 0.5 * (middle + middleOf(g, f.triangle + 1));
        }
        object.group.entries.push_back({ power, f.triangle, f.pair, middle, texture });
        if (texture != EmitterEntry::none && !textures_[texture].cells.empty()) {
            addTextured(object.moments, g, f, area, textures_[texture]);
            return;
        }
        const double share = texture == EmitterEntry::none ? 1.0 : power / area;
        for (std::size_t t = f.triangle; t < f.triangle + (paired ? 2 : 1); ++t) {
            addTriangle(object.moments, scene_, t,
                texture == EmitterEntry::none ? plainPower(scene_, t) : share * areaOf(g, t));
        }
    }

    const scene::Scene& scene_;
    std::vector<EmittedOverSquare> textures_;
    std::map<std::uint32_t, Object> objects_;
    std::vector<EmitterGroup> groups_;
};

} // namespace

EmitterGroups emitterGroups(
    const scene::Scene& scene, std::span<const std::size_t> elsewhere, std::span<const std::uint32_t> quads)
{
    EmitterGroups out;
    Groups groups(scene, facesOf(scene, emitting(scene, elsewhere, out.twins)), quads);
    out.groups = sortedInSpace(groups.takeGroups());
    out.textures = groups.takeTextures();
    for (const EmitterGroup& g : out.groups) {
        out.power += g.power;
    }
    return out;
}

} // namespace wedge::render
