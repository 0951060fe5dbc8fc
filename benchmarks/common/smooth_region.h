#pragma once

#include "benchmarks/common/references.h"

#include <vector>

namespace wedge::benchmark {

/// Pixels around which the reference is smooth. One is if all pixels of the 7x7 around it are in the image and have
/// been sampled (the reference's halves differ there: what the camera sees of lights and of the environment has no
/// noise), and the standard deviation of their luminances, the reference's noise taken out in quadrature, is at most 5
/// % of their mean. Nothing but the reference decides. Empty if there is no such pixel.
std::vector<bool> smoothRegion(const Reference& reference);

/// An RMS error over a part of the image, and the reference's noise there, likewise; radiance.
struct RegionError {
    double rmse = 0, noise = 0;
};

/// region: true for one pixel at least, of the reference's size, as the image.
RegionError regionError(const image::RgbImage& image, const Reference& reference, const std::vector<bool>& region);

} // namespace wedge::benchmark
