#pragma once

#include "benchmarks/common/measure_plan.h"

#include <vector>

namespace wedge::benchmark {

/// How much is measured.
struct Plan : MeasurePlan {
    Plan()
    {
        referenceSpp = 1024;
        seeds = 2;
        frames = 5;
        largestBaseline = 400;
        subtractNoise = true;
        baselineSpp = { 16, 64, 144 };
    }

    std::vector<int> budgets { 16, 28, 64 }; ///< of the curves, default setting
    std::vector<float> publishedMu { 0.5f, 0.9f, 2 }; ///< of the curves, published setting
    double largestBudget = 150; ///< no further mu after the first one of more mean samples
    int biasSeeds = 4; ///< images whose mean shows what the filter blurs
};

/// Less of everything, at 320x240.
inline Plan quickPlan()
{
    Plan plan;
    plan.quick = true;
    plan.width = 320;
    plan.height = 240;
    plan.frames = 3;
    plan.seeds = 2;
    plan.referenceSpp = 256;
    plan.largestBaseline = 256;
    plan.baselineSpp = { 16, 64 };
    plan.budgets = { 16, 64 };
    plan.publishedMu = { 0.5f, 0.9f };
    plan.biasSeeds = 2;
    return plan;
}

} // namespace wedge::benchmark
