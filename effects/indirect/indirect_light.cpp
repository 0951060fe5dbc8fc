#include "effects/indirect/indirect_light.h"

#include "effects/indirect/path_term.h"

namespace wedge::render {
namespace {

class IndirectLight : public Effect {
public:
    std::string name() const override { return "indirect light"; }

    std::vector<Term> terms(const Settings& settings, const PreparedScene& scene) const override
    {
        if (settings.integrator == Integrator::AmbientOcclusion) {
            return { pathTerm(Component::Ambient, "Ambient", settings) };
        }
        if (settings.bounces == 0) {
            return {};
        }
        std::vector<Term> terms { pathTerm(Component::Diffuse, "Indirect", settings) };
        if (scene.traits().specular) {
            terms.push_back(pathTerm(Component::Glossy, "Glossy", settings));
        }
        return terms;
    }

    std::vector<Target> targets() const override
    {
        return { targetOf(Component::Diffuse), targetOf(Component::Glossy), targetOf(Component::Ambient) };
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
