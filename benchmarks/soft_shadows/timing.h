#pragma once

#include "benchmarks/common/statistics.h"
#include "benchmarks/soft_shadows/lab.h"

#include <string>
#include <utility>
#include <vector>

namespace wedge::benchmark {

/// Table 3.1 for one setting. Milliseconds unless the name says otherwise; docs/benchmarks.md explains each column.
struct Timing {
    double spp = 0, megaraysPerSecond = 0;
    std::vector<std::pair<std::string, Summary>> columns;

    /// Throws std::out_of_range for an unknown name.
    const Summary& operator[](const std::string& column) const;
};

/// Renders plan().frames frames after a rehearsal and a frame that warms up.
Timing timeFrames(Lab& lab, render::Settings settings);

} // namespace wedge::benchmark
