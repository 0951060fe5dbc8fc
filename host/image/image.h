#pragma once

#include "host/window.h"

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace wedge::image {

/// One named channel, row-major with y down, over the data window of the image that holds it.
struct Channel {
    /// The full EXR name, layer and channel: "R", "albedo.R", "depth.Z", "objectId.I".
    std::string name;
    std::vector<float> values;
    /// Stored as UINT in the file. Values are then rounded and clamped to 0 .. 2^32 - 1, NaN to 0; whole numbers up to
    /// 2^24 survive exactly.
    bool integer = false;
};

using wedge::Window;

/// The 16 floats are a matrix in the order in which OpenEXR stores it: rows first, for row vectors (v * M), so that the
/// translation is in elements 12, 13 and 14. A matrix for column vectors is transposed before it comes here.
using MetadataValue = std::variant<std::string, float, int, std::array<float, 16>>;

/// What a render writes: channels over a data window inside a full frame, and what is known about them.
struct LayeredImage {
    /// Size of the full frame (the display window), in pixels.
    int width = 0;
    int height = 0;
    /// The part of the frame that the channels hold (the data window); the whole frame where nothing is cropped.
    Window window;
    std::vector<Channel> channels;
    std::map<std::string, MetadataValue> metadata;

    /// The channel of that full name, or nullptr.
    const Channel* find(std::string_view name) const;
};

/// Linear Rec.709 colour, interleaved r, g, b, row-major with y down: width * height * 3 floats.
struct RgbImage {
    int width = 0;
    int height = 0;
    std::vector<float> rgb;
};

/// The channels that are the root colour: R, G and B, or Y three times.
/// Throws Error, which calls the image by the name given, where it has neither, or Y with chroma (RY, BY).
std::array<const Channel*, 3> beautyChannels(const LayeredImage& image, const std::string& name);

/// The root colour of the image over its data window: channels R, G and B, or Y alone as a gray.
/// Throws Error as beautyChannels.
RgbImage beauty(const LayeredImage& image, const std::string& name = "image");

} // namespace wedge::image
