#include "tests/product_programs.h"

#include "filters/temporal/temporal.h"
#include "host/error.h"
#include "host/render/distributed_frame.h"
#include "host/render/filter_call.h"
#include "host/render/filter_chain.h"
#include "host/render/pixel_frame.h"
#include "host/render/progressive.h"
#include "host/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace wedge::test {
namespace {

using render::Settings;

/// With its defaults, but for a colour, which has no pass with those, and a spread, which most filters have none of.
render::ChosenFilter chosen(const render::Filter& filter)
{
    render::ChosenFilter out { filter.name(), {} };
    for (const render::FilterParameter& parameter : filter.parameters()) {
        const float other = parameter.name == "red" ? 0.5f : 1.0f;
        const bool standard = parameter.name != "red" && parameter.name != "spread";
        out.values.push_back(standard ? parameter.standard : other);
    }
    return out;
}

/// All of that stage that are registered.
std::vector<render::ChosenFilter> everyImageFilter()
{
    std::vector<render::ChosenFilter> out;
    for (const auto& filter : render::registeredFilters()) {
        if (filter->stage() == render::Stage::Image) {
            out.push_back(chosen(*filter));
        }
    }
    return out;
}

/// Of every kind that reports tell apart; which of them a scene allows is found by trying.
std::vector<Settings> manySettings()
{
    std::vector<Settings> out = { render::axisAligned(16), render::monteCarlo(2), render::asPublished(),
        render::multipleAxisAligned(render::Maaf::TwoSlope, 16),
        render::multipleAxisAligned(render::Maaf::Refitted, 16),
        render::multipleAxisAligned(render::Maaf::Printed, 16) };
    for (std::size_t i = 0, plain = out.size(); i < plain; ++i) {
        Settings bounced = out[i];
        bounced.bounces = 2;
        out.push_back(bounced);
    }
    const auto add = [&out](std::size_t like, const auto& change) {
        Settings settings = out[like];
        change(settings);
        out.push_back(settings);
    };
    for (const std::size_t like : { 6u, 7u, 8u, 0u }) {
        add(like, [](Settings& s) { s.antialias = true; });
        add(like, [](Settings& s) { s.progressive = true; });
    }
    add(0, [](Settings& s) { s.integrator = render::Integrator::AmbientOcclusion; });
    add(0, [](Settings& s) {
        s.sampling = render::Sampling::Uniform;
        s.filtering = render::Filtering::Fixed;
    });
    add(0, [](Settings& s) { s.environment.widths = render::EnvironmentWidths::Corrected; });
    add(1, [](Settings& s) { s.environment.sampling = render::EnvironmentSampling::Precomputed; });
    add(0, [](Settings& s) { s.environment.shadows.shadows = render::Shadows::Subtractive; });
    add(1, [](Settings& s) { s.environment.shadows.shadows = render::Shadows::Ratio; });
    add(1, [](Settings& s) {
        s.environment.shadows.shadows = render::Shadows::Ratio;
        s.environment.shadows.whole = render::WholeLight::Prefiltered;
    });
    add(1, [](Settings& s) {
        s.environment.shadows.shadows = render::Shadows::Ratio;
        s.environment.shadows.whole = render::WholeLight::Cache;
    });
    for (const std::size_t like : { 0u, 1u }) {
        add(like, [](Settings& s) {
            s.environment.shadows.shadows = render::Shadows::Ratio;
            s.environment.shadows.chosen = 4;
            s.environment.shadows.blockSide = 4;
        });
    }
    add(3, [](Settings& s) {
        s.maaf = render::Maaf::Refitted;
        s.components = 3;
    });
    add(1, [](Settings& s) { s.filters = everyImageFilter(); });
    // Filters of terms, and of parts of the image.
    for (const std::size_t like : { 6u, 7u }) {
        for (const bool antialias : { false, true }) {
            add(like, [&](Settings& s) {
                s.antialias = antialias;
                s.filters = { { "box", { 1 }, { "indirectDiffuse", "environment" } }, { "box", { 1 }, { "direct" } } };
            });
        }
    }
    add(7, [](Settings& s) { s.filters = { render::filterCall("filter", "path-density:rgb=1") }; });
    for (const auto& filter : render::registeredFilters()) {
        if (filter->stage() == render::Stage::Samples) {
            add(6, [&](Settings& s) { s.filters = { chosen(*filter) }; }); // bounced, filtered
            add(7, [&](Settings& s) { s.filters = { chosen(*filter) }; }); // and plain
            if (static_cast<const render::SampleFilter&>(*filter).kernelOfBins()) {
                for (const int kind : { 6, 7 }) {
                    add(kind, [&](Settings& s) {
                        s.filters = { chosen(*filter) };
                        s.antialias = true;
                    });
                }
            }
        }
    }
    return out;
}

/// Whether the scene has frames of that kind.
bool allows(const render::PreparedScene& scene, const Settings& settings)
{
    try {
        render::validate(settings, render::isDistributed(settings, scene));
        return true;
    } catch (const Error&) {
        return false;
    }
}

using OfFrame = std::function<bool(render::Renderer&, const Settings&, bool layers)>;

/// Calls visit() for frames of many kinds of the scene; false: no more.
bool ofFrames(render::Renderer& renderer, const OfFrame& visit)
{
    for (Settings settings : manySettings()) {
        settings.width = settings.height = 16;
        if (!allows(renderer.scene(), settings)) {
            continue;
        }
        if (!visit(renderer, settings, true) || !visit(renderer, settings, false)) {
            return false;
        }
    }
    return true;
}

/// The same of frames whose lights' shadows have a style, which those of several receivers a pixel cannot.
bool ofStyles(const device::Device& device, const OfFrame& visit)
{
    scene::Scene scene = scene::loadScene(WEDGE_SOURCE_DATA "/scenes/styled.toml");
    for (const bool lists : { false, true }) {
        scene::ShadowStyle& style = scene.directionalLights.front().styles.front();
        if (lists) {
            style.abstraction.linear = 0.1f; // by how far away what throws the shadow is
            style.casters = { "fence" };
            style.receivers = { "floor" };
            std::vector<scene::ShadowStyle>& all = scene.directionalLights.front().styles;
            all.push_back(all.front());
            all.back().casters = { "trunk" };
        }
        for (const render::Traversal family : { render::Traversal::Wide, render::Traversal::Scalar }) {
            render::Options options;
            options.traversal = family;
            render::Renderer renderer(scene, device, options);
            // The other times with keys.
            std::vector<scene::ShadowStyle>& styles = scene.directionalLights.front().styles;
            styles.front().keys = { styles.front() };
            Settings settings = render::monteCarlo(1);
            settings.width = settings.height = 16;
            if (!visit(renderer, settings, true) || !visit(renderer, settings, false)) {
                return false;
            }
        }
    }
    return true;
}

/// The same of a soft shadow, with and without a lobe.
bool ofSoftStyles(const device::Device& device, const OfFrame& visit)
{
    scene::Scene scene = scene::loadScene(WEDGE_SOURCE_DATA "/scenes/penumbra.toml");
    scene::ShadowStyle style;
    style.inflation = style.softness = style.abstraction = 0.1f;
    scene.areaLights.front().styles = { style };
    for (const bool lists : { false, true }) {
        if (lists) {
            scene.areaLights.front().styles.front().receivers = { "receiver" };
            scene.areaLights.front().styles.front().penumbra = 0;
            for (scene::Material& material : scene.materials) {
                material.specular = glm::vec3(0.2f);
            }
        }
        render::Renderer renderer(scene, device, {});
        Settings settings = render::axisAligned(16);
        settings.width = settings.height = 16;
        if (!visit(renderer, settings, true) || !visit(renderer, settings, false)) {
            return false;
        }
    }
    return true;
}

bool everyFrame(const device::Device& device, const OfFrame& visit)
{
    for (const char* name : { "penumbra", "materials", "motion", "sky", "mirrors" }) {
        const scene::Scene scene = scene::loadScene(fmt::format("{}/scenes/{}.toml", WEDGE_SOURCE_DATA, name));
        for (const render::Traversal family : { render::Traversal::Wide, render::Traversal::Scalar }) {
            render::Options options;
            options.traversal = family;
            render::Renderer renderer(scene, device, options);
            if (!ofFrames(renderer, visit)) {
                return false;
            }
        }
    }
    return ofStyles(device, visit) && ofSoftStyles(device, visit);
}

/// Calls visit() for frames that are filtered over time; one that is not antialiased sees no mirrors.
void overTime(const device::Device& device,
    const std::function<void(const render::Renderer&, const Settings&, render::FrameFilter&)>& visit)
{
    for (const bool antialias : { false, true }) {
        const char* scene = antialias ? "mirrors" : "penumbra";
        render::Renderer renderer(scene::loadScene(fmt::format("{}/scenes/{}.toml", WEDGE_SOURCE_DATA, scene)), device);
        const auto filter = std::make_shared<filters::TemporalFilter>(device);
        renderer.filterFrames(filter);
        for (const render::Temporal temporal : { render::Temporal::On, render::Temporal::Published }) {
            for (const int bounces : { 1, 0 }) {
                Settings settings = render::axisAligned(16);
                settings.width = settings.height = 8;
                settings.bounces = bounces;
                settings.antialias = antialias;
                settings.temporal = temporal;
                visit(renderer, settings, *filter);
            }
        }
    }
}

} // namespace

