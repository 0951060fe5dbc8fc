#include "tests/product_programs.h"

#include "filters/temporal/temporal.h"
#include "host/error.h"
#include "host/render/renderer.h"
#include "host/scene/scene.h"

#include <fmt/format.h>

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
    add(0, [](Settings& s) { s.sampling = render::Sampling::Uniform, s.filtering = render::Filtering::Fixed; });
    add(0, [](Settings& s) { s.environment.widths = render::EnvironmentWidths::Corrected; });
    add(1, [](Settings& s) { s.environment.sampling = render::EnvironmentSampling::Precomputed; });
    add(3, [](Settings& s) { s.maaf = render::Maaf::Refitted, s.components = 3; });
    return out;
}

/// False: no more.
bool ofFrames(const render::Renderer& renderer, const std::function<bool(const ProductProgram&)>& visit)
{
    for (Settings settings : manySettings()) {
        settings.width = settings.height = 16;
        for (const bool layers : { true, false }) {
            try {
                for (const device::ProgramSource& source : renderer.programs(settings, layers)) {
                    if (!visit({ renderer.programOptions(), source })) {
                        return false;
                    }
                }
            } catch (const Error&) {
                break; // no frames of that kind of this scene
            }
        }
    }
    return true;
}

/// The same of two frames with the filter over time, whose passes are declared when they are run.
bool overTime(const device::Device& device, const std::function<bool(const ProductProgram&)>& visit)
{
    render::Renderer renderer(scene::loadScene(WEDGE_SOURCE_DATA "/scenes/penumbra.toml"), device);
    filters::TemporalFilter filter(device);
    for (const render::Temporal temporal : { render::Temporal::On, render::Temporal::Published }) {
        Settings settings = render::axisAligned(16);
        settings.width = settings.height = 8;
        settings.bounces = 1;
        settings.temporal = temporal;
        render::Renderer& r = renderer;
        for (std::uint32_t frame = 0; frame < 2; ++frame) {
            settings.frame = frame;
            render::FrameStatistics statistics = r.render(settings, {}, true);
            filter.filter(r, settings, nullptr, statistics);
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
    static std::map<std::pair<std::string, std::string>, device::ProgramSource> known;
    const std::pair key(file, kernel);
    if (const auto found = known.find(key); found != known.end()) {
        return found->second;
    }
    device::ProgramSource out(file);
    const std::string name = "pass/" + kernel + ".h";
    everyProgram(device, [&](const ProductProgram& program) {
        const bool has = program.source.file == file && program.source.generated.contains(name);
        if (has) {
            out.generated.emplace(name, program.source.generated.at(name));
        }
        return !has;
    });
    return known.emplace(key, out).first->second;
}

} // namespace wedge::test
