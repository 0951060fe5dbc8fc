#pragma once

#include "benchmarks/harness/benchmark.h"

#include <string>
#include <utility>

namespace wedge::benchmark {

/// All that a frame shows, and all rays that it takes, over all pixels.
class WholeImage : public Subject {
public:
    /// program: the benchmark's name.
    WholeImage(std::string program, const MeasurePlan& plan)
        : program_(std::move(program))
        , pixels_(static_cast<double>(plan.width) * plan.height)
        , referenceSpp_(plan.referenceSpp)
    {
    }

    std::string program() const override { return program_; }
    Integrand integrandOf(const render::Settings& settings) const override;
    double sppOf(const render::FrameStatistics& frame) const override { return frame.sppMean; }
    double raysOf(const render::FrameStatistics& frame) const override;
    double pixelsOf(const render::FrameStatistics&) const override { return pixels_; }
    float muOf(const render::Settings& s) const override { return s.published ? s.distributed.mu : s.mu; }
    std::string describe(const render::Settings& settings) const override;

private:
    std::string program_;
    double pixels_;
    int referenceSpp_;
};

/// A benchmark of frames with all effects at once, measured as their scene files have them; without its scenes.
Benchmark wholeImages(std::string program, std::string about, std::shared_ptr<Subject> (*subject)(const MeasurePlan&));

/// What the thesis says of a frame of 1024x1024 (Table 5.2, appendix B). Nothing where it says nothing.
struct PaperFrame {
    std::optional<double> triangles = {};
    double raysPerPixel;
    std::optional<double> overhead = {}; ///< fraction of the frame
    std::optional<double> seconds = {}; ///< of the frame
    std::optional<double> raysSaved = {}; ///< at equal RMS error
};

Paper paperOf(const PaperFrame& p);

} // namespace wedge::benchmark
