#include "benchmarks/indirect/run.h"

#include "benchmarks/common/timing.h"
#include "benchmarks/indirect/indirect_light.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

using render::Sampler;

IndirectSetting measureSetting(Lab& lab, const BounceCase& paths, bool published)
{
    const render::Settings settings = methodSettings(published, paths);
    IndirectSetting out;
    out.name = published ? "published" : "default";
    out.bounces = paths.bounces;
    out.timing =
        timeFrames(lab, settings, indirectColumns(), fmt::format("{}, {},", out.name, integrandName(paths.bounces)));
    if (lab.plan().timingOnly || !paths.errors) {
        return out;
    }
    out.method = measureMethod(lab, out.name, settings);
    const auto compare = [&](const char* name, const char* meaning, Sampler sampler) {
        const auto settingsOf = [&paths, sampler](int spp) { return unfiltered(sampler, spp, paths); };
        out.baselines.push_back(compareWith(lab, out.method, name, meaning, settingsOf));
    };
    compare("stratified", "path tracing, stratified", Sampler::Stratified);
    compare("sobol", "path tracing, Owen-scrambled Sobol", Sampler::Sobol);
    if (!published && paths.bounces <= 1) {
        out.fixedBlur = bestUniformBlur(lab, settings);
    }
    return out;
}

/// Curves and biases, of one bounce.
void measureVariants(Lab& lab, const Plan& plan, SceneResult& out)
{
    for (const bool published : { false, true }) {
        if (out.source.curves) {
            const IndirectSetting& usual = out.setting(published ? "published" : "default", 1);
            const std::vector<Measured>& plain = usual.baselines.front().baseline.points;
            std::ranges::move(filterCurves(lab, plan, published, plain), std::back_inserter(out.series));
        }
        if (out.source.bias) {
            for (const float mu : { 1.0f, 2.0f }) {
                out.biases.push_back(measureBias(lab, published, mu, plan.biasSeeds));
            }
        }
    }
}

} // namespace

const IndirectSetting& SceneResult::setting(const std::string& name, int bounces) const
{
    for (const IndirectSetting& setting : settings) {
        if (setting.name == name && setting.bounces == bounces) {
            return setting;
        }
    }
    throw std::out_of_range("no such setting: " + name);
}

double SceneResult::noiseOf(int bounces) const
{
    const auto found = references.find(integrandName(bounces));
    return found == references.end() ? 0.0 : found->second.noise;
}

SceneResult measureScene(const IndirectScene& source, const device::Device& device, const Plan& plan)
{
    const auto start = std::chrono::steady_clock::now();
    SceneResult out;
    out.source = source;
    const scene::Scene scene = scene::loadScene(source.file());
    out.triangles = scene.geometry.indices.size() / 3;
    const IndirectLight subject(plan.referenceSpp);
    Lab lab(scene, device, subject, plan, source.name);
    lab.say(fmt::format("{} triangles", out.triangles));
    for (const BounceCase& paths : source.cases) {
        for (const bool published : { false, true }) {
            out.settings.push_back(measureSetting(lab, paths, published));
        }
    }
    if (!plan.timingOnly) {
        measureVariants(lab, plan, out);
        out.references = summaries(lab.references());
    }
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    lab.say(fmt::format("done in {:.0f} s", out.seconds));
    return out;
}

} // namespace wedge::benchmark
