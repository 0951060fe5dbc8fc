// The list of lights that sampling chooses among.
#include "host/render/emitter_groups.h"
#include "host/render/emitter_tree.h"
#include "host/render/emitters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace wedge::render {
namespace {

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
    /// What is never chosen is found by directions alone, from wherever.
    void alone(bool found) { sparsest = found ? std::numeric_limits<double>::infinity() : sparsest; }
    /// Points of density d on a surface at the distance r have at least the density d r^2 in 1/sr, reflected
    /// directions at most 1/pi.
    float directedWithin() const { return static_cast<float>(std::sqrt(sparsest / std::acos(-1.0))); }

private:
    void reach(glm::vec3 point)
    {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void include(double area, float pick)
    {
        sparsest = std::max(sparsest, pick > 0 ? area / double { pick } : std::numeric_limits<double>::infinity());
    }
};

/// Axes of a mesh: a side of its strongest face, across it, and that one's normal.
std::array<glm::dvec3, 3> axesOf(const scene::Geometry& g, const EmitterGroup& group)
{
    const auto strongest = std::ranges::max_element(group.entries, {}, &EmitterEntry::power);
    const std::size_t t = strongest->number;
    const glm::dvec3 a = cornerOf(g, t, 0), along = glm::normalize(cornerOf(g, t, 1) - a),
                     normal = glm::normalize(glm::cross(along, cornerOf(g, t, 2) - a));
    return { along, glm::cross(normal, along), normal };
}

/// A list that is being made.
class ListMaker {
public:
    ListMaker(const scene::Scene& scene, const EmitterGroups& groups)
        : scene_(scene)
        , groups_(groups)
    {
        out_.power = 2.0 * groups.power;
        out_.quadPicks.assign(scene.areaLights.size(), WEDGE_PICK_ELSEWHERE);
        const std::size_t count = scene.geometry.materialIds.size();
        std::size_t some = 0;
        while (some < count && !mayEmit(scene, some)) {
            ++some;
        }
        if (some < count) {
            out_.picks.assign(count, 0.0f);
        }
        tables_.assign(groups.textures.size(), 0);
        list();
        guide();
        for (std::size_t t = 0; t < count && some < count; ++t) {
            around_.alone(isFoundAlone(scene, t));
        }
        out_.low = around_.low;
        out_.high = around_.high;
        out_.directedWithin = around_.directedWithin();
        for (const EmitterTwin& twin : groups.twins) {
            addTwin(twin);
        }
    }
    EmitterList take() { return std::move(out_); }

private:
    void list()
    {
        out_.count = static_cast<std::uint32_t>(groups_.groups.size());
        out_.list.resize(out_.count);
        double sum = 0;
        float before = 0;
        for (std::size_t i = 0; i < groups_.groups.size(); ++i) {
            const EmitterGroup& group = groups_.groups[i];
            sum += group.power;
            const float upTo = std::min(static_cast<float>(sum / groups_.power), 1.0f);
            shared::Emitter entry {};
            if (group.entries.size() == 1) {
                entry = entryOf(group, group.entries[0], upTo - before);
            } else {
                entry = mesh(group, upTo - before);
                entry.extent = static_cast<float>(group.extent);
            }
            entry.upTo = upTo;
            out_.list[i] = entry;
            before = upTo;
        }
    }
    shared::Emitter mesh(const EmitterGroup& group, float pick)
    {
        out_.trees = true;
        std::vector<EmitterPart> parts;
        parts.reserve(group.entries.size());
        for (const EmitterEntry& e : group.entries) {
            auto part = e.pair << WEDGE_PART_SHIFT | static_cast<std::uint32_t>(e.number);
            if (tableOf(e) != 0) {
                part = WEDGE_PART_TABLED << WEDGE_PART_SHIFT | static_cast<std::uint32_t>(out_.list.size());
                out_.list.emplace_back(); // until its probability is known
            }
            parts.push_back({ parts.size(), part, e.power, e.at });
        }
        const shared::Emitter mesh = addMesh(out_.list, parts, axesOf(scene_.geometry, group), pick);
        for (const EmitterPart& p : parts) {
            const EmitterEntry& e = group.entries[p.number];
            const shared::Emitter entry = entryOf(group, e, p.pick);
            if (p.part >> WEDGE_PART_SHIFT == WEDGE_PART_TABLED) {
                out_.list[p.part & WEDGE_PART_NUMBER] = entry;
            }
        }
        return mesh;
    }
    /// Fills the probabilities of its triangles, too.
    shared::Emitter entryOf(const EmitterGroup& group, const EmitterEntry& e, float pick)
    {
        shared::Emitter out {};
        out.triangle = static_cast<std::uint32_t>(e.number);
        out.extent = static_cast<float>(group.extent);
        out.pair = e.pair;
        if (e.pair == WEDGE_PAIR_QUAD) {
            out_.quadPicks[e.number] = pick;
            around_.add(scene_.areaLights[e.number], pick);
            return out;
        }
        const std::size_t count = e.pair == WEDGE_PAIR_NONE ? 1 : 2;
        const std::uint32_t table = tableOf(e);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t t = e.number + i;
            const float own = pick / static_cast<float>(count);
            around_.add(scene_.geometry, t, own);
            out_.picks[t] = own;
            if (table != 0 && pick > 0) {
                const std::uint32_t header =
                    addHeader(pick, e.pair | (i > 0 ? WEDGE_HEADER_SECOND : 0u), { 0, 1 }, table);
                out_.picks[t] = std::bit_cast<float>(WEDGE_PICK_TABLE + header);
                out.header = i == 0 ? header : out.header;
            }
        }
        return out;
    }
    /// 0: none.
    std::uint32_t tableOf(const EmitterEntry& e)
    {
        if (e.texture == EmitterEntry::none || groups_.textures[e.texture].cells.empty()) {
            return 0;
        }
        std::uint32_t& at = tables_[e.texture];
        if (at == 0) {
            at = static_cast<std::uint32_t>(out_.picks.size());
            const std::vector<float> table = emitterTable(groups_.textures[e.texture]);
            out_.picks.insert(out_.picks.end(), table.begin(), table.end());
            out_.tables = true;
        }
        return at;
    }
    /// corners: of the triangle, that are the first two of the entry's.
    std::uint32_t addHeader(float pick, std::uint32_t shape, std::array<std::uint32_t, 2> corners, std::uint32_t table)
    {
        const auto header = static_cast<std::uint32_t>(out_.picks.size());
        const std::uint32_t order = corners[0] | (corners[1] << 2);
        out_.picks.insert(out_.picks.end(),
            { pick, std::bit_cast<float>(shape | (order << WEDGE_HEADER_CORNERS)), std::bit_cast<float>(table) });
        return header;
    }
    void addTwin(const EmitterTwin& twin)
    {
        const float pick = out_.picks[twin.first];
        out_.picks[twin.triangle] = pick;
        if (pick < 2.0f) {
            return;
        }
        const std::size_t header = std::bit_cast<std::uint32_t>(pick) - WEDGE_PICK_TABLE;
        std::array<std::uint32_t, 2> corners {};
        for (std::uint32_t k = 0; k < 2; ++k) {
            while (corners[k] < 2
                && cornerOf(scene_.geometry, twin.triangle, corners[k]) != cornerOf(scene_.geometry, twin.first, k)) {
                ++corners[k];
            }
        }
        constexpr std::uint32_t kinds = (1u << WEDGE_HEADER_CORNERS) - 1u;
        const std::uint32_t shape = std::bit_cast<std::uint32_t>(out_.picks[header + 1]) & kinds;
        const auto table = std::bit_cast<std::uint32_t>(out_.picks[header + 2]);
        const float entry = out_.picks[header];
        out_.picks[twin.triangle] = std::bit_cast<float>(WEDGE_PICK_TABLE + addHeader(entry, shape, corners, table));
    }
    /// Where the search for each of as many stripes of numbers begins.
    void guide()
    {
        std::uint32_t chosen = 0;
        for (std::uint32_t i = 0; i < out_.count; ++i) {
            const float from = static_cast<float>(i) / static_cast<float>(out_.count);
            while (chosen + 1 < out_.count && out_.list[chosen].upTo <= from) {
                ++chosen;
            }
            out_.list[i].guide = chosen;
        }
    }

    const scene::Scene& scene_;
    const EmitterGroups& groups_;
    EmitterList out_;
    Surroundings around_;
    std::vector<std::uint32_t> tables_; ///< of each texture: where its table begins, 0 until it is made
};

} // namespace

EmitterList emitterList(
    const scene::Scene& scene, std::span<const std::size_t> elsewhere, std::span<const std::uint32_t> quads)
{
    const EmitterGroups groups = emitterGroups(scene, elsewhere, quads);
    if (!(groups.power > 0)) {
        return {};
    }
    EmitterList out = ListMaker(scene, groups).take();
    for (const std::size_t t : elsewhere) {
        out.picks[t] = WEDGE_PICK_ELSEWHERE;
    }
    return out;
}

} // namespace wedge::render
