#include "benchmarks/common/image_bias.h"
#include "benchmarks/harness/curves.h"
#include "benchmarks/harness/image_blur.h"
#include "host/image/metrics.h"

#include <algorithm>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

// Apart from the seeds of the method and of unfiltered images.
constexpr std::uint32_t blurSeed = 201;
// The widths that the best one is searched among: pixels, each by this factor more than the one before.
constexpr double narrowest = 0.25, widest = 16.0, step = 1.41421356;

/// An unfiltered image under the one Gaussian that leaves the least error.
void addBlurred(Lab& lab, const render::Settings& settings, CurveResult& out)
{
    Measured best = lab.measure(settings, blurSeed);
    const image::RgbImage image = lab.render(settings, blurSeed);
    const Reference& reference = lab.reference(settings);
    double width = 0;
    for (double sigma = narrowest; sigma <= widest; sigma *= step) {
        const double rmse = image::rmse(blurred(image, sigma), reference.image);
        if (rmse < best.rmse) {
            best.rmse = rmse;
            width = sigma;
        }
    }
    best.error = lab.compared(best.rmse, settings);
    best.corrected = withoutNoise(best.rmse, reference.noise);
    lab.say(fmt::format("one blur of {:.2f} px for the image        rmse {:.6f}", width, best.rmse));
    out.points.push_back(best);
    out.widths.push_back(width);
}

CurveResult variant(
    Lab& lab, const Benchmark& benchmark, const Case& of, const VariantRow& row, const std::vector<int>& budgets)
{
    CurveResult out { { { "name", row.name }, { "meaning", row.meaning } }, {}, {} };
    if (row.kind == VariantRow::OfPublished) {
        for (const float mu : lab.plan().publishedMu) {
            out.points.push_back(lab.measure(methodSettings(of, true, {}, mu)));
        }
        return out;
    }
    const render::Settings usual = usualSettings(benchmark, of, false);
    for (const int spp : budgets) {
        if (row.kind == VariantRow::ImageBlur) {
            addBlurred(lab, baselineSettings(benchmark.baselines.back(), of, spp), out);
            continue;
        }
        // The usual count as it comes: constants that follow from a count may be rounded.
        render::Settings settings = spp == usual.spp ? usual : methodSettings(of, false, spp);
        if (row.change) {
            row.change(settings);
        }
        out.points.push_back(lab.measure(settings));
    }
    return out;
}

} // namespace

std::vector<int> budgetsOf(const MeasurePlan& plan, int usualSpp)
{
    std::vector<int> out = plan.budgets;
    out.push_back(usualSpp);
    std::ranges::sort(out);
    const auto repeated = std::ranges::unique(out);
    out.erase(repeated.begin(), repeated.end());
    return out;
}

std::vector<CurveResult> variants(Lab& lab, const Benchmark& benchmark, const Case& of, const std::vector<int>& budgets)
{
    std::vector<CurveResult> out;
    for (const VariantRow& row : benchmark.variants) {
        out.push_back(variant(lab, benchmark, of, row, budgets));
    }
    return out;
}

} // namespace wedge::benchmark
