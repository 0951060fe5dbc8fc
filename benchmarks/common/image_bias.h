#pragma once

#include "host/image/image.h"

#include <vector>

namespace wedge::benchmark {

/// RMS difference between the mean of images and a reference, less what independent noise adds to it: the mean's,
/// estimated from how the images differ, and the reference's. Two images or more, all of one size.
double biasOf(const std::vector<image::RgbImage>& images, const image::RgbImage& reference, double referenceNoise);

/// Mean over pixels and channels.
double meanOf(const image::RgbImage& image);

/// Error that is left when the reference's own, which is independent of it, is taken out in quadrature.
double withoutNoise(double rmse, double noise);

} // namespace wedge::benchmark
