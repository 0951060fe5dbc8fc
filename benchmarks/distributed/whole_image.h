#pragma once

#include "benchmarks/common/lab.h"
#include "benchmarks/common/timing.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// All that a frame shows, and all rays that it takes.
class WholeImage : public Subject {
public:
    /// program: the benchmark's name. settings: of bounces, as the scene has them.
    WholeImage(std::string program, const MeasurePlan& plan, int bounces);

    std::string program() const override { return program_; }
    Integrand integrandOf(const render::Settings& settings) const override;
    double sppOf(const render::FrameStatistics& frame) const override { return frame.sppMean; }
    double raysOf(const render::FrameStatistics& frame) const override;
    /// All pixels of the image.
    double pixelsOf(const render::FrameStatistics& frame) const override;
    float muOf(const render::Settings& settings) const override;
    std::string describe(const render::Settings& settings) const override;

    /// The default setting with so many samples, or its own count.
    render::Settings usual(std::optional<int> spp = {}) const;
    /// As published, with its own mu or another.
    render::Settings published(std::optional<float> mu = {}) const;
    /// Neither analysed nor filtered.
    render::Settings unfiltered(render::Sampler sampler, int spp) const;

private:
    std::string program_;
    double pixels_;
    int referenceSpp_, bounces_;
};

/// The columns of Table 5.2 and what they are made of; docs/benchmarks.md.
const std::vector<TimingColumn>& distributedColumns();

} // namespace wedge::benchmark
