#include "host/image/colour.h"

#include "host/decode/srgb.h"

#include <algorithm>
#include <stdexcept>

namespace wedge::image {

float encodeSrgb(float linear) { return decode::encodeSrgb(linear); }

float decodeSrgb(float encoded) { return decode::decodeSrgb(encoded); }

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
