// The list of lights that sampling chooses among.
#include "host/render/device_scene.h"
#include "host/render/emitters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
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
    const bool alike = other.triangle == one.triangle + 1
        && !(std::abs(one.power - other.power) > 0.1 * std::max(one.power, other.power));
    return alike ? pairAt(g, one.triangle) : WEDGE_PAIR_NONE;
}

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

/// What is chosen together.
struct Entry {
    double power, extent;
    std::size_t number; ///< the first triangle, or the quad
    std::uint32_t pair;
    glm::vec3 at; ///< the middle of its object's light
    std::uint32_t order = 0;
};

std::vector<Entry> entriesOf(const scene::Scene& scene, const std::vector<Emitting>& triangles,
    std::span<const std::uint32_t> quads, std::map<std::uint32_t, Moments>& objects)
{
    const scene::Geometry& g = scene.geometry;
    std::vector<Entry> out;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Emitting& e = triangles[i];
        const std::uint32_t pair = i + 1 < triangles.size() ? pairOf(g, e, triangles[i + 1]) : WEDGE_PAIR_NONE;
        const bool paired = pair != WEDGE_PAIR_NONE;
        const Moments& object = objects[g.objectIds[e.triangle]];
        out.push_back({ e.power + (paired ? triangles[i + 1].power : 0.0), object.extent(), e.triangle, pair,
            glm::vec3(object.centre / object.power) });
        i += paired ? 1 : 0;
    }
    for (const std::uint32_t i : quads) {
        const QuadMoments quad = momentsOf(scene.areaLights[i]);
        out.push_back({ quad.power, quad.extent, i, WEDGE_PAIR_QUAD, scene.areaLights[i].centre });
    }
    return out;
}

/// Bits of a 10-bit number, three apart.
std::uint32_t spreadBits(std::uint32_t x)
{
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

/// Along a Morton curve, object by object: numbers that are stratified over the list are so in space. Within an object
/// meshes' own order is the better one, which makes strips and rings of triangles.
void sortInSpace(std::vector<Entry>& entries)
{
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const Entry& e : entries) {
        low = glm::min(low, e.at);
        high = glm::max(high, e.at);
    }
    const glm::vec3 extent = high - low;
    const float largest = std::max({ extent.x, extent.y, extent.z, std::numeric_limits<float>::min() });
    for (Entry& e : entries) {
        const glm::uvec3 cell(glm::clamp((e.at - low) / largest * 1024.0f, 0.0f, 1023.0f));
        e.order = spreadBits(cell.x) | (spreadBits(cell.y) << 1) | (spreadBits(cell.z) << 2);
    }
    std::ranges::stable_sort(entries, {}, &Entry::order);
}

/// A list that is being made, one entry after the other.
class Choices {
public:
    explicit Choices(double total)
        : total_(total)
    {
    }
    /// Returns the probability after rounding: what has 0 is found by reflected directions alone.
    float add(const Entry& e)
    {
        sum_ += e.power;
        const float upTo = std::min(static_cast<float>(sum_ / total_), 1.0f), pick = upTo - before_;
        list_.push_back({ upTo, static_cast<std::uint32_t>(e.number), static_cast<float>(e.extent), e.pair, 0 });
        before_ = upTo;
        return pick;
    }
    std::vector<shared::Emitter> take()
    {
        std::size_t chosen = 0;
        for (std::size_t i = 0; i < list_.size(); ++i) {
            const float from = static_cast<float>(i) / static_cast<float>(list_.size());
            while (chosen + 1 < list_.size() && list_[chosen].upTo <= from) {
                ++chosen;
            }
            list_[i].guide = static_cast<std::uint32_t>(chosen);
        }
        return std::move(list_);
    }

private:
    double total_, sum_ = 0;
    float before_ = 0;
    std::vector<shared::Emitter> list_;
};