std::unique_ptr<render::FrameGraph> declareFrame(const render::Renderer& renderer,
    const render::DeviceScene* deviceScene, const Settings& settings, bool keepLayers, render::HalfMemories& memories,
    render::FrameFilter* filter)
{
    const render::PreparedScene& scene = renderer.scene();
    const std::size_t packet = render::packetSize(renderer.traversal());
    render::validate(settings, render::isDistributed(settings, scene));
    if (settings.progressive) {
        const render::StepRange step = render::firstStep(settings);
        return std::make_unique<render::HalvesFrame>(
            scene, deviceScene, settings, packet, keepLayers, memories, step.before, step.spp);
    }
    if (render::isDistributed(settings, scene)) {
        return std::make_unique<render::DistributedFrame>(scene, deviceScene, settings, packet, keepLayers, filter);
    }
    return std::make_unique<render::PixelFrame>(scene, deviceScene, settings, packet, keepLayers, filter);
}

void everyGraph(const device::Device& device, const std::function<void(const graph::Graph&)>& visit)
{
    everyFrame(device, [&](const render::Renderer& renderer, const Settings& settings, bool layers) {
        render::HalfMemories memories { render::SampleMemory(nullptr), render::SampleMemory(nullptr) };
        visit(declareFrame(renderer, nullptr, settings, layers, memories)->graph());
        return true;
    });
    overTime(device, [&](const render::Renderer& renderer, const Settings& settings, render::FrameFilter& filter) {
        render::HalfMemories memories { render::SampleMemory(nullptr), render::SampleMemory(nullptr) };
        visit(declareFrame(renderer, nullptr, settings, false, memories, &filter)->graph());
    });
}

void everyProgram(const device::Device& device, const std::function<bool(const ProductProgram&)>& visit)
{
    const bool more = everyFrame(device, [&](const render::Renderer& renderer, const Settings& settings, bool layers) {
        const std::vector<device::ProgramSource> sources = renderer.programs(settings, layers);
        return std::ranges::all_of(sources, [&](const device::ProgramSource& source) {
            return visit({ renderer.programOptions(), source });
        });
    });
    if (!more) {
        return;
    }
    overTime(device, [&](const render::Renderer& renderer, const Settings& settings, render::FrameFilter&) {
        for (const device::ProgramSource& source : renderer.programs(settings)) {
            visit({ renderer.programOptions(), source });
        }
    });
}

} // namespace wedge::test
