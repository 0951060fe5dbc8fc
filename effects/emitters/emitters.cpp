#include "effects/emitters/emitters.h"

#include "effects/indirect/path_term.h"

namespace wedge::render {
namespace {

class Emitters : public Effect {
public:
    std::string name() const override { return "emitters"; }

    std::vector<Term> terms(const Settings& settings, const PreparedScene& scene) const override
    {
        if (settings.integrator != Integrator::Path || !scene.directLights().share) {
            return {};
        }
        std::vector<Term> terms { pathTerm(Component::Emitters, "Emitters", settings) };
        if (scene.traits().specular) {
            terms.push_back(pathTerm(Component::EmittersGlossy, "EmittersGlossy", settings));
        }
        return terms;
    }

    std::vector<Target> targets() const override
    {
        return { targetOf(Component::Emitters), targetOf(Component::EmittersGlossy) };
    }

    std::string widthLayers() const override
    {
        return "of meshes that emit filterWidthEmitters, filterWidthEmittersGlossy";
    }
};

} // namespace

std::unique_ptr<const Effect> emitters() { return std::make_unique<Emitters>(); }

} // namespace wedge::render