/// twins: triangles that lie in the place of another one, and that one.
std::vector<Emitting> emitting(const scene::Scene& scene, std::span<const std::size_t> elsewhere,
    std::map<std::uint32_t, Moments>& objects, std::vector<std::pair<std::size_t, std::size_t>>& twins)
{
    const scene::Geometry& g = scene.geometry;
    std::vector<Emitting> out;
    std::unordered_map<Corners, std::size_t, CornersHash> known;
    for (std::size_t t = 0; t < g.materialIds.size(); ++t) {
        if (!mayEmit(scene, t) || std::ranges::binary_search(elsewhere, t)) {
            continue;
        }
        const glm::dvec3 a = cornerOf(g, t, 0), b = cornerOf(g, t, 1), c = cornerOf(g, t, 2),
                         middle = (a + b + c) / 3.0;
        const double power = texturedPower(scene, t);
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

/// Where a list's lights are, and how far their reflected directions may matter.
struct Surroundings {
    glm::vec3 low { std::numeric_limits<float>::max() }, high { std::numeric_limits<float>::lowest() };
    double sparsest = 0; ///< m^2: one over the least density of points

    void add(const scene::Geometry& g, std::size_t triangle, float pick)
    {
        bool moves = false;
        for (std::size_t k = 0; k < 3; ++k) {
            reach(glm::vec3(cornerOf(g, triangle, k)));
            moves |= movesAt(g, g.indices[3 * triangle + k]);
        }
        include(moves ? std::numeric_limits<double>::infinity() : areaOf(g, triangle), pick);
    }
    void add(const scene::AreaLight& quad, float pick)
    {
        for (const float u : { -1.0f, 1.0f }) {
            for (const float v : { -1.0f, 1.0f }) {
                reach(quad.centre + u * quad.halfU + v * quad.halfV);
            }
        }
        include(4.0 * glm::length(glm::cross(quad.halfU, quad.halfV)), pick);
    }
    /// Points of density d on a surface at the distance r have at least the density d r^2 in 1/sr, reflected
    /// directions at most 1/pi.
    float directedWithin() const { return static_cast<float>(std::sqrt(sparsest / std::acos(-1.0))); }

private:
    void reach(glm::vec3 point)
    {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    /// What is never chosen is found by directions alone, from wherever.
    void include(double area, float pick)
    {
        sparsest = std::max(sparsest, pick > 0 ? area / double { pick } : std::numeric_limits<double>::infinity());
    }
};

} // namespace

EmitterList emitterList(
    const scene::Scene& scene, std::span<const std::size_t> elsewhere, std::span<const std::uint32_t> quads)
{
    EmitterList out;
    std::map<std::uint32_t, Moments> objects;
    std::vector<std::pair<std::size_t, std::size_t>> twins;
    const std::vector<Emitting> triangles = emitting(scene, elsewhere, objects, twins);
    double total = 0;
    for (const Emitting& e : triangles) {
        total += e.power;
    }
    for (const std::uint32_t i : quads) {
        total += momentsOf(scene.areaLights[i]).power;
    }
    if (!(total > 0)) {
        return out;
    }
    out.power = 2.0 * total;
    out.quadPicks.assign(scene.areaLights.size(), WEDGE_PICK_ELSEWHERE);
    std::vector<float>& picks = out.picks;
    const std::size_t count = scene.geometry.materialIds.size();
    std::size_t some = 0;
    while (some < count && !mayEmit(scene, some)) {
        ++some;
    }
    if (some < count) {
        picks.assign(count, 0.0f);
    }
    std::vector<Entry> entries = entriesOf(scene, triangles, quads, objects);
    sortInSpace(entries);
    Choices choices(total);
    Surroundings around;
    for (const Entry& e : entries) {
        const float pick = choices.add(e);
        if (e.pair == WEDGE_PAIR_QUAD) {
            out.quadPicks[e.number] = pick;
            around.add(scene.areaLights[e.number], pick);
            continue;
        }
        const std::size_t triangleCount = e.pair == WEDGE_PAIR_NONE ? 1 : 2;
        for (std::size_t t = e.number; t < e.number + triangleCount; ++t) {
            picks[t] = pick / static_cast<float>(triangleCount);
            around.add(scene.geometry, t, picks[t]);
        }
    }
    for (std::size_t t = 0; t < picks.size(); ++t) {
        if (isFoundAlone(scene, t)) {
            around.sparsest = std::numeric_limits<double>::infinity();
        }
    }
    out.low = around.low;
    out.high = around.high;
    out.directedWithin = around.directedWithin();
    out.list = choices.take();
    for (const auto& [twin, first] : twins) {
        picks[twin] = picks[first];
    }
    for (const std::size_t t : elsewhere) {
        picks[t] = WEDGE_PICK_ELSEWHERE;
    }
    return out;
}

} // namespace wedge::render
