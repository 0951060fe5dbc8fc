#pragma once

#include "benchmarks/common/lab.h"
#include "benchmarks/common/statistics.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace wedge::benchmark {

/// Times of one setting's frames. Milliseconds unless the name says otherwise; docs/benchmarks.md explains each column.
struct Timing {
    double spp = 0, megaraysPerSecond = 0;
    double firstFrame = 0; ///< wall clock of the first frame after the rehearsal, over the median of those after it
    std::vector<std::pair<std::string, Summary>> columns;

    /// Throws std::out_of_range for an unknown name.
    const Summary& operator[](const std::string& column) const;
};

/// What a column of times takes from each frame.
struct TimingColumn {
    std::string name;
    std::function<double(const render::FrameStatistics&)> value;
};

/// Milliseconds of the passes of these names together.
TimingColumn ofPasses(const std::string& column, const std::vector<std::string>& passes);
/// Milliseconds of all tracing, of all analysis.
TimingColumn tracing();
TimingColumn widthsAndCounts();
/// Those, and what every benchmark of frames has: filter, composite, overhead, total, the host's clock, frames a
/// second.
std::vector<TimingColumn> withFrameColumns(std::vector<TimingColumn> columns);

/// Pixels of a timed frame.
double timedPixels(const MeasurePlan& plan);

/// Renders plan().frames frames after a rehearsal and a frame that warms up. label: of the settings, for progress.
Timing timeFrames(
    Lab& lab, render::Settings settings, const std::vector<TimingColumn>& columns, const std::string& label);

} // namespace wedge::benchmark
