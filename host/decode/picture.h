#pragma once

#include "host/decode/limits.h"

#include <cstdint>
#include <vector>

namespace wedge::decode {

constexpr std::uint32_t packRgba(unsigned r, unsigned g, unsigned b, unsigned a = 255)
{
    return r | g << 8 | b << 16 | a << 24;
}

/// 8 bits a channel, R in the low byte, as encoded in the file (sRGB). Row 0 is at the bottom, as textures want it.
struct Picture {
    Size size;
    std::vector<std::uint32_t> rgba;

    explicit Picture(Size s)
        : size(s)
        , rgba(static_cast<std::size_t>(s.pixels()))
    {
    }
    std::uint32_t* rowFromBottom(int y) { return rgba.data() + static_cast<std::size_t>(y) * size.width; }
    std::uint32_t* rowFromTop(int y) { return rowFromBottom(size.height - 1 - y); }
};

} // namespace wedge::decode
