#include "effects/mirrors/mirrors.h"

#include "effects/indirect/indirect.h"
#include "host/render/sample_slices.h"

#include <algorithm>

namespace wedge::render {

using graph::reads;
using graph::tallies;
using graph::updates;
using graph::value;

namespace {

constexpr const char* program = "paths/mirrors.cl";

// Vertices of a pixel's paths between two looks at the cancel flag; also what one launch over one tile may cost.
constexpr int sliceVertices = 96;
/// Of a path, as far as progress is concerned: mirrors of which most paths follow few, and the surface that is seen.
constexpr int usualVertices = 3;

int vertices(const Settings& settings) { return usualVertices + settings.bounces; }

/// The frame's scene, and how paths go on behind the mirrors: from the surface that is seen.
std::vector<graph::Argument> scene(const FrameBuilder& f)
{
    shared::PathParams p = pathParams(f, Component::Diffuse);
    p.bounces = static_cast<std::uint32_t>(f.settings.bounces) + 1;
    return joined({ value("params", p) }, f.hierarchy(), f.geometry(), sceneLights(f, Component::Diffuse));
}

void ofPixels(FrameBuilder& f, graph::Handle<Radiance>* /*own*/)
{
    Totals& t = f.totals;
    auto rays = f.graph.plane<Count>("rays of light", graph::counts);
    auto pathRays = f.graph.plane<Count>("rays of paths", graph::counts);
    auto taken = f.graph.plane<Count>("samples taken", graph::counts);
    auto sums = f.graph.plane<Sums>("sums", graph::vectors);
    f.zero(rays, pathRays, taken, sums);
    const auto spp = static_cast<std::uint32_t>(f.settings.spp);
    const auto slice = static_cast<std::uint32_t>(std::max(1, sliceVertices / vertices(f.settings)));
    const SampleSlices slices(0, spp, slice, f.settings.spp);
    f.graph.loop("slices", slices.counter(), [&] {
        f.trace("mirrors", { program, "sampleMirrors" },
            joined({ f.frame() }, scene(f), f.receivers(),
                Arguments { graph::absent("sampleOf", graph::counts), slices.last(), updates("taken", taken),
                    tallies("rays", rays), tallies("pathRays", pathRays), updates("sums", sums) }),
            false, slices.workUnits(static_cast<double>(f.settings.spp) * vertices(f.settings)));
    });
    f.trace("mirrors", { program, "addMirrored" },
        { f.frame(), reads("taken", taken), reads("sums", sums), updates("direct", t.direct.filtered),
            updates("directNoisy", t.direct.noisy) },
        false, [](const graph::Launch&) { return 0.0; });
    f.count(rays, true, t.tallies.rays, &t.rays);
    f.count(pathRays, true, t.tallies.pathRays);
}

void ofWaves(FrameBuilder& f, Waves& waves, graph::Handle<Radiance>& radiance)
{
    waves.tiles("mirrors", { program, "sampleMirrors" },
        joined({ waves.receiverParams() }, scene(f), waves.receiverArguments(),
            Arguments { reads("sampleOf", waves.receivers().sampleOf), value("lastSample", 0u),
                graph::absent("taken", graph::counts), waves.tallyRays(), waves.tallyPathRays(),
                updates("sums", radiance) }),
        false);
}

class Mirrors : public Effect {
public:
    std::string name() const override { return "mirrors and glass"; }

    std::optional<Unfiltered> unfiltered(const Settings& settings, const PreparedScene& scene) const override
    {
        if (settings.integrator != Integrator::Path || !scene.traits().mirrors) {
            return std::nullopt;
        }
        return Unfiltered { .name = "mirrors",
            .workUnits = static_cast<double>(settings.spp) * vertices(settings),
            .ofPixels = ofPixels,
            .ofWaves = ofWaves };
    }
};

} // namespace

std::unique_ptr<const Effect> mirrors() { return std::make_unique<Mirrors>(); }

} // namespace wedge::render
