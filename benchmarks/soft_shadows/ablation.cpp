#include "benchmarks/soft_shadows/ablation.h"

#include "kernels/shared/wedge.h"

#include <algorithm>
#include <cmath>

namespace wedge::benchmark {
namespace {

using render::Filtering;
using render::Sampling;
using render::Settings;

constexpr float firstWidth = 0.8f; // pixels, where the search for the best one starts
constexpr int firstPassRays = WEDGE_FIRST_PASS_RAYS;

/// A budget: the setting and what it takes with everything adaptive.
struct Budget {
    Settings settings;
    Measured adaptive;
};

std::vector<Budget> budgets(Lab& lab, bool published)
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

int nearestSquare(double value)
{
    const long side = std::lround(std::sqrt(std::max(0.0, value)));
    return static_cast<int>(side * side);
}

/// The same setting with equal counts everywhere, about spp. Jittered strata are even only in square counts, so each
/// of the two passes gets one.
Settings uniform(Settings settings, double spp)
{
    const bool strata = settings.sampler == render::Sampler::Stratified;
    const int count = strata ? firstPassRays + nearestSquare(spp - firstPassRays) : static_cast<int>(std::lround(spp));
    settings.sampling = Sampling::Uniform;
    settings.spp = std::max(firstPassRays, count);
    settings.maxSpp = std::max(settings.maxSpp, settings.spp);
    return settings;
}

/// Neither analysed nor filtered: plain Monte Carlo of the setting's integrand and sampler, in one pass.
Settings plain(const Settings& settings, double spp)
{
    const bool strata = settings.sampler == render::Sampler::Stratified;
    Settings out = render::monteCarlo(std::max(1, strata ? nearestSquare(spp) : static_cast<int>(std::lround(spp))));
    out.sampler = settings.sampler;
    out.shading = settings.shading;
    return out;
}

Settings fixed(Settings settings, float width)
{
    settings.filtering = Filtering::Fixed;
    settings.fixedWidth = width;
    return settings;
}

/// One of the six combinations at a budget. width: in pixels, for the fixed filter.
Settings variant(const Budget& budget, bool adaptive, Filtering filter, float width)
{
    if (!adaptive && filter == Filtering::None) {
        return plain(budget.settings, budget.adaptive.spp);
    }
    Settings settings = adaptive ? budget.settings : uniform(budget.settings, budget.adaptive.spp);
    if (filter == Filtering::Fixed) {
        return fixed(settings, width);
    }
    settings.filtering = filter;
    return settings;
}

} // namespace

float bestFixedWidth(Lab& lab, Settings settings, float start)
{
    constexpr float step = 1.41421356f;
    constexpr float narrowest = 0.25f;
    constexpr float widest = 13.0f; // three of these are the kernel's largest radius, 40 pixels
    const auto error = [&](float width) { return lab.measure(fixed(settings, width)).rmse; };
    float best = start;
    double least = error(start);
    for (const float factor : { step, 1.0f / step }) {
        for (float width = start * factor; width >= narrowest && width <= widest; width *= factor) {
            const double e = error(width);
            if (e >= least) {
                break;
            }
            best = width;
            least = e;
        }
        if (best != start) {
            break; // the error has one minimum: it is not on the other side too
        }
    }
    return best;
}

FixedBlur bestFixedBlur(Lab& lab)
{
    const Settings usual = render::axisAligned(defaultSpp);
    const float width = bestFixedWidth(lab, usual, firstWidth);
    return { width, lab.measure(fixed(usual, width)) };
}

std::vector<Series> ablations(Lab& lab, bool published)
{
    const std::vector<Budget> all = budgets(lab, published);
    const Settings usual = published ? render::asPublished(publishedMu) : render::axisAligned(defaultSpp);
    const double usualSpp = lab.measure(usual).spp;
    const float adaptiveWidth = bestFixedWidth(lab, usual, firstWidth);
    std::vector<Series> out;
    for (const bool adaptive : { false, true }) {
        const float width = adaptive ? adaptiveWidth : bestFixedWidth(lab, uniform(usual, usualSpp), adaptiveWidth);
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

std::vector<Measured> convergence(Lab& lab, bool published)
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
