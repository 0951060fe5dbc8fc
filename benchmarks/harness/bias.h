#pragma once

#include "benchmarks/common/lab.h"
#include "benchmarks/harness/benchmark.h"

namespace wedge::benchmark {

/// What is left of the method's error when its noise averages out: what its filter blurs.
struct Bias {
    bool published = false;
    float mu = 0;
    double spp = 0;
    double meanError = 0; ///< of the image's mean, as a fraction of it; below 0 where the filter darkens
    double rms = 0; ///< over the image, with the noise of the mean and of the reference taken out
    double rmse = 0; ///< of one image
};

/// From the mean of the plan's number of images, at mu and the usual count (default) or the one that follows from mu
/// (published).
Bias measureBias(Lab& lab, const Case& of, bool published, float mu);

} // namespace wedge::benchmark
