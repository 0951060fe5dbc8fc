#include "benchmarks/subjects/whole_image.h"

#include "benchmarks/common/variants.h"
#include "benchmarks/harness/scene_result.h"
#include "benchmarks/harness/tables.h"

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

using render::FrameStatistics;
using render::Sampler;

constexpr int memorySide = 1024; // pixels, of the frame whose memory has a goal

double rays(const FrameStatistics& frame)
{
    return static_cast<double>(frame.primaryRays + frame.shadowRays + frame.indirectRays);
}

/// All that is not tracing, what the host does between passes included, by the host's clock.
double wallOverhead(const FrameStatistics& f)
{
    return 1.0 - f.milliseconds(device::PassKind::Trace) / f.wallMilliseconds;
}

Json orNull(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json planData(const MeasurePlan& plan)
{
    const bool same = plan.timedWidth == 0;
    return { { "timed_width", same ? plan.width : plan.timedWidth },
        { "timed_height", same ? plan.height : plan.timedHeight }, { "budgets", plan.budgets },
        { "published_mu", plan.publishedMu } };
}

Json sceneData(const SceneResult& result)
{
    const Case& of = result.settings.front().of;
    return { { "bounces", *of.bounces }, { "paper", of.paper.row },
        { "rays_saved_goal", orNull(numberOf(result.source.goals, "rays_saved")) },
        { "rays_saved_aim", orNull(result.source.aim) }, { "memory_bytes", result.memoryBytes } };
}

Json settingData(const CaseSetting& setting)
{
    return { { "setting", settingName(setting.published) }, { "rays_per_pixel", number(setting.raysPerPixel) } };
}

/// Those of Table 5.2 and what they are made of.
std::vector<TimingColumn> columns()
{
    return withFrameColumns({
        { "rays", rays },
        tracing(),
        ofPasses("lists", { "lists" }),
        ofPasses("accumulate", { "accumulate" }),
        ofPasses("widths", { "widths" }),
        ofPasses("counts", { "counts", "pixels gathered" }),
        widthsAndCounts(),
        ofPasses("filter_lens_and_shutter", { "filter of lens and shutter" }),
        { "overhead_wall_fraction", wallOverhead },
    });
}

} // namespace

Integrand WholeImage::integrandOf(const render::Settings& settings) const
{
    render::Settings reference = plain(Sampler::Sobol, referenceSpp_);
    reference.bounces = settings.bounces;
    return { "whole image", reference };
}

double WholeImage::raysOf(const FrameStatistics& frame) const { return rays(frame); }

std::string WholeImage::describe(const render::Settings& s) const
{
    if (s.method == render::Method::MonteCarlo) {
        return fmt::format("unfiltered {}", s.sampler == Sampler::Sobol ? "sobol" : "stratified");
    }
    const char* factoring = s.distributed.factoring == render::Factoring::Never ? " not factored" : "";
    return describeVariant(s, muOf(s), s.distributed.countExponent > 0) + factoring;
}

Paper paperOf(const PaperFrame& p)
{
    Paper out { { { "triangles", orNull(p.triangles) }, { "rays_per_pixel", p.raysPerPixel },
                    { "overhead_fraction", orNull(p.overhead) }, { "seconds", orNull(p.seconds) },
                    { "rays_saved", orNull(p.raysSaved) } },
        { { "rays_per_pixel", p.raysPerPixel } } };
    if (p.overhead) {
        out.claims.emplace_back("overhead", *p.overhead);
    }
    if (p.seconds) {
        out.claims.emplace_back("total_ms", 1e3 * *p.seconds);
    }
    if (p.raysSaved) {
        out.claims.emplace_back("rays_saved", *p.raysSaved);
    }
    return out;
}

Benchmark wholeImages(std::string program, std::string about, std::shared_ptr<Subject> (*subject)(const MeasurePlan&))
{
    return {
        .program = std::move(program),
        .about = std::move(about),
        .table = "Table 5.2",
        .quickMeans = "160x160 and fewer points: a look",
        // Unfiltered: squares, for strata, and powers of two, at which Sobol points are at their best.
        .plan = { .width = 512,
            .height = 512,
            .timedWidth = 1024,
            .timedHeight = 1024,
            .frames = 3,
            .seeds = 2,
            .referenceSpp = 1024,
            .largestBaseline = 576,
            .subtractNoise = true,
            .baselineSpp = { 4, 16, 64, 256 },
            .budgets = { 16, 64, 128 },
            .publishedMu = { 0.5f, 1, 2, 3 } },
        .quick = { .width = 160,
            .height = 160,
            .frames = 3,
            .seeds = 2,
            .referenceSpp = 256,
            .largestBaseline = 144,
            .subtractNoise = true,
            .baselineSpp = { 4, 16, 64 },
            .budgets = { 16, 64 },
            .publishedMu = { 1, 2 } },
        .planData = planData,
        .subject = subject,
        .fileScene = { {}, { { .bounces = {} } }, {}, false, false, {} },
        .goals = { { "first_frame*", 1.1 }, { "rays_saved_vs_sobol", 3 }, { "error_falls", 1 },
            { "memory_bytes", 150e6 } },
        .baselines = { { "stratified", "unfiltered, stratified", Sampler::Stratified },
            { "sobol", "unfiltered, Owen-scrambled Sobol", Sampler::Sobol } },
        .variants = { { "default", "the default setting" },
            { "published", "as published, by mu", VariantRow::OfPublished },
            { "no_factoring", "default, texture and irradiance never taken apart", VariantRow::OfDefault,
                [](render::Settings& s) { s.distributed.factoring = render::Factoring::Never; } },
            { "uniform_counts", "default, equal counts everywhere", VariantRow::OfDefault,
                [](render::Settings& s) { s.distributed.countExponent = 0.0f; } },
            { "fixed_blur", "unfiltered, Owen-scrambled Sobol, then the best single Gaussian",
                VariantRow::ImageBlur } },
        .memorySide = memorySide,
        .columns = columns(),
        .times = { { "triangles", 10, "triangles", wholeNumber, "triangles" },
            { "rays/px", 10, "rays_per_pixel", wholeNumber, "rays_per_pixel" },
            { "sampling", 10, "tracing", secondsOf, "" }, { "filter", 10, "overhead", secondsOf, "" },
            { "total", 10, "total", secondsOf, "total_ms" },
            { "overhead", 10, "overhead_fraction", percent, "overhead_fraction" }, { "wall", 9, "wall", secondsOf, "" },
            { "ovh wall", 10, "overhead_wall_fraction", percent, "" }, { "Mrays/s", 10, "mrays_s", hundredths, "" } },
        .timeClaims = { { "overhead_wall", "overhead_wall_fraction", "1" } },
        .byRays = true,
        .sceneData = sceneData,
        .settingData = settingData,
    };
}

} // namespace wedge::benchmark
