#pragma once

#include "benchmarks/rays/clocks.h"

#include <fmt/format.h>

#include <cstdio>
#include <string>

namespace wedge::benchmark {

/// What is measured, and how thoroughly.
struct RayPlan {
    bool quick = false;
    int width = 640, height = 480; ///< multiples of 8
    int shadowSamples = 9, ambientSamples = 4; ///< a pixel
    bool growth = true, frame = true;
    int growthSteps = 9; ///< half decades from 10^3 on, one included
    TimingPlan timing;
    double timeStampHertz = 0; ///< 0: unknown
};

/// A line of progress on stderr.
inline void progress(const std::string& line) { fmt::print(stderr, "{}\n", line); }

} // namespace wedge::benchmark
