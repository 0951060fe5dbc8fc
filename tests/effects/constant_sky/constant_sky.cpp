#include "tests/effects/constant_sky/constant_sky.h"

#include "host/error.h"
#include "host/file.h"
#include "host/scene/sections.h"
#include "host/scene/toml_reader.h"

#include <charconv>

#include <fmt/format.h>

namespace wedge::test {

using graph::reads;
using graph::updates;
using graph::value;
using render::FrameBuilder;
using render::Radiance;

namespace {

constexpr const char* key = "sky";
const graph::KernelName kernel { "constant_sky/sky.cl", "skyLight" };

glm::vec3 radianceOf(const scene::Scene& scene)
{
    const auto sky = scene.extensions.find(key);
    return sky == scene.extensions.end() ? glm::vec3(0.0f) : std::any_cast<glm::vec3>(sky->second);
}

void sample(FrameBuilder& f, render::ReceiverSet& at, graph::Handle<Radiance>& radiance)
{
    const std::uint32_t samples = at.samples().value_or(1);
    at.trace("sky", kernel,
        render::joined({ at.frame(), value("sampling", static_cast<std::uint32_t>(f.settings.lightSampling)),
                           value("samples", samples) },
            f.hierarchy(), at.arguments(),
            render::Arguments { at.sampleOf(), reads("diffuse", at.surfaces().diffuse),
                reads("specular", at.surfaces().specular), updates("lit", radiance), at.tallyRays() }),
        [samples](const graph::Launch&) { return static_cast<double>(samples); });
}

/// "0.5": a grey.
render::SceneChange parsed(const std::string& text)
{
    float grey = 0;
    const char* end = text.data() + text.size();
    const auto [stop, status] = std::from_chars(text.data(), end, grey);
    if (stop != end || status != std::errc() || !(grey >= 0.0f) || grey > 1e6f) {
        throw UsageError("sky is not a radiance", "--sky " + text, "give a number from 0 to 1000000");
    }
    return [grey](scene::Scene& scene) { setSky(scene, glm::vec3(grey)); };
}

class ConstantSky : public render::Effect {
public:
    std::string name() const override { return "constant sky"; }

    std::optional<render::Unfiltered> unfiltered(
        const render::Settings& settings, const render::PreparedScene& scene) const override
    {
        if (settings.integrator != render::Integrator::Path || radianceOf(scene) == glm::vec3(0.0f)) {
            return std::nullopt;
        }
        return render::Unfiltered {
            .name = "sky", .layer = "sky", .workUnits = static_cast<double>(settings.spp), .sample = sample
        };
    }

    std::vector<render::LayerInfo> layers(
        const render::Settings& settings, const render::PreparedScene* scene) const override
    {
        const bool absent = scene != nullptr && !unfiltered(settings, *scene);
        return { { "sky", { "R", "G", "B" }, "radiance reflected from the sky",
            absent ? "the frame has no " + name() : "" } };
    }

    device::GeneratedSources sources() const override
    {
        return { { kernel.file, readFile(WEDGE_SKY_KERNEL, "kernel file", std::uintmax_t { 1 } << 20) } };
    }

    std::optional<render::Environment> environment(const scene::Scene& scene) const override
    {
        const glm::vec3 l = radianceOf(scene);
        if (l == glm::vec3(0.0f)) {
            return std::nullopt;
        }
        return render::Environment { "constantSky",
            fmt::format("WEDGE_INLINE Vec3 constantSky(Vec3 direction)\n{{\n    (void)direction;\n"
                        "    return vec3({:.9e}f, {:.9e}f, {:.9e}f);\n}}\n",
                l.x, l.y, l.z) };
    }

    std::vector<render::EffectOption> options() const override
    {
        return { { "--sky", "RADIANCE", "Radiance of a grey sky. Default: the scene's", parsed } };
    }
};

} // namespace

std::unique_ptr<const render::Effect> constantSky() { return std::make_unique<ConstantSky>(); }

void setSky(scene::Scene& scene, glm::vec3 radiance) { scene.extensions[key] = radiance; }

void registerSky()
{
    static const bool once = [] {
        render::registerEffect(constantSky());
        scene::registerSection({ key, [](scene::TableReader& table, scene::Warnings&) -> std::any {
                                    return table.require("radiance", table.colour("radiance"));
                                } });
        return true;
    }();
    (void)once;
}

} // namespace wedge::test
