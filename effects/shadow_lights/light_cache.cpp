#include "effects/shadow_lights/light_cache.h"

#include "host/render/device_scene.h"
#include "kernels/shared/shadow_lights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr const char* program = "light/light_cache.cl";
constexpr std::size_t texels = std::size_t { WEDGE_CACHE_SIDE } * WEDGE_CACHE_SIDE;
static_assert(texels % WEDGE_TILE_PIXELS == 0);

/// Exponents of the lobes of a kind.
struct Exponents {
    std::set<float> all;
    bool between = false; ///< and some between them
};

/// What a texture multiplies by: the least and the most of its texels.
std::pair<float, float> rangeOf(const scene::Texture& texture)
{
    std::uint32_t least = 255, most = 0;
    for (const std::uint32_t texel : texture.rgba) {
        least = std::min(least, texel & 255u);
        most = std::max(most, texel & 255u);
    }
    return { static_cast<float>(std::min(least, most)) / 255.0f, static_cast<float>(most) / 255.0f };
}

float exponentOf(const scene::Material& m, std::uint32_t kind, float times)
{
    if (kind != WEDGE_MICROFACETS) {
        return times * m.exponent;
    }
    return shared::microfacetGloss(times * m.roughness, {}, {}).exponent;
}

/// Of the materials that triangles have, by kinds.
std::map<std::uint32_t, Exponents> exponentsOf(const scene::Scene& scene)
{
    const std::set<std::uint32_t> used(scene.geometry.materialIds.begin(), scene.geometry.materialIds.end());
    std::map<std::uint32_t, Exponents> out;
    for (const std::uint32_t id : used) {
        const scene::Material& m = scene.materials[id];
        const std::uint32_t kind = kindOf(m);
        if (kind == WEDGE_LAMBERT || WEDGE_IS_MIRROR(kind)) {
            continue;
        }
        std::pair<float, float> times = { 1.0f, 1.0f };
        if (m.exponentTexture >= 0) {
            times = rangeOf(scene.textures[static_cast<std::size_t>(m.exponentTexture)]);
        }
        Exponents& of = out[kind];
        of.all.insert(exponentOf(m, kind, times.first));
        of.all.insert(exponentOf(m, kind, times.second));
        of.between |= times.first < times.second;
    }
    return out;
}

/// As many as have tables, from the smallest on.
std::vector<float> levelsOf(const Exponents& of)
{
    if (!of.between && of.all.size() <= mostCachedExponents) {
        return { of.all.begin(), of.all.end() };
    }
    const double first = std::log1p(*of.all.begin()), last = std::log1p(*of.all.rbegin());
    std::vector<float> out;
    out.reserve(mostCachedExponents);
    for (std::size_t k = 0; k < mostCachedExponents; ++k) {
        const double share = static_cast<double>(k) / (mostCachedExponents - 1);
        out.push_back(static_cast<float>(std::expm1(first + share * (last - first))));
    }
    return out;
}

/// Glosses on the device; one of no meaning where there are none.
graph::Handle<Gloss> listOfGlosses(FrameBuilder& f, std::vector<std::uint32_t> glosses)
{
    glosses.resize(std::max<std::size_t>(glosses.size(), 1));
    auto list = f.graph.list<Gloss>("glosses of tables", graph::counts, glosses.size());
    f.graph.add({ .name = "glosses of tables",
        .kind = PassKind::Transfer,
        .arguments = { writes("list", list) },
        .domain = graph::Domain::Host,
        .step =
            [glosses = std::move(glosses), list](graph::Run& run) {
                if (!run.rehearsal()) {
                    run.buffer<std::uint32_t>(list).upload(run.queue(), glosses);
                }
            },
        .constant = true });
    return list;
}

} // namespace

std::vector<std::uint32_t> cachedGlosses(const scene::Scene& scene)
{
    std::vector<std::uint32_t> out;
    for (const auto& [kind, exponents] : exponentsOf(scene)) {
        for (const float exponent : levelsOf(exponents)) {
            shared::Gloss gloss = shared::makeGloss(exponent, kind);
            out.push_back(shared::packGloss(gloss));
            if (kind == WEDGE_MICROFACETS) {
                gloss.rise = WEDGE_CACHE_RISE;
                out.push_back(shared::packGloss(gloss));
            }
        }
    }
    return out;
}

WholeLights cachedLights(FrameBuilder& f)
{
    const std::vector<std::uint32_t> glosses = cachedGlosses(f.description);
    const std::size_t tables = 1 + glosses.size();
    const graph::Argument count = value("tables", static_cast<std::uint32_t>(tables));
    const graph::Handle<Gloss> list = listOfGlosses(f, glosses);
    auto table = f.graph.list<Radiance>("whole light by normals", graph::floats, 3 * tables * texels);
    f.zero(table);
    f.graph.add({ .name = "whole light",
        .kind = PassKind::Trace,
        .kernel = { program, "fillLightCache" },
        .arguments =
            joined({ f.frame() }, partsOfMap(f), Arguments { count, reads("glosses", list), updates("table", table) }),
        .domain = graph::Domain::Tiles,
        .count = [tables](const graph::Launch&) { return tables * (texels / WEDGE_TILE_PIXELS); },
        .itemsOfTile = WEDGE_TILE_PIXELS / f.packetSize,
        .workUnits = [units = wholeLightUnits(f.settings.environment.shadows)](const graph::Launch&) { return units; },
        .stoppable = true });
    WholeLights whole { f.graph.plane<Radiance>("whole light of matt surfaces", graph::vectors),
        f.graph.plane<Radiance>("whole light of lobes", graph::vectors) };
    const Surfaces& seen = f.surfaces;
    f.pixels("whole light of normals", PassKind::Composite, { program, "lookUpLight" },
        joined({ f.rectangle(f.analysisParams()), f.frame(), count },
            graph::together("surfaces",
                { reads("normal", seen.normal), reads("objectId", seen.objectId), reads("specular", seen.specular),
                    reads("gloss", seen.gloss) }),
            Arguments { reads("glosses", list), reads("table", table), writes("wholeMatt", whole.matt),
                writes("whole", whole.lobes) }));
    return whole;
}

} // namespace wedge::render
