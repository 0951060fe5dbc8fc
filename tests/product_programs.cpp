#include "tests/product_programs.h"

#include "filters/temporal/temporal.h"
#include "host/error.h"
#include "host/render/renderer.h"
#include "host/scene/scene.h"
#include "kernels/embedded_kernels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

namespace wedge::test {
namespace {

using render::Settings;

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
    add(3, [](Settings& s) {
        s.maaf = render::Maaf::Refitted;
        s.components = 3;
    });
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

/// False: no more.
bool ofFrames(const render::Renderer& renderer, const std::function<bool(const ProductProgram&)>& visit)
{
    for (Settings settings : manySettings()) {
        settings.width = settings.height = 16;
        if (!allows(renderer.scene(), settings)) {
            continue;
        }
        for (const bool layers : { true, false }) {
            for (const device::ProgramSource& source : renderer.programs(settings, layers)) {
                if (!visit({ renderer.programOptions(), source })) {
                    return false;
                }
            }
        }
    }
    return true;
}

/// The same of two frames each with the filter over time, whose passes are declared when they are run.
bool overTime(const device::Device& device, const std::function<bool(const ProductProgram&)>& visit)
{
    render::Renderer renderer(scene::loadScene(WEDGE_SOURCE_DATA "/scenes/penumbra.toml"), device);
    for (const render::Temporal temporal : { render::Temporal::On, render::Temporal::Published }) {
        for (const int bounces : { 1, 0 }) {
            filters::TemporalFilter filter(device);
            Settings settings = render::axisAligned(16);
            settings.width = settings.height = 8;
            settings.bounces = bounces;
            settings.temporal = temporal;
            for (std::uint32_t frame = 0; frame < 2; ++frame) {
                settings.frame = frame;
                render::FrameStatistics statistics = renderer.render(settings, {}, true);
                filter.filter(renderer, settings, nullptr, statistics);
            }
        }
    }
    for (const device::ProgramSource& source : renderer.kernels().programs()) {
        if (!visit({ renderer.programOptions(), source })) {
            return false;
        }
    }
    return true;
}

} // namespace

void everyProgram(const device::Device& device, const std::function<bool(const ProductProgram&)>& visit)
{
    for (const char* name : { "penumbra", "materials", "motion", "sky", "mirrors" }) {
        const scene::Scene scene = scene::loadScene(fmt::format("{}/scenes/{}.toml", WEDGE_SOURCE_DATA, name));
        for (const render::Traversal family : { render::Traversal::Wide, render::Traversal::Scalar }) {
            render::Options options;
            options.traversal = family;
            if (!ofFrames(render::Renderer(scene, device, options), visit)) {
                return;
            }
        }
    }
    overTime(device, visit);
}

device::ProgramSource productProgram(const device::Device& device, const std::string& file, const std::string& kernel)
{
    static std::map<std::pair<std::string, std::string>, std::string> known; // the same on all devices
    device::ProgramSource out(file);
    const std::pair wanted(file, "pass/" + kernel + ".h");
    const auto embedded = embeddedKernels();
    if (std::ranges::none_of(embedded, [&](const EmbeddedKernel& each) { return each.path == file; })) {
        return out;
    }
    if (!known.contains(wanted)) {
        everyProgram(device, [&](const ProductProgram& program) {
            for (const auto& [interface, text] : program.source.generated) {
                known.emplace(std::pair(program.source.file, interface), text);
            }
            return !known.contains(wanted);
        });
    }
    if (const auto found = known.find(wanted); found != known.end()) {
        out.generated.emplace(wanted.second, found->second);
    }
    return out;
}

} // namespace wedge::test
