#include "benchmarks/common/variants.h"
#include "benchmarks/harness/curves.h"

#include <algorithm>

namespace wedge::benchmark {
namespace {

using render::Filtering;
using render::Settings;

/// A budget: the setting and what it takes with everything adaptive.
struct Budget {
    Settings settings;
    Measured adaptive;
};

std::vector<Budget> budgets(Lab& lab, const Case& of, bool published)
{
    std::vector<Settings> wanted;
    for (const float mu : published ? lab.plan().publishedMu : std::vector<float> {}) {
        wanted.push_back(methodSettings(of, true, {}, mu));
    }
    for (const int spp : published ? std::vector<int> {} : lab.plan().budgets) {
        wanted.push_back(methodSettings(of, false, spp));
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

/// One combination at a budget. width: in pixels, for the fixed filter.
Settings variant(const Budget& budget, const AblationRow& row, int firstPass, float width)
{
    if (!row.adaptive && row.filter == Filtering::None) {
        Settings settings = plain(budget.settings.sampler, budget.adaptive.spp);
        settings.bounces = budget.settings.bounces;
        settings.lightSampling = render::LightSampling::Lights;
        settings.shading = budget.settings.shading;
        return settings;
    }
    Settings settings = row.adaptive ? budget.settings : uniform(budget.settings, budget.adaptive.spp, firstPass);
    if (row.filter == Filtering::Fixed) {
        return fixed(settings, width);
    }
    settings.filtering = row.filter;
    return settings;
}

} // namespace

FixedWidth bestFixedWidth(Lab& lab, const FixedWidthRule& rule, const Settings& usual)
{
    const Settings settings = rule.uniformCounts ? uniform(usual, lab.measure(usual).spp, rule.firstPass) : usual;
    const float width = bestFixedWidth(lab, settings, rule.firstWidth);
    return { width, lab.measure(fixed(settings, width)) };
}

std::vector<Measured> convergence(Lab& lab, const Case& of, bool published)
{
    std::vector<Measured> out;
    if (lab.plan().mu.empty()) {
        return out;
    }
    for (const Budget& budget : published ? budgets(lab, of, true) : std::vector<Budget> {}) {
        out.push_back(budget.adaptive);
    }
    for (const float mu : published ? std::vector<float> {} : lab.plan().mu) {
        out.push_back(lab.measure(methodSettings(of, false, {}, mu)));
    }
    return out;
}

std::vector<CurveResult> ablations(
    Lab& lab, const Benchmark& benchmark, const Case& of, bool published, const std::vector<Measured>& plain)
{
    const std::vector<Budget> all = budgets(lab, of, published);
    const Settings usual = usualSettings(benchmark, of, published);
    const FixedWidthRule& rule = benchmark.fixedWidth.value();
    float widths[] = { 0, 0 }; // pixels, of uniform and adaptive counts
    if (std::ranges::find(benchmark.ablations, Filtering::Fixed, &AblationRow::filter) != benchmark.ablations.end()) {
        widths[1] = bestFixedWidth(lab, usual, rule.firstWidth);
        widths[0] = bestFixedWidth(lab, uniform(usual, lab.measure(usual).spp, rule.firstPass), widths[1]);
    }
    std::vector<CurveResult> out;
    for (const AblationRow& row : benchmark.ablations) {
        constexpr const char* filters[] = { "UF", "NAF", "AF" };
        const float width = widths[row.adaptive ? 1 : 0];
        CurveResult curve { { { "setting", settingName(published) }, { "sampling", row.adaptive ? "AS" : "NAS" },
                                { "filter", filters[static_cast<int>(row.filter)] },
                                { "fixed_width_pixels", row.filter == Filtering::Fixed ? Json(width) : Json() } },
            {}, {} };
        if (row.baseline) {
            curve.points = plain;
        }
        for (const Budget& budget : row.baseline ? std::vector<Budget> {} : all) {
            curve.points.push_back(lab.measure(variant(budget, row, rule.firstPass, width)));
        }
        out.push_back(std::move(curve));
    }
    return out;
}

bool falls(const std::vector<Measured>& points)
{
    return std::ranges::adjacent_find(points, [](const Measured& a, const Measured& b) { return b.error >= a.error; })
        == points.end();
}

} // namespace wedge::benchmark
