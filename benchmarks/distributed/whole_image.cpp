#include "benchmarks/distributed/whole_image.h"

#include "benchmarks/common/variants.h"
#include "host/device/queue.h"

#include <utility>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

using device::PassKind;
using render::FrameStatistics;

double rays(const FrameStatistics& frame)
{
    return static_cast<double>(frame.primaryRays + frame.shadowRays + frame.indirectRays);
}

/// All that is not tracing, what the host does between passes included, by the host's clock.
double wallOverhead(const FrameStatistics& f) { return 1.0 - f.milliseconds(PassKind::Trace) / f.wallMilliseconds; }

} // namespace

WholeImage::WholeImage(std::string program, const MeasurePlan& plan, int bounces)
    : program_(std::move(program))
    , pixels_(static_cast<double>(plan.width) * plan.height)
    , referenceSpp_(plan.referenceSpp)
    , bounces_(bounces)
{
}

Integrand WholeImage::integrandOf(const render::Settings&) const
{
    return { "whole image", unfiltered(render::Sampler::Sobol, referenceSpp_) };
}

double WholeImage::raysOf(const FrameStatistics& frame) const { return rays(frame); }

double WholeImage::pixelsOf(const FrameStatistics&) const { return pixels_; }

float WholeImage::muOf(const render::Settings& s) const { return s.published ? s.distributed.mu : s.mu; }

std::string WholeImage::describe(const render::Settings& s) const
{
    if (s.method == render::Method::MonteCarlo) {
        return fmt::format("unfiltered {}", s.sampler == render::Sampler::Sobol ? "sobol" : "stratified");
    }
    const char* factoring = s.distributed.factoring == render::Factoring::Never ? " not factored" : "";
    return describeVariant(s, muOf(s), s.distributed.countExponent > 0) + factoring;
}

render::Settings WholeImage::usual(std::optional<int> spp) const
{
    render::Settings out = render::axisAligned(spp);
    out.bounces = bounces_;
    return out;
}

render::Settings WholeImage::published(std::optional<float> mu) const
{
    render::Settings out = render::asPublished(mu);
    out.bounces = bounces_;
    return out;
}

render::Settings WholeImage::unfiltered(render::Sampler sampler, int spp) const
{
    render::Settings out = plain(sampler, spp);
    out.bounces = bounces_;
    return out;
}

const std::vector<TimingColumn>& distributedColumns()
{
    static const std::vector<TimingColumn> all = [] {
        std::vector<TimingColumn> out = {
            { "rays", rays },
            tracing(),
            ofPasses("lists", { "lists" }),
            ofPasses("accumulate", { "accumulate" }),
            ofPasses("widths", { "widths" }),
            ofPasses("counts", { "counts", "pixels gathered" }),
            widthsAndCounts(),
            ofPasses("filter_lens_and_shutter", { "filter of lens and shutter" }),
            { "overhead_wall_fraction", wallOverhead },
        };
        out.insert(out.end(), frameColumns().begin(), frameColumns().end());
        return out;
    }();
    return all;
}

} // namespace wedge::benchmark
