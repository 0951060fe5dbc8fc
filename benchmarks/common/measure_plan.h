#pragma once

#include <string>
#include <vector>

namespace wedge::benchmark {

/// How much a benchmark of errors measures: what all of them have.
struct MeasurePlan {
    bool quick = false;
    bool timingOnly = false;
    int width = 640, height = 480;
    int frames = 7; ///< timed, after one that warms up
    int seeds = 3; ///< of the method's error
    int referenceSpp = 2048;
    int largestBaseline = 1600; ///< samples of the unfiltered curves; beyond, they are extrapolated
    bool subtractNoise = false; ///< compare errors without the reference's noise, where it is not far below them
    std::vector<int> baselineSpp; ///< where the unfiltered curves start; squares
    std::string referenceFolder;
};

} // namespace wedge::benchmark
