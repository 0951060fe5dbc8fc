#pragma once

#include "host/image/image.h"

#include <string>

namespace wedge::image {

/// Reads the colour of an image file as linear Rec.709, the format told by the extension in either case: .exr (root
/// R, G, B over the data window), .png (decoded from sRGB), .hdr (Radiance).
/// Throws Error for other extensions and for files that cannot be read.
RgbImage readImage(const std::string& path);

} // namespace wedge::image
