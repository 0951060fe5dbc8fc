#include "host/image/colour.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace wedge::image {

float encodeSrgb(float linear)
{
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float decodeSrgb(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

std::vector<float> displayReferred(const RgbImage& image)
{
    std::vector<float> encoded(image.rgb.size());
    std::transform(image.rgb.begin(), image.rgb.end(), encoded.begin(),
        [](float value) { return encodeSrgb(clipToDisplay(value)); });
    return encoded;
}

void requireConsistent(const RgbImage& image)
{
    if (image.width <= 0 || image.height <= 0
        || image.rgb.size() != static_cast<std::size_t>(image.width) * image.height * 3)
        throw std::logic_error("image is empty or its size does not match its values");
}

} // namespace wedge::image
