#include "effects/indirect/indirect_light.h"

#include "effects/indirect/path_graph.h"
#include "effects/indirect/path_waves.h"

#include <algorithm>

namespace wedge::render {
namespace {

/// name: what the layer of its filter widths ends in.
Term termOf(Component component, const char* name, const Settings& settings)
{
    return { .name = name,
        .part = Part::Indirect,
        .workUnits = static_cast<double>(settings.spp) * std::max(1, settings.bounces),
        .gathersVariance = true,
        .ofLobes = isGlossy(component),
        .ofPixels = [component](FrameBuilder& frame, const std::shared_ptr<TermState>& state,
                        graph::Handle<Metres>& beta) { addPaths(frame, component, state, beta); },
        .ofWaves = [component](FrameBuilder& frame,
                       const SampleShape& shape) { return std::make_unique<PathWaves>(frame, shape, component); } };
}

class IndirectLight : public Effect {
public:
    std::string name() const override { return "indirect light"; }

    std::vector<Term> terms(const Settings& settings, const scene::Scene& scene) const override
    {
        if (settings.integrator == Integrator::AmbientOcclusion) {
            return { termOf(Component::Ambient, "Ambient", settings) };
        }
        if (settings.bounces == 0) {
            return {};
        }
        std::vector<Term> terms { termOf(Component::Diffuse, "Indirect", settings) };
        if (hasSpecular(scene)) {
            terms.push_back(termOf(Component::Glossy, "Glossy", settings));
        }
        return terms;
    }

    std::string absence(Part part) const override
    {
        return part == Part::Indirect ? "there are no bounces of light" : "";
    }

    std::string widthLayers() const override
    {
        return "of indirect light filterWidthIndirect, filterWidthGlossy; of ambient occlusion filterWidthAmbient";
    }
};

} // namespace

std::unique_ptr<const Effect> indirectLight() { return std::make_unique<IndirectLight>(); }

} // namespace wedge::render
