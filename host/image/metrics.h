#pragma once

#include "host/image/image.h"

#include <cstddef>
#include <vector>

namespace wedge::image {

class ImageFile;

/// All metrics take linear images of one size, the image first and the reference second, and throw Error with both
/// sizes where these differ. A pixel with a NaN or infinite channel in either image is invalid: rmse, relMse and psnr
/// leave it out (and are NaN where no pixel is left), while ssim and flip, which look at neighbourhoods, see it as a
/// display shows it (clipped, NaN black). countInvalidPixels() counts them.

/// Root of the mean over pixels and channels of (a - b)^2, on linear values.
double rmse(const RgbImage& image, const RgbImage& reference);

/// Mean over pixels and channels of (a - b)^2 / (b^2 + 0.01), b the reference, on linear values: the relative squared
/// error usual in adaptive rendering (Rousselle, Knaus, Zwicker, "Adaptive Sampling and Reconstruction using Greedy
/// Error Minimization", 2011), with 0.01 to tame the dark.
double relMse(const RgbImage& image, const RgbImage& reference);

/// Peak signal-to-noise ratio in dB, -10 log10(mean (a - b)^2), on display-referred values (clipped to 0 .. 1, sRGB
/// curve), so that the peak is 1 and a highlight beyond the display's white does not count. +inf for equal images.
double psnr(const RgbImage& image, const RgbImage& reference);

/// Mean structural similarity (Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to
/// Structural Similarity", 2004) of the display-referred luma 0.2126 R' + 0.7152 G' + 0.0722 B':
///   (2 mu_a mu_b + C1) (2 cov_ab + C2) / ((mu_a^2 + mu_b^2 + C1) (var_a + var_b + C2)),
/// C1 = 0.01^2, C2 = 0.03^2, moments under an 11x11 Gaussian of sigma 1.5, averaged over the windows that lie inside
/// the image. Along an axis shorter than 11 pixels the windows are cut at the border and their weights renormalised.
/// 1 for equal images.
double ssim(const RgbImage& image, const RgbImage& reference);

/// Error in 0 .. 1 per pixel, row-major, and its mean.
struct FlipResult {
    double mean = 0.0;
    int width = 0;
    int height = 0;
    std::vector<float> error;
};

/// LDR-FLIP, the difference that a viewer sees when flipping between the images (Andersson et al., "FLIP: A Difference
/// Evaluator for Alternating Images", 2020), on values clipped to 0 .. 1. pixelsPerDegree (positive) is the viewing
/// condition; 67 is a 0.7 m wide display of 3840 pixels seen from 0.7 m. Equations and constants: flip.cpp.
FlipResult flip(const RgbImage& image, const RgbImage& reference, double pixelsPerDegree = 67.0);

/// All of the above, and how many pixels are invalid.
struct Comparison {
    double rmse = 0.0;
    double relMse = 0.0;
    double psnr = 0.0;
    double ssim = 0.0;
    double flip = 0.0;
    std::size_t invalidPixels = 0;
};
Comparison compare(const RgbImage& image, const RgbImage& reference);

/// The number of pixels that are invalid in either image.
std::size_t countInvalidPixels(const RgbImage& image, const RgbImage& reference);

/// Throws Error with both sizes where they differ, and std::logic_error where an image is empty or contradicts itself.
void requireSameSize(const RgbImage& image, const RgbImage& reference);

/// The parts of two files that show the same pixels.
struct ComparedParts {
    Window image, reference;
    bool isLess = false; ///< one of the files stores more of the frame
};

/// Of pictures of one size what both store of them: all, a crop, or what two crops have in common. Of others what is
/// stored, where it is of one size: a crop that knows its frame beside one that does not. Throws Error with both sizes,
/// or windows, where there is no such part.
ComparedParts comparedParts(const ImageFile& image, const ImageFile& reference);

} // namespace wedge::image
