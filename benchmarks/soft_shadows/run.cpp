#include "benchmarks/soft_shadows/run.h"

#include "host/error.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

ShadowSetting measureSetting(ShadowLab& lab, bool published)
{
    const render::Settings settings = published ? render::asPublished(publishedMu) : render::axisAligned(defaultSpp);
    ShadowSetting out;
    out.name = published ? "published" : "default";
    out.timing = timeFrames(lab, settings, shadowColumns(), out.name);
    if (lab.plan().timingOnly) {
        return out;
    }
    out.method = measureMethod(lab, out.name, settings);
    out.baselines = compareWithBaselines(lab, out.method);
    out.convergence = convergence(lab, published);
    return out;
}

} // namespace

const ShadowSetting& SceneResult::setting(const std::string& name) const
{
    const auto found = std::ranges::find(settings, name, &ShadowSetting::name);
    if (found == settings.end()) {
        throw std::out_of_range("no such setting: " + name);
    }
    return *found;
}

double SceneResult::noiseOf(const std::string& setting) const
{
    const auto found = references.find(integrandName(setting == "published"));
    return found == references.end() ? 0.0 : found->second.noise;
}

SceneResult measureScene(const ShadowScene& source, const device::Device& device, const Plan& plan)
{
    const auto start = std::chrono::steady_clock::now();
    SceneResult out;
    out.source = source;
    const std::string path = source.file();
    const scene::Scene scene = scene::loadScene(path);
    if (scene.areaLights.empty()) {
        throw Error("scene " + path, "has no area light", "measure one that has soft shadows");
    }
    out.triangles = scene.geometry.indices.size() / 3;
    const SoftShadows subject(plan.referenceSpp);
    ShadowLab lab(scene, device, subject, plan, source.name);
    lab.say(fmt::format("{} triangles", out.triangles));
    for (const bool published : { false, true }) {
        out.settings.push_back(measureSetting(lab, published));
    }
    if (!plan.timingOnly) {
        out.fixedBlur = bestFixedBlur(lab);
        for (const bool published : { false, true }) {
            if (source.curves) {
                std::ranges::move(ablations(lab, published), std::back_inserter(out.series));
            }
        }
        out.references = summaries(lab.references());
    }
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    lab.say(fmt::format("done in {:.0f} s", out.seconds));
    return out;
}

} // namespace wedge::benchmark
