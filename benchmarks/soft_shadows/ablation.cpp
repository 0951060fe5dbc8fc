#include "benchmarks/soft_shadows/ablation.h"

#include "benchmarks/common/variants.h"
#include "kernels/shared/wedge.h"

#include <algorithm>

namespace wedge::benchmark {
namespace {

using render::Filtering;
using render::Settings;

constexpr float firstWidth = 0.8f; // pixels, where the search for the best one starts
constexpr int firstPassRays = WEDGE_FIRST_PASS_RAYS;

/// A budget: the setting and what it takes with everything adaptive.
struct Budget {
    Settings settings;
    Measured adaptive;
};

std::vector<Budget> budgets(ShadowLab& lab, bool published)
{
    std::vector<Settings> wanted;
    if (published) {
        for (const float mu : lab.plan().publishedMu) {
            wanted.push_back(render::asPublished(mu));
        }
    } else {
        for (const int spp : lab.plan().budgets) {
            wanted.push_back(render::axisAligned(spp));
        }
    }
    std::vector<Budget> out;
    for (const Settings& settings : wanted) {
        out.push_back({ settings, lab.measure(settings) });
        if (out.back().adaptive.spp > lab.plan().largestBudget) {
            break;
        }
    }
    return out;
}

/// One of the six combinations at a budget. width: in pixels, for the fixed filter.
Settings variant(const Budget& budget, bool adaptive, Filtering filter, float width)
{
    if (!adaptive && filter == Filtering::None) {
        Settings settings = plain(budget.settings.sampler, budget.adaptive.spp);
        settings.lightSampling = render::LightSampling::Lights;
        settings.shading = budget.settings.shading;
        return settings;
    }
    Settings settings = adaptive ? budget.settings : uniform(budget.settings, budget.adaptive.spp, firstPassRays);
    if (filter == Filtering::Fixed) {
        return fixed(settings, width);
    }
    settings.filtering = filter;
    return settings;
}

} // namespace

FixedBlur bestFixedBlur(ShadowLab& lab)
{
    const Settings usual = render::axisAligned(defaultSpp);
    const float width = bestFixedWidth(lab, usual, firstWidth);
    return { width, lab.measure(fixed(usual, width)) };
}

std::vector<Series> ablations(ShadowLab& lab, bool published)
{
    const std::vector<Budget> all = budgets(lab, published);
    const Settings usual = published ? render::asPublished(publishedMu) : render::axisAligned(defaultSpp);
    const double usualSpp = lab.measure(usual).spp;
    const float adaptiveWidth = bestFixedWidth(lab, usual, firstWidth);
    std::vector<Series> out;
    for (const bool adaptive : { false, true }) {
        const float width =
            adaptive ? adaptiveWidth : bestFixedWidth(lab, uniform(usual, usualSpp, firstPassRays), adaptiveWidth);
        for (const Filtering filter : { Filtering::None, Filtering::Fixed, Filtering::Adaptive }) {
            constexpr const char* names[] = { "UF", "NAF", "AF" };
            Series series { published ? "published" : "default", adaptive ? "AS" : "NAS",
                names[static_cast<int>(filter)], {}, {} };
            if (filter == Filtering::Fixed) {
                series.fixedWidth = width;
            }
            for (const Budget& budget : all) {
                series.points.push_back(lab.measure(variant(budget, adaptive, filter, width)));
            }
            out.push_back(std::move(series));
        }
    }
    return out;
}

std::vector<Measured> convergence(ShadowLab& lab, bool published)
{
    std::vector<Measured> out;
    if (published) {
        for (const Budget& budget : budgets(lab, true)) {
            out.push_back(budget.adaptive);
        }
        return out;
    }
    for (const float mu : lab.plan().mu) {
        out.push_back(lab.measure(render::axisAligned({}, mu)));
    }
    return out;
}

bool falls(const std::vector<Measured>& points)
{
    return std::ranges::adjacent_find(points, [](const Measured& a, const Measured& b) { return b.rmse >= a.rmse; })
        == points.end();
}

} // namespace wedge::benchmark
