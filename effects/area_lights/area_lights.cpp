#include "effects/area_lights/area_lights.h"

#include "effects/area_lights/light_pixels.h"
#include "effects/area_lights/light_waves.h"
#include "effects/area_lights/maaf.h"

#include <optional>

namespace wedge::render {
namespace {

class AreaLights : public Effect {
public:
    std::string name() const override { return "area lights"; }

    std::vector<Term> terms(const Settings& settings, const PreparedScene& scene) const override
    {
        std::vector<Term> out;
        const std::vector<OwnLight>& lights = scene.directLights().own;
        for (std::uint32_t i = 0; settings.integrator == Integrator::Path && i < lights.size(); ++i) {
            const std::optional<std::uint32_t> quad = lights[i].number;
            const TermLight light { i, lights[i].onDevice(), lights.size() == 1 ? "" : std::to_string(i + 1),
                quad.value_or(0), quad ? changerOfVisibility(settings, scene.areaLights[*quad]) : nullptr };
            out.push_back({ .name = light.name,
                .part = Part::Direct,
                .workUnits = static_cast<double>(settings.spp),
                .changed = light.changer != nullptr,
                .inPixels = [light](FrameBuilder& frame) { return std::make_unique<LightPixels>(frame, light); },
                .inWaves =
                    [light](FrameBuilder& frame, const SampleShape& shape) {
                        return std::make_unique<LightWaves>(frame, shape, light);
                    } });
        }
        return out;
    }

    std::string absence(Part part) const override { return part == Part::Direct ? "the scene has no area light" : ""; }

    std::string widthLayers() const override { return "of the area light; of several filterWidth1, filterWidth2, ..."; }

    std::vector<LayerInfo> layers(const Settings& settings, const PreparedScene*) const override
    {
        return { componentsLayer(settings) };
    }
};

} // namespace

std::unique_ptr<const Effect> areaLights() { return std::make_unique<AreaLights>(); }

} // namespace wedge::render
