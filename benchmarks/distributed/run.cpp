#include "benchmarks/distributed/run.h"

#include "benchmarks/distributed/frame_memory.h"

#include <chrono>
#include <stdexcept>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

using render::Sampler;

constexpr int memorySide = 1024; // pixels, of the frame whose memory has a goal

render::Settings settingsOf(const WholeImage& subject, const SettingResult& setting)
{
    return setting.name == "published" ? subject.published() : subject.usual();
}

/// Times of Table 5.2, at its size; maps where there are no errors to measure.
void measureTimes(
    const scene::Scene& scene, const device::Device& device, const DistributedPlan& plan, DistributedResult& out)
{
    MeasurePlan timed = plan;
    timed.width = plan.timedWidth;
    timed.height = plan.timedHeight;
    const WholeImage subject(out.program, timed, out.bounces);
    Lab lab(scene, device, subject, timed, out.source.name);
    for (std::size_t i = 0; i < out.settings.size(); ++i) {
        SettingResult& setting = out.settings[i];
        setting.timing = timeFrames(lab, settingsOf(subject, setting), distributedColumns(), setting.name);
        out.raysPerPixel[i] = setting.timing["rays"].median / (static_cast<double>(timed.width) * timed.height);
    }
    if (plan.timingOnly && !plan.maps.empty()) {
        out.maps = writeMaps(lab, subject.usual(), plan.maps);
    }
}

void measureErrors(
    const scene::Scene& scene, const device::Device& device, const DistributedPlan& plan, DistributedResult& out)
{
    const WholeImage subject(out.program, plan, out.bounces);
    Lab lab(scene, device, subject, plan, out.source.name);
    for (std::size_t i = 0; i < out.settings.size(); ++i) {
        SettingResult& setting = out.settings[i];
        setting.method = measureMethod(lab, setting.name, settingsOf(subject, setting));
        const auto compare = [&](const char* name, const char* meaning, Sampler sampler) {
            const auto unfiltered = [&](int spp) { return subject.unfiltered(sampler, spp); };
            setting.baselines.push_back(compareWith(lab, setting.method, name, meaning, unfiltered));
        };
        compare("stratified", "unfiltered, stratified", Sampler::Stratified);
        compare("sobol", "unfiltered, Owen-scrambled Sobol", Sampler::Sobol);
        if (setting.timing.columns.empty()) {
            out.raysPerPixel[i] = setting.method.runs.front().rays;
        }
    }
    out.budgets = budgetsOf(subject, plan);
    out.curves = measureVariants(lab, subject, plan);
    out.references = summaries(lab.references());
    if (!plan.maps.empty()) {
        out.maps = writeMaps(lab, subject.usual(), plan.maps);
    }
}

} // namespace

double DistributedResult::noise() const { return references.empty() ? 0.0 : references.begin()->second.noise; }

const VariantCurve& DistributedResult::curve(const std::string& name) const
{
    for (const VariantCurve& curve : curves) {
        if (curve.name == name) {
            return curve;
        }
    }
    throw std::out_of_range("no such curve: " + name);
}

DistributedResult measureScene(const std::string& program, const DistributedScene& source, const device::Device& device,
    const DistributedPlan& plan)
{
    const auto start = std::chrono::steady_clock::now();
    DistributedResult out;
    out.source = source;
    out.program = program;
    const scene::Scene scene = scene::loadScene(source.file());
    out.triangles = scene.geometry.indices.size() / 3;
    out.bounces = scene.settings.bounces.value_or(0);
    progress(program, fmt::format("{}: {} triangles, {} bounces", source.name, out.triangles, out.bounces));
    const WholeImage subject(program, plan, out.bounces);
    out.usualSpp = subject.usual().spp;
    out.settings = { { "default", {}, {}, {} }, { "published", {}, {}, {} } };
    out.raysPerPixel.resize(out.settings.size());
    render::Settings frame = subject.usual();
    frame.width = frame.height = memorySide;
    out.memoryBytes = frameBytes(scene, device.info(), frame);
    if (!plan.errorsOnly) {
        measureTimes(scene, device, plan, out);
    }
    if (!plan.timingOnly) {
        measureErrors(scene, device, plan, out);
    }
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress(program, fmt::format("{}: done in {:.0f} s", source.name, out.seconds));
    return out;
}

} // namespace wedge::benchmark
