#pragma once

#include "benchmarks/common/lab.h"
#include "benchmarks/common/timing.h"
#include "benchmarks/indirect/scenes.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// Indirect light alone, of so many bounces, or ambient occlusion.
class IndirectLight : public Subject {
public:
    explicit IndirectLight(int referenceSpp)
        : referenceSpp_(referenceSpp)
    {
    }

    std::string program() const override { return "indirect"; }
    std::string layer() const override { return "indirect"; }
    Integrand integrandOf(const render::Settings& settings) const override;
    double sppOf(const render::FrameStatistics& frame) const override { return frame.indirectSpp; }
    double raysOf(const render::FrameStatistics& frame) const override;
    float muOf(const render::Settings& settings) const override { return settings.indirect.mu; }
    std::string describe(const render::Settings& settings) const override;

private:
    int referenceSpp_;
};

/// Its name in integrandOf(): "1 bounce", "2 bounces"; of none "ambient occlusion".
std::string integrandName(int bounces);

/// The method as it comes, or as published.
render::Settings methodSettings(bool published, const BounceCase& paths);

/// Path tracing, or ambient occlusion, without a filter.
render::Settings unfiltered(render::Sampler sampler, int spp, const BounceCase& paths);

/// The columns of Table 4.1; docs/benchmarks.md.
const std::vector<TimingColumn>& indirectColumns();

} // namespace wedge::benchmark
