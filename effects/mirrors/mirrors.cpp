#include "effects/mirrors/mirrors.h"

#include "effects/indirect/indirect.h"
#include "host/render/sample_slices.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

namespace wedge::render {

using graph::reads;
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

/// sampleMirrors. taken: samples that there are; absent where each receiver is one
void trace(FrameBuilder& f, ReceiverSet& at, graph::Argument last, graph::Argument taken, graph::Argument sums,
    const std::function<double(const graph::Launch&)>& workUnits)
{
    at.trace("mirrors", { program, "sampleMirrors" },
        joined({ at.frame() }, scene(f), at.arguments(),
            Arguments { at.sampleOf(), std::move(last), std::move(taken), at.tallyRays(), at.tallyPathRays(),
                std::move(sums) }),
        workUnits);
}

void sample(FrameBuilder& f, ReceiverSet& at, graph::Handle<Radiance>& radiance)
{
    const std::optional<std::uint32_t> spp = at.samples();
    if (!spp) {
        trace(f, at, value("lastSample", 0u), graph::absent("taken", graph::counts), updates("sums", radiance),
            [](const graph::Launch&) { return 0.0; });
        return;
    }
    auto taken = f.graph.plane<Count>("samples taken", graph::counts);
    f.zero(taken);
    const auto slice = static_cast<std::uint32_t>(std::max(1, sliceVertices / vertices(f.settings)));
    const SampleSlices slices(0, *spp, slice, *spp);
    f.graph.loop("slices", slices.counter(), [&] {
        trace(f, at, slices.last(), updates("taken", taken), updates("sums", radiance),
            slices.workUnits(static_cast<double>(*spp) * vertices(f.settings)));
    });
    // Of frames that are stopped, too: what was sampled is shown.
    f.pixels("composite", device::PassKind::Composite, { program, "meanOfMirrored" },
        { f.rectangle(f.analysisParams()), reads("taken", taken), updates("sums", radiance) });
}

class Mirrors : public Effect {
public:
    std::string name() const override { return "mirrors and glass"; }

    std::optional<Unfiltered> unfiltered(const Settings& settings, const PreparedScene& scene) const override
    {
        if (settings.integrator != Integrator::Path || !scene.traits().mirrors) {
            return std::nullopt;
        }
        return Unfiltered {
            .name = "mirrors", .workUnits = static_cast<double>(settings.spp) * vertices(settings), .sample = sample
        };
    }
};

} // namespace

std::unique_ptr<const Effect> mirrors() { return std::make_unique<Mirrors>(); }

} // namespace wedge::render
