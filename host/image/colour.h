#pragma once

#include "host/image/image.h"

namespace wedge::image {

/// The sRGB curve (IEC 61966-2-1): a linear value in 0 .. 1 to the encoded one in 0 .. 1.
float encodeSrgb(float linear);

/// Its inverse.
float decodeSrgb(float encoded);

/// What a display of range 0 .. 1 shows of a linear value: clipped, NaN to 0.
inline float clipToDisplay(float value) { return value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f; }

/// The values as a display shows them: clipped and encoded with the sRGB curve. Size as image.rgb.
std::vector<float> displayReferred(const RgbImage& image);

/// Throws std::logic_error where image.rgb does not have 3 * width * height values or the image is empty.
void requireConsistent(const RgbImage& image);

} // namespace wedge::image
