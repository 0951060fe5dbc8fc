#pragma once

#include "host/image/image.h"
#include "host/image/metrics.h"
#include "host/render/settings.h"

#include <string>

namespace wedge::app {

/// Reads the image to compare a frame of these settings with: of the crop's size, or of the full frame's, of which the
/// crop is then cut out; an EXR that stores a part of its frame must store that one. Throws Error for other sizes and
/// parts, and where it cannot be read.
image::RgbImage readReference(const std::string& path, const render::Settings& settings);

/// Warns on stderr where there are invalid pixels, of how many the image has in all.
void warnOfInvalidPixels(std::size_t invalid, const image::RgbImage& image);

/// "rmse 0.0123  relmse ...", one line without its end.
std::string describe(const image::Comparison& comparison);

} // namespace wedge::app
