#include "benchmarks/harness/measure.h"

#include "benchmarks/common/variants.h"
#include "benchmarks/frame_memory/frame_bytes.h"
#include "benchmarks/harness/curves.h"
#include "host/error.h"

#include <algorithm>
#include <chrono>
#include <iterator>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

void measureTimes(const Benchmark& benchmark, Lab& lab, CaseSetting& out)
{
    const render::Settings settings = usualSettings(benchmark, out.of, out.published);
    out.timing = timeFrames(lab, settings, benchmark.columns, settingName(out.published) + out.of.label);
    if (benchmark.byRays) {
        out.raysPerPixel = out.timing["rays"].median / timedPixels(lab.plan());
    }
}

void measureErrors(const Benchmark& benchmark, Lab& lab, CaseSetting& out)
{
    const render::Settings settings = usualSettings(benchmark, out.of, out.published);
    out.method = measureMethod(lab, settingName(out.published), settings);
    out.noise = lab.reference(settings).noise;
    for (const BaselineRow& row : benchmark.baselines) {
        if (out.published ? row.ofPublished : row.ofDefault) {
            const auto unfiltered = [&](int spp) { return baselineSettings(row, out.of, spp); };
            out.baselines.push_back(compareWith(lab, out.method, row.name, row.meaning, unfiltered));
        }
    }
    out.convergence = convergence(lab, out.of, out.published);
    if (benchmark.fixedWidth && !out.published) {
        out.fixedWidth = bestFixedWidth(lab, *benchmark.fixedWidth, settings);
    }
    if (benchmark.blurWidth && !out.published) {
        out.blur = measureMethod(lab, "blur", fixed(settings, *benchmark.blurWidth));
    }
    if (benchmark.rival && out.published) {
        render::Settings changed = settings;
        benchmark.rival->change(changed);
        out.rival = measureMethod(lab, benchmark.rival->name, changed);
    }
    const std::vector<bool>& region = lab.region(settings);
    out.regionFraction = region.empty()
        ? 0.0
        : static_cast<double>(std::ranges::count(region, true)) / static_cast<double>(region.size());
    if (out.timing.columns.empty()) {
        out.raysPerPixel = out.method.runs.front().rays;
    }
}

/// Curves and biases, of the first case.
void measureVariants(const Benchmark& benchmark, Lab& lab, SceneResult& out)
{
    const Case& of = out.settings.front().of;
    for (const bool published : { false, true }) {
        if (out.source.curves) {
            const std::vector<Measured>& plain = out.settings[published ? 1 : 0].baselines.front().baseline.points;
            std::ranges::move(ablations(lab, benchmark, of, published, plain), std::back_inserter(out.curves));
        }
        for (const float mu : out.source.bias ? std::vector { 1.0f, 2.0f } : std::vector<float> {}) {
            out.biases.push_back(measureBias(lab, of, published, mu));
        }
    }
    if (!benchmark.variants.empty()) {
        out.budgets = budgetsOf(lab.plan(), usualSettings(benchmark, of, false).spp);
        out.curves = variants(lab, benchmark, of, out.budgets);
    }
}

SceneResult started(const Benchmark& benchmark, const BenchmarkScene& source, const scene::Scene& scene)
{
    SceneResult out;
    out.source = source;
    if (source.cases.empty()) {
        out.source = benchmark.fileScene;
        static_cast<SceneSource&>(out.source) = source;
    }
    out.triangles = scene.geometry.indices.size() / 3;
    for (const Case& listed : out.source.cases) {
        for (const bool published : { false, true }) {
            CaseSetting& setting = out.settings.emplace_back();
            setting.of = listed;
            setting.of.bounces = listed.bounces ? listed.bounces : scene.settings.bounces.value_or(0);
            setting.published = published;
            setting.triangles = out.triangles;
        }
    }
    return out;
}

} // namespace

SceneResult measureScene(
    const Benchmark& benchmark, const BenchmarkScene& source, const device::Device& device, const MeasurePlan& plan)
{
    const auto start = std::chrono::steady_clock::now();
    const std::string path = source.file();
    const scene::Scene scene = scene::loadScene(path);
    if (benchmark.needsAreaLight && scene.areaLights.empty()) {
        throw Error("scene " + path, "has no area light", "measure one that has soft shadows");
    }
    SceneResult out = started(benchmark, source, scene);
    const std::shared_ptr<Subject> subject = benchmark.subject(plan);
    Lab lab(scene, device, *subject, plan, source.name);
    lab.say(fmt::format("{} triangles", out.triangles));
    const Case& first = out.settings.front().of;
    if (benchmark.memorySide) {
        render::Settings frame = usualSettings(benchmark, first, false);
        frame.width = frame.height = *benchmark.memorySide;
        out.memoryBytes = frameBytes(scene, device.info(), frame);
    }
    for (CaseSetting& setting : out.settings) {
        if (!plan.errorsOnly) {
            measureTimes(benchmark, lab, setting);
        }
        if (!plan.timingOnly && setting.of.errors) {
            measureErrors(benchmark, lab, setting);
        }
    }
    if (!plan.timingOnly) {
        measureVariants(benchmark, lab, out);
        out.references = summaries(lab.references());
    }
    if (!plan.maps.empty()) {
        out.maps = writeMaps(lab, usualSettings(benchmark, first, false), plan.maps);
    }
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    lab.say(fmt::format("done in {:.0f} s", out.seconds));
    return out;
}

} // namespace wedge::benchmark
