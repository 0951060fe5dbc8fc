#pragma once

#include "benchmarks/common/lab.h"

#include <string>

namespace wedge::benchmark {

/// What is left of the method's error when its noise averages out: what its filter blurs.
struct Bias {
    std::string setting; ///< "default" or "published"
    float mu = 0;
    double spp = 0;
    double meanError = 0; ///< of the image's mean, as a fraction of it; below 0 where the filter darkens
    double rms = 0; ///< over the image, with the noise of the mean and of the reference taken out
    double rmse = 0; ///< of one image
};

/// From the mean of so many images with one bounce, at mu and the usual count (default) or the one that follows from
/// mu (published).
Bias measureBias(Lab& lab, bool published, float mu, int seeds);

} // namespace wedge::benchmark
