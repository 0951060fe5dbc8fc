#pragma once

#include "host/image/image.h"

namespace wedge::benchmark {

/// The image under a Gaussian of that standard deviation in pixels, cut at three, weights renormalised at borders. 0 or
/// less: the image itself.
image::RgbImage blurred(const image::RgbImage& image, double sigma);

} // namespace wedge::benchmark
