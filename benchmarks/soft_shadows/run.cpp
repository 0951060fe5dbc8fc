#include "benchmarks/soft_shadows/run.h"

#include "host/error.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

SettingResult measureSetting(Lab& lab, bool published)
{
    SettingResult out;
    out.name = published ? "published" : "default";
    out.timing = timeFrames(lab, published ? render::asPublished(publishedMu) : render::axisAligned(defaultSpp));
    if (lab.plan().timingOnly) {
        return out;
    }
    out.method = measureMethod(lab, published);
    for (Baseline& baseline : measureBaselines(lab, out.method)) {
        const Savings saved = savings(out.method, baseline);
        out.baselines.emplace_back(std::move(baseline), saved);
    }
    out.convergence = convergence(lab, published);
    return out;
}

void keepReferences(const Lab& lab, SceneResult& result)
{
    for (const auto& [shading, reference] : lab.references()) {
        Reference summary = reference;
        summary.image = {};
        result.references.emplace(
            shading == render::Shading::Ratio ? "true integral" : "shading apart", std::move(summary));
    }
}

} // namespace

const SettingResult& SceneResult::setting(const std::string& name) const
{
    const auto found = std::ranges::find(settings, name, &SettingResult::name);
    if (found == settings.end()) {
        throw std::out_of_range("no such setting: " + name);
    }
    return *found;
}

SceneResult measureScene(const SceneSource& source, const device::Device& device, const Plan& plan)
{
    const auto start = std::chrono::steady_clock::now();
    SceneResult out;
    out.source = source;
    out.path = source.file();
    const scene::Scene scene = scene::loadScene(out.path);
    if (scene.areaLights.empty()) {
        throw Error("scene " + out.path, "has no area light", "measure one that has soft shadows");
    }
    out.triangles = scene.geometry.indices.size() / 3;
    progress(fmt::format("{}: {} triangles", source.name, out.triangles));
    Lab lab(scene, device, plan, source.name);
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
        keepReferences(lab, out);
    }
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress(fmt::format("{}: done in {:.0f} s", source.name, out.seconds));
    return out;
}

} // namespace wedge::benchmark
