#include "effects/delta_lights/delta_lights.h"

#include "effects/styled_shadows/styled_lights.h"

namespace wedge::render {

using graph::reads;
using graph::updates;
using graph::value;

namespace {

constexpr const char* program = "light/delta_lights.cl";

/// The lights, as the kernel takes them: all, or those whose shadows have no style.
std::vector<graph::Argument> lights(const FrameBuilder& f)
{
    const bool all = !f.settings.styles;
    const std::uint32_t count = f.scene == nullptr ? 0u : all ? f.scene->deltaLightCount : f.scene->plainLightCount;
    return graph::together("lights",
        { f.ofScene("lights", "DeltaLight", all ? &DeviceScene::deltaLights : &DeviceScene::plainLights),
            value("lightCount", count), value("sceneDiameter", f.scene != nullptr ? f.scene->diameter : 0.0f) });
}

void sample(FrameBuilder& f, ReceiverSet& at, graph::Handle<Radiance>& radiance)
{
    at.trace("point lights", { program, "deltaLights" },
        joined({ at.frame() }, lights(f), f.hierarchy(), at.arguments(),
            Arguments { reads("diffuse", at.surfaces().diffuse), reads("specular", at.surfaces().specular),
                updates("lit", radiance), at.tallyRays() }),
        [](const graph::Launch&) { return 1.0; });
}

class DeltaLights : public Effect {
public:
    std::string name() const override { return "point and directional lights"; }

    std::optional<Unfiltered> unfiltered(const Settings& settings, const PreparedScene& scene) const override
    {
        const std::size_t all = scene.pointLights.size() + scene.directionalLights.size();
        if (settings.integrator != Integrator::Path || all == styledLights(settings, scene).size()) {
            return std::nullopt;
        }
        return Unfiltered { .name = "point lights", .workUnits = 1, .sample = sample };
    }
};

} // namespace

std::unique_ptr<const Effect> deltaLights() { return std::make_unique<DeltaLights>(); }

} // namespace wedge::render
