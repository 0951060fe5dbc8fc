#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace wedge::image {

/// True for the attributes through which OpenEXR describes the file itself. They are not metadata: a string named
/// "version", say, makes the file unreadable for others.
inline bool isFormatAttribute(std::string_view name)
{
    constexpr std::array<std::string_view, 19> names = { "channels", "compression", "dataWindow", "displayWindow",
        "lineOrder", "pixelAspectRatio", "tiles", "type", "name", "screenWindowCenter", "screenWindowWidth",
        "chunkCount", "version", "view", "multiView", "chromaticities", "preview", "maxSamplesPerPixel",
        "deepImageState" };
    return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace wedge::image
