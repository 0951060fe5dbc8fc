#include "benchmarks/distributed/variant_curves.h"

#include "benchmarks/distributed/image_blur.h"
#include "host/image/metrics.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

// Apart from the seeds of the method and of unfiltered images.
constexpr std::uint32_t blurSeed = 201;
// The widths that the best one is searched among: pixels, each by this factor more than the one before.
constexpr double narrowest = 0.25, widest = 16.0, step = 1.41421356;

using Change = std::function<void(render::Settings&)>;

VariantCurve variant(Lab& lab, const WholeImage& subject, const std::vector<int>& budgets, const std::string& name,
    const std::string& meaning, const Change& change)
{
    VariantCurve out { name, meaning, {}, {} };
    for (const int spp : budgets) {
        // The default count as it comes: constants that follow from a count may be rounded.
        render::Settings settings = spp == subject.usual().spp ? subject.usual() : subject.usual(spp);
        change(settings);
        out.points.push_back(lab.measure(settings));
    }
    return out;
}

VariantCurve published(Lab& lab, const WholeImage& subject, const std::vector<float>& values)
{
    VariantCurve out { "published", "as published, by mu", {}, {} };
    for (const float mu : values) {
        out.points.push_back(lab.measure(subject.published(mu)));
    }
    return out;
}

/// Unfiltered images of as many samples, blurred by one Gaussian each: the best.
VariantCurve fixedBlur(Lab& lab, const WholeImage& subject, const std::vector<int>& budgets)
{
    VariantCurve out { "fixed_blur", "unfiltered, Owen-scrambled Sobol, then the best single Gaussian", {}, {} };
    for (const int spp : budgets) {
        const render::Settings settings = subject.unfiltered(render::Sampler::Sobol, spp);
        Measured best = lab.measure(settings, blurSeed);
        const image::RgbImage image = lab.render(settings, blurSeed);
        const image::RgbImage& truth = lab.reference(settings).image;
        double width = 0;
        for (double sigma = narrowest; sigma <= widest; sigma *= step) {
            const double rmse = image::rmse(blurred(image, sigma), truth);
            if (rmse < best.rmse) {
                best.rmse = rmse;
                width = sigma;
            }
        }
        best.error = lab.compared(best.rmse, settings);
        lab.say(fmt::format("one blur of {:.2f} px for the image        rmse {:.6f}", width, best.rmse));
        out.points.push_back(best);
        out.widths.push_back(width);
    }
    return out;
}

} // namespace

std::vector<int> budgetsOf(const WholeImage& subject, const DistributedPlan& plan)
{
    std::vector<int> out = plan.budgets;
    out.push_back(subject.usual().spp);
    std::ranges::sort(out);
    const auto repeated = std::ranges::unique(out);
    out.erase(repeated.begin(), repeated.end());
    return out;
}

std::vector<VariantCurve> measureVariants(Lab& lab, const WholeImage& subject, const DistributedPlan& plan)
{
    const std::vector<int> budgets = budgetsOf(subject, plan);
    const auto of = [&](const char* name, const char* meaning, const Change& change) {
        return variant(lab, subject, budgets, name, meaning, change);
    };
    return {
        of("default", "the default setting", [](render::Settings&) {}),
        published(lab, subject, plan.publishedMu),
        of("no_factoring", "default, texture and irradiance never taken apart",
            [](render::Settings& s) { s.distributed.factoring = render::Factoring::Never; }),
        of("uniform_counts", "default, equal counts everywhere",
            [](render::Settings& s) { s.distributed.countExponent = 0.0f; }),
        fixedBlur(lab, subject, budgets),
    };
}

} // namespace wedge::benchmark
