#pragma once

#include <limits>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// How much a benchmark of errors measures.
struct MeasurePlan {
    bool quick = false;
    int width = 640, height = 480;
    int timedWidth = 0, timedHeight = 0; ///< of timed frames; 0: the same
    int frames = 7; ///< timed, after one that warms up
    int seeds = 3; ///< of the method's error
    int referenceSpp = 2048;
    int largestBaseline = 1600; ///< samples of the unfiltered curves; beyond, they are extrapolated
    bool subtractNoise = false; ///< compare errors without the reference's noise, where it is not far below them
    std::vector<int> baselineSpp = {}; ///< where the unfiltered curves start
    /// Further points of unfiltered curves are at four times the samples, in place of squares that are just enough:
    /// squares for strata that are powers of two for Sobol points as well.
    bool powersOfFour = false;
    std::vector<int> budgets = {}; ///< samples of curves, default setting
    std::vector<float> publishedMu = {}; ///< of curves, published setting
    double largestBudget = std::numeric_limits<double>::infinity(); ///< no further ones after the first of more samples
    std::vector<float> mu = {}; ///< of the default setting's convergence
    int biasSeeds = 0; ///< images whose mean shows what the filter blurs

    // Of the command line.
    bool timingOnly = false, errorsOnly = false;
    std::string referenceFolder = {};
    std::string maps = {}; ///< folder for pictures of counts and widths, "" for none
};

} // namespace wedge::benchmark
