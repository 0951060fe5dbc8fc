#include "benchmarks/indirect/curves.h"

#include "benchmarks/common/variants.h"
#include "benchmarks/indirect/indirect_light.h"
#include "kernels/shared/indirect.h"

namespace wedge::benchmark {
namespace {

constexpr int firstPassRays = WEDGE_INDIRECT_FIRST_RAYS;
constexpr float firstWidth = 2.0f; // pixels, where the search for the best one starts

std::vector<render::Settings> budgets(const Plan& plan, bool published)
{
    std::vector<render::Settings> out;
    if (published) {
        for (const float mu : plan.publishedMu) {
            out.push_back(render::asPublished(mu));
        }
    } else {
        for (const int spp : plan.budgets) {
            out.push_back(render::axisAligned(spp));
        }
    }
    for (render::Settings& settings : out) {
        settings.bounces = 1;
    }
    return out;
}

} // namespace

std::vector<Series> filterCurves(Lab& lab, const Plan& plan, bool published, const std::vector<Measured>& plain)
{
    const std::string setting = published ? "published" : "default";
    Series unfiltered { setting, "NAS", "UF", {}, plain };
    Series filterOnly { setting, "NAS", "AF", {}, {} };
    Series adaptive { setting, "AS", "AF", {}, {} };
    for (const render::Settings& settings : budgets(plan, published)) {
        adaptive.points.push_back(lab.measure(settings));
        const double spp = adaptive.points.back().spp;
        filterOnly.points.push_back(lab.measure(uniform(settings, spp, firstPassRays)));
        if (published && spp > plan.largestBudget) {
            break;
        }
    }
    return { std::move(unfiltered), std::move(filterOnly), std::move(adaptive) };
}

FixedBlur bestUniformBlur(Lab& lab, const render::Settings& usual)
{
    const render::Settings settings = uniform(usual, lab.measure(usual).spp, firstPassRays);
    const float width = bestFixedWidth(lab, settings, firstWidth);
    return { width, lab.measure(fixed(settings, width)) };
}

} // namespace wedge::benchmark
