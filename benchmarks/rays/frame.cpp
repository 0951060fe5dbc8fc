#include "benchmarks/rays/frame.h"

#include "benchmarks/common/references.h"
#include "benchmarks/rays/embree_frame.h"
#include "host/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace wedge::benchmark {
namespace {

constexpr double differs = 1e-3;

/// The scene without what no ray meets and Embree's frame leaves out: lights that are seen, and materials of no
/// triangle.
scene::Scene stripped(scene::Scene scene)
{
    for (scene::AreaLight& light : scene.areaLights)
        light.visible = false;
    std::vector<bool> used(scene.materials.size());
    for (const std::uint32_t material : scene.geometry.materialIds)
        used[material] = true;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (!used[i])
            scene.materials[i] = scene::Material {};
    return scene;
}

void compareImages(FrameResult& out, const std::vector<float>& ours, const std::vector<float>& theirs)
{
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        squares += (double { ours[i] } - theirs[i]) * (double { ours[i] } - theirs[i]);
        sum += ours[i];
    }
    const double n = static_cast<double>(std::max<std::size_t>(1, ours.size()));
    out.rmse = std::sqrt(squares / n);
    out.mean = sum / n;
    for (std::size_t i = 0; i + 2 < ours.size(); i += 3) {
        double most = 0;
        for (std::size_t k = i; k < i + 3; ++k)
            most = std::max(most, std::fabs(double { ours[k] } - theirs[k]));
        out.differentPixels += most > differs * out.mean ? 1 : 0;
    }
}

} // namespace

std::vector<double> FrameResult::ratios(const std::string& theirs) const
{
    const auto found = std::ranges::find(runs, theirs, &Runs::name);
    if (found == runs.end())
        throw std::out_of_range("no such column: " + theirs);
    std::vector<double> out;
    for (std::size_t i = 0; i < found->seconds.size(); ++i)
        out.push_back(found->seconds[i] / ourSeconds()[i]);
    return out;
}

std::string frameProblem(const scene::Scene& original)
{
    const scene::Scene scene = stripped(original);
    if (scene.areaLights.empty())
        return "it has no area light";
    if (!scene.pointLights.empty() || !scene.directionalLights.empty())
        return "it has point or directional lights";
    return mattAndUntextured(scene) ? "" : "its materials are not all matt and untextured";
}

FrameResult measureFrame(const scene::Scene& original, const WedgeTracer& tracer, const BuiltScene& built,
    Workers& workers, const RayPlan& plan)
{
    const scene::Scene scene = stripped(original);
    render::Settings settings = render::monteCarlo(plan.shadowSamples);
    settings.width = plan.width;
    settings.height = plan.height;
    settings.seed = 1;
    settings.lightSampling = render::LightSampling::Lights; // as the frame beside it does
    render::Options options;
    options.traversal = tracer.traversal();
    render::Renderer renderer(scene, tracer.device(), options);
    renderer.rehearse(settings);
    EmbreeFrame single(scene, plan.width, plan.height, plan.shadowSamples, settings.seed);
    EmbreeFrame packets(scene, plan.width, plan.height, plan.shadowSamples, settings.seed);
    FrameResult out;
    out.cpuTime = plan.timing.cpuTime;
    render::FrameStatistics last;
    out.runs = timeInterleaved(
        {
            { "wedge frame", true,
                [&] {
                    last = renderer.render(settings);
                    out.deviceSeconds.push_back(1e-3 * last.deviceMilliseconds);
                } },
            { "embree frame single", false, [&] { single.render(built.embree("default"), false, workers); } },
            { "embree frame packets high", false, [&] { packets.render(built.embree("high"), true, workers); } },
        },
        plan.timing);
    out.deviceSeconds.erase(out.deviceSeconds.begin()); // the untimed one
    compareImages(out, imageOf(renderer, settings, last).rgb, single.rgb());
    return out;
}

} // namespace wedge::benchmark
