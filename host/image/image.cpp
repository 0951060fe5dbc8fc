#include "host/image/image.h"

#include "host/error.h"

#include <algorithm>

namespace wedge::image {

namespace {

std::string listOfChannels(const LayeredImage& image)
{
    std::string list;
    for (const Channel& channel : image.channels)
        list += (list.empty() ? "" : ", ") + channel.name;
    return list.empty() ? "none" : list;
}

} // namespace

const Channel* LayeredImage::find(std::string_view name) const
{
    const auto found =
        std::find_if(channels.begin(), channels.end(), [&](const Channel& channel) { return channel.name == name; });
    return found == channels.end() ? nullptr : &*found;
}

std::array<const Channel*, 3> beautyChannels(const LayeredImage& image, const std::string& name)
{
    const Channel* gray = image.find("Y");
    const Channel* red = image.find("R");
    const Channel* green = image.find("G");
    const Channel* blue = image.find("B");
    if (red && green && blue)
        return { red, green, blue };
    if (red || green || blue || !gray)
        throw Error(name + " has no colour at its root, its channels are", listOfChannels(image),
            "use an image with the channels R, G and B");
    if (image.find("RY") || image.find("BY"))
        throw Error(
            name + " stores luminance and chroma, its channels are", listOfChannels(image), "convert it to R, G and B");
    return { gray, gray, gray };
}

RgbImage beauty(const LayeredImage& image, const std::string& name)
{
    const auto [red, green, blue] = beautyChannels(image, name);
    RgbImage result { image.window.width(), image.window.height(), {} };
    result.rgb.reserve(red->values.size() * 3);
    for (std::size_t i = 0; i < red->values.size(); ++i) {
        result.rgb.push_back(red->values[i]);
        result.rgb.push_back(green->values[i]);
        result.rgb.push_back(blue->values[i]);
    }
    return result;
}

} // namespace wedge::image
