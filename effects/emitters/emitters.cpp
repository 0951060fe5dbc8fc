#include "effects/emitters/emitters.h"

#include "effects/indirect/path_graph.h"
#include "effects/indirect/path_waves.h"
#include "host/render/direct_lights.h"

namespace wedge::render {
namespace {

/// Sampled, analysed and filtered as paths of no bounce. name: what the layer of its filter widths ends in.
Term termOf(Component component, const char* name, const Settings& settings)
{
    return { .name = name,
        .part = Part::Direct,
        .workUnits = static_cast<double>(settings.spp),
        .gathersVariance = true,
        .ofLobes = isGlossy(component),
        .ofPixels = [component](FrameBuilder& frame, const std::shared_ptr<TermState>& state,
                        graph::Handle<Metres>& beta) { addPaths(frame, component, state, beta); },
        .ofWaves = [component](FrameBuilder& frame,
                       const SampleShape& shape) { return std::make_unique<PathWaves>(frame, shape, component); } };
}

class Emitters : public Effect {
public:
    std::string name() const override { return "emitters"; }

    std::vector<Term> terms(const Settings& settings, const scene::Scene& scene) const override
    {
        if (settings.integrator != Integrator::Path || !directLights(scene).share) {
            return {};
        }
        std::vector<Term> terms { termOf(Component::Emitters, "Emitters", settings) };
        if (hasSpecular(scene)) {
            terms.push_back(termOf(Component::EmittersGlossy, "EmittersGlossy", settings));
        }
        return terms;
    }

    std::string widthLayers() const override
    {
        return "of meshes that emit filterWidthEmitters, filterWidthEmittersGlossy";
    }
};

} // namespace

std::unique_ptr<const Effect> emitters() { return std::make_unique<Emitters>(); }

} // namespace wedge::render
