#include "benchmarks/soft_shadows/shadow_lab.h"

#include <fmt/format.h>

namespace wedge::benchmark {

using render::Shading;

std::string integrandName(bool shadingApart) { return shadingApart ? "shading apart" : "true integral"; }

Integrand SoftShadows::integrandOf(const render::Settings& settings) const
{
    // Light that is known exactly where nothing is in the way needs no samples: less noise than plain Monte Carlo has.
    // The thesis' shading is compared at larger errors, so that half the samples do.
    const bool apart = settings.shading == Shading::Separate;
    Integrand out { integrandName(apart), render::monteCarlo(apart ? referenceSpp_ / 2 : referenceSpp_) };
    out.settings.shading = apart ? Shading::Separate : Shading::Ratio;
    return out;
}

double SoftShadows::raysOf(const render::FrameStatistics& frame) const { return static_cast<double>(frame.shadowRays); }

std::string SoftShadows::describe(const render::Settings& s) const
{
    if (s.method != render::Method::MonteCarlo) {
        return describeVariant(s, s.mu, s.sampling == render::Sampling::Adaptive);
    }
    constexpr const char* shadings[] = { "separate", "inside", "ratio" };
    return fmt::format("unfiltered {} {}", s.sampler == render::Sampler::Sobol ? "sobol" : "stratified",
        shadings[static_cast<int>(s.shading)]);
}

const std::vector<TimingColumn>& shadowColumns()
{
    static const std::vector<TimingColumn> all = [] {
        std::vector<TimingColumn> out = {
            ofPasses("primary", { "primary rays" }),
            ofPasses("first_pass", { "first pass" }),
            ofPasses("second_pass", { "second pass" }),
            tracing(),
            ofPasses("widths", { "widths" }),
            ofPasses("counts", { "counts" }),
            ofPasses("first_pass_filter", { "filter of first pass" }),
            widthsAndCounts(),
        };
        out.insert(out.end(), frameColumns().begin(), frameColumns().end());
        return out;
    }();
    return all;
}

} // namespace wedge::benchmark
