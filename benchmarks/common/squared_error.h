#pragma once

#include "benchmarks/common/references.h"
#include "host/image/image.h"

#include <vector>

namespace wedge::benchmark {

/// Squared errors of images of one setting, with seeds of their own, against one reference, whose noise is taken out.
/// Radiance squared, means over pixels and channels.
struct SquaredError {
    double mean = 0; ///< over all pixels
    double trimmed = 0; ///< without the pixels of largest error, worstPixels of them
    double deviation =
        0; ///< standard error of `mean`, as a fraction of it, from the scatter between the seeds; 0 for one seed
    /// Standard error of `mean`, as a fraction of it, that the reference's noise is the cause of: the same for all
    /// seeds.
    double referenceDeviation = 0;
    double bias = 0; ///< mean of the images over that of the reference, less 1; 0 where both are black
    double biasDeviation = 0; ///< standard error of `bias`, likewise; 0 for one seed

    double rmse() const;
    double trimmedRmse() const;
    /// Standard error of rmse(), as a fraction of it.
    double rmseDeviation() const { return 0.5 * deviation; }
    double rmseReferenceDeviation() const { return 0.5 * referenceDeviation; }
};

/// The fraction of an image's pixels that `trimmed` leaves out.
inline constexpr double worstPixels = 0.005;

/// images: one or more, of the reference's size. What is left of an error when the noise is out is never less than a
/// hundredth of what was there: noise is not known better.
SquaredError squaredError(const std::vector<image::RgbImage>& images, const Reference& reference);

} // namespace wedge::benchmark
