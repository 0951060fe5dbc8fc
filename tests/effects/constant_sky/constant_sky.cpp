#include "tests/effects/constant_sky/constant_sky.h"

#include "host/error.h"
#include "host/file.h"
#include "host/scene/sections.h"
#include "host/scene/toml_reader.h"

#include <charconv>

#include <fmt/format.h>

namespace wedge::test {

using graph::reads;
using graph::tallies;
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

graph::Argument sampling(const FrameBuilder& f)
{
    return value("sampling", static_cast<std::uint32_t>(f.settings.lightSampling));
}

/// As many samples as a term has.
void ofPixels(FrameBuilder& f, graph::Handle<Radiance>* own)
{
    render::Totals& t = f.totals;
    auto rays = f.graph.plane<render::Count>("rays of the sky", graph::counts);
    f.zero(rays);
    f.trace("sky", kernel,
        render::joined({ f.frame(), sampling(f), value("samples", static_cast<std::uint32_t>(f.settings.spp)) },
            f.hierarchy(), f.receivers(),
            render::Arguments { graph::absent("sampleOf", graph::counts), reads("diffuse", f.surfaces.diffuse),
                reads("specular", f.surfaces.specular), updates("direct", t.direct.filtered),
                updates("directNoisy", t.direct.noisy),
                own != nullptr ? updates("own", *own) : graph::absent("own", graph::vectors), tallies("rays", rays) }),
        false, [spp = f.settings.spp](const graph::Launch&) { return static_cast<double>(spp); });
    f.count(rays, true, t.tallies.rays, &t.rays);
}

/// One sample a receiver.
void ofWaves(FrameBuilder& f, render::Waves& waves, graph::Handle<Radiance>& radiance)
{
    const render::Receivers& r = waves.receivers();
    auto noisy = waves.list<Radiance>("the sky's radiance", graph::vectors); // the same once more
    f.zero(noisy);
    waves.tiles("sky", kernel,
        render::joined({ waves.receiverParams(), sampling(f), value("samples", 1u) }, f.hierarchy(),
            waves.receiverArguments(),
            render::Arguments { reads("sampleOf", r.sampleOf), reads("diffuse", r.diffuse),
                reads("specular", r.specular), updates("direct", radiance), updates("directNoisy", noisy),
                graph::absent("own", graph::vectors), waves.tallyRays() }),
        false);
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
        return render::Unfiltered { .name = "sky",
            .layer = "sky",
            .workUnits = static_cast<double>(settings.spp),
            .ofPixels = ofPixels,
            .ofWaves = ofWaves };
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
