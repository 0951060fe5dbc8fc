#include "benchmarks/indirect/indirect_light.h"

#include <fmt/format.h>

namespace wedge::benchmark {

namespace {

render::Settings of(const BounceCase& paths, render::Settings settings)
{
    settings.bounces = paths.bounces;
    if (paths.bounces == 0) {
        settings.integrator = render::Integrator::AmbientOcclusion;
        settings.indirect.ambientDistance = paths.ambientDistance;
    }
    return settings;
}

} // namespace

std::string integrandName(int bounces)
{
    return bounces == 0 ? "ambient occlusion" : fmt::format("{} bounce{}", bounces, bounces == 1 ? "" : "s");
}

render::Settings methodSettings(bool published, const BounceCase& paths)
{
    return of(paths, published ? render::asPublished() : render::axisAligned());
}

render::Settings unfiltered(render::Sampler sampler, int spp, const BounceCase& paths)
{
    render::Settings out = render::monteCarlo(spp);
    out.sampler = sampler;
    return of(paths, out);
}

Integrand IndirectLight::integrandOf(const render::Settings& settings) const
{
    BounceCase paths;
    paths.bounces = settings.bounces;
    paths.ambientDistance = settings.indirect.ambientDistance;
    return { integrandName(settings.bounces), unfiltered(render::Sampler::Sobol, referenceSpp_, paths) };
}

double IndirectLight::raysOf(const render::FrameStatistics& frame) const
{
    return static_cast<double>(frame.indirectRays);
}

std::string IndirectLight::describe(const render::Settings& s) const
{
    const bool adaptive =
        s.sampling == render::Sampling::Adaptive && s.indirect.counts != render::IndirectCounts::Uniform;
    const std::string variant = s.method == render::Method::MonteCarlo
        ? fmt::format("unfiltered {}", s.sampler == render::Sampler::Sobol ? "sobol" : "stratified")
        : describeVariant(s, s.indirect.mu, adaptive);
    return s.bounces == 1 ? variant : fmt::format("{} {}", variant, integrandName(s.bounces));
}

const std::vector<TimingColumn>& indirectColumns()
{
    static const std::vector<TimingColumn> all = [] {
        std::vector<TimingColumn> out = {
            ofPasses("camera_and_direct", { "primary rays", "first pass", "second pass", "point lights" }),
            ofPasses("first_pass", { "first paths" }),
            ofPasses("second_pass", { "second paths" }),
            tracing(),
            ofPasses("widths", { "widths" }),
            ofPasses("counts", { "counts" }),
            ofPasses("first_pass_filter", { "pixels gathered", "filter of first pass" }),
            widthsAndCounts(),
            ofPasses("filter_indirect", { "filter of indirect" }),
        };
        out.insert(out.end(), frameColumns().begin(), frameColumns().end());
        return out;
    }();
    return all;
}

} // namespace wedge::benchmark
