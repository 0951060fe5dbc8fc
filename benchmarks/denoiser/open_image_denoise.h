#pragma once

#include "host/image/image.h"

#include <string>
#include <utility>

namespace wedge::benchmark {

/// An image as a denoiser wants it: linear radiance, and what is seen, means over each pixel.
struct GuidedImage {
    image::RgbImage color, albedo, normal;
};

/// Of a frame that has the layers albedo and normal.
GuidedImage guidedImage(const image::LayeredImage& frame);

/// A denoised image, and what that took: milliseconds of the host's clock, the median of three, without loading.
struct Denoised {
    image::RgbImage image;
    double milliseconds = 0;
};

/// Open Image Denoise as PyPI's pyoidn has it, through a Python interpreter.
class OpenImageDenoise {
public:
    /// python: the interpreter's name or path.
    explicit OpenImageDenoise(std::string python)
        : python_(std::move(python))
    {
    }

    /// Whether the interpreter is there and finds pyoidn.
    bool available() const;

    /// Throws Error where it fails.
    Denoised denoise(const GuidedImage& image) const;

private:
    std::string python_;
};

} // namespace wedge::benchmark
