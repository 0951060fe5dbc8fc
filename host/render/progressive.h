#pragma once

#include "host/render/halves.h"
#include "host/render/renderer.h"

#include <vector>

namespace wedge::render {

/// An image on the way to the last one of a progressive render.
struct ProgressiveStep {
    int spp = 0; ///< samples a pixel that were asked for up to here
    FrameStatistics statistics; ///< of all steps up to this one; complete: the last one, and not stopped early
    ErrorEstimate error { 0, 0 };
};

/// The samples a pixel after each step, of both halves together: 16, 32, 64, ..., and the largest even number up to
/// `spp`, but no less than 2.
std::vector<int> stepCounts(int spp);

/// One of these steps, from so many samples a pixel to so many.
struct StepRange {
    int before = 0, spp = 0;
};

/// The first one, and that of most new samples (the first such).
StepRange firstStep(const Settings& settings);
StepRange largestStep(int spp);

/// Adds what passes of the same names cost; new ones go to the end.
void addRecords(std::vector<device::PassRecord>& sum, const std::vector<device::PassRecord>& more);

} // namespace wedge::render
