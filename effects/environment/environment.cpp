#include "effects/environment/environment.h"

#include "effects/environment/environment_section.h"
#include "effects/environment/suns.h"
#include "effects/indirect/path_term.h"
#include "host/scene/sections.h"

#include <utility>

namespace wedge::render {
namespace {

constexpr const char* key = "environment";

class EnvironmentLight : public Effect {
public:
    EnvironmentLight()
    {
        scene::registerSection({ key, readEnvironment, true, [](const std::any& read, const scene::Bounds& bounds) {
                                    return sunLights(
                                        *std::any_cast<std::shared_ptr<const EnvironmentPicture>>(read), bounds);
                                } });
    }

    std::string name() const override { return key; }

    std::vector<Term> terms(const Settings& settings, const PreparedScene& scene) const override
    {
        // Lights that stand for the map bring this light in their place (effects/shadow_lights).
        if (settings.integrator != Integrator::Path || scene.picture() == nullptr
            || settings.environment.shadows.shadows != Shadows::Sampled) {
            return {};
        }
        std::vector<Term> terms { pathTerm(Component::Environment, "Environment", settings) };
        if (scene.traits().specular) {
            terms.push_back(pathTerm(Component::EnvironmentGlossy, "EnvironmentGlossy", settings));
        }
        return terms;
    }

    std::vector<Target> targets() const override
    {
        return { targetOf(Component::Environment), targetOf(Component::EnvironmentGlossy) };
    }

    std::string widthLayers() const override
    {
        return "of the environment filterWidthEnvironment, filterWidthEnvironmentGlossy";
    }

    std::shared_ptr<const EnvironmentPicture> picture(const scene::Scene& scene) const override
    {
        const auto found = scene.extensions.find(key);
        return found == scene.extensions.end()
            ? nullptr
            : std::any_cast<std::shared_ptr<const EnvironmentPicture>>(found->second);
    }
};

} // namespace

std::unique_ptr<const Effect> environment() { return std::make_unique<EnvironmentLight>(); }

void setEnvironment(scene::Scene& scene, std::shared_ptr<const EnvironmentPicture> picture)
{
    if (picture == nullptr) {
        scene.extensions.erase(key);
    } else {
        scene.extensions[key] = std::move(picture);
    }
}

} // namespace wedge::render
