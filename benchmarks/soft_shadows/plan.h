#pragma once

#include "benchmarks/common/measure_plan.h"

#include <vector>

namespace wedge::benchmark {

/// How much is measured. Samples of references are those of the true integral; half as many of the thesis' shading.
struct Plan : MeasurePlan {
    Plan() { baselineSpp = { 9, 25, 64, 144 }; }

    std::vector<int> budgets { 9, 16, 28, 64, 128 }; ///< of the ablations, default setting
    std::vector<float> publishedMu { 0.5f, 1, 2, 3, 4, 6, 8 }; ///< of the ablations, published setting
    double largestBudget = 100; ///< no further budgets after the first one of more mean samples
    std::vector<float> mu { 1, 2, 4, 6 }; ///< of the default setting's convergence
};

/// Less of everything, at 320x240: about two minutes for our four scenes on two cores.
inline Plan quickPlan()
{
    Plan plan;
    plan.quick = true;
    plan.width = 320;
    plan.height = 240;
    plan.frames = 3;
    plan.referenceSpp = 256;
    plan.largestBaseline = 225;
    plan.baselineSpp = { 9, 25, 64 };
    plan.budgets = { 9, 28 };
    plan.publishedMu = { 1, 2 };
    plan.largestBudget = 60;
    plan.mu = { 1, 2, 4 };
    return plan;
}

/// The budget at which the default setting is judged, and the published one's mu (Table 3.1).
constexpr int defaultSpp = 28;
constexpr float publishedMu = 2.0f;

} // namespace wedge::benchmark
