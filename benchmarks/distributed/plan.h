#pragma once

#include "benchmarks/common/measure_plan.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// How much is measured. width and height are of errors.
struct DistributedPlan : MeasurePlan {
    DistributedPlan()
    {
        width = height = 512;
        referenceSpp = 1024;
        seeds = 2;
        frames = 3;
        largestBaseline = 576;
        subtractNoise = true;
        // Squares, for strata, and powers of two, at which Sobol points are at their best.
        baselineSpp = { 4, 16, 64, 256 };
    }

    bool errorsOnly = false;
    int timedWidth = 1024, timedHeight = 1024; ///< of timed frames: Table 5.2
    std::vector<int> budgets { 16, 64, 128 }; ///< of curves, with the default count
    std::vector<float> publishedMu { 0.5f, 1, 2, 3 }; ///< of the published setting's curve
    std::string maps; ///< folder, "" for none
};

/// Less of everything, at 160x160.
inline DistributedPlan quickDistributedPlan()
{
    DistributedPlan plan;
    plan.quick = true;
    plan.width = plan.height = plan.timedWidth = plan.timedHeight = 160;
    plan.seeds = 2;
    plan.referenceSpp = 256;
    plan.largestBaseline = 144;
    plan.baselineSpp = { 4, 16, 64 };
    plan.budgets = { 16, 64 };
    plan.publishedMu = { 1, 2 };
    return plan;
}

} // namespace wedge::benchmark
