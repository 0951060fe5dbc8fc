#include "effects/delta_lights/delta_lights.h"

namespace wedge::render {

using graph::reads;
using graph::tallies;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr const char* program = "light/delta_lights.cl";

/// The lights, as the kernel takes them.
std::vector<graph::Argument> lights(const FrameBuilder& f)
{
    return graph::together("lights",
        { f.ofScene("lights", "DeltaLight", &DeviceScene::deltaLights),
            value("lightCount", f.scene != nullptr ? f.scene->deltaLightCount : 0u),
            value("sceneDiameter", f.scene != nullptr ? f.scene->diameter : 0.0f) });
}

void ofPixels(FrameBuilder& f, graph::Handle<Radiance>* /*own*/)
{
    Totals& t = f.totals;
    auto rays = f.graph.plane<Count>("rays of light", graph::counts);
    f.zero(rays);
    f.trace("point lights", { program, "deltaLights" },
        joined({ f.frame() }, lights(f), f.hierarchy(), f.receivers(),
            Arguments { reads("diffuse", f.surfaces.diffuse), reads("specular", f.surfaces.specular),
                updates("direct", t.direct.filtered), updates("directNoisy", t.direct.noisy), tallies("rays", rays) }),
        false, [](const graph::Launch&) { return 1.0; });
    f.count(rays, true, t.tallies.rays, &t.rays);
}

void ofWaves(FrameBuilder& f, Waves& waves, graph::Handle<Radiance>& radiance)
{
    const Receivers& r = waves.receivers();
    auto noisy = waves.list<Radiance>("unfiltered radiance", graph::vectors); // the same once more
    waves.tiles("point and directional lights", { program, "deltaLights" },
        joined({ waves.receiverParams() }, lights(f), f.hierarchy(), waves.receiverArguments(),
            Arguments { reads("diffuse", r.diffuse), reads("specular", r.specular), updates("direct", radiance),
                writes("directNoisy", noisy), waves.tallyRays() }),
        false);
}

class DeltaLights : public Effect {
public:
    std::string name() const override { return "point and directional lights"; }

    std::optional<Unfiltered> unfiltered(const Settings& settings, const PreparedScene& scene) const override
    {
        if (settings.integrator != Integrator::Path || (scene.pointLights.empty() && scene.directionalLights.empty())) {
            return std::nullopt;
        }
        return Unfiltered { .name = "point lights", .workUnits = 1, .ofPixels = ofPixels, .ofWaves = ofWaves };
    }
};

} // namespace

std::unique_ptr<const Effect> deltaLights() { return std::make_unique<DeltaLights>(); }

} // namespace wedge::render
