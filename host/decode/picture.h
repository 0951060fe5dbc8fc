#pragma once

#include "host/decode/limits.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace wedge::decode {

constexpr std::uint32_t packRgba(unsigned r, unsigned g, unsigned b, unsigned a = 255)
{
    return r | g << 8 | b << 16 | a << 24;
}

/// What the texels of a texture stand for.
enum class TextureUse {
    Colours, ///< which are encoded with the sRGB curve, whatever curve the file has
    Numbers, ///< plain ones: roughness, normals, heights, opacity
};

/// 8 bits a channel, R in the low byte. Row 0 is at the bottom, as textures want it.
struct Picture {
    Size size;
    std::vector<std::uint32_t> rgba;
    bool sameForAllUses = true; ///< false where the file's colours are not those of sRGB

    explicit Picture(Size s)
        : size(s)
        , rgba(static_cast<std::size_t>(s.pixels()))
    {
    }
    std::uint32_t* rowFromBottom(int y) { return rgba.data() + static_cast<std::size_t>(y) * size.width; }
    std::uint32_t* rowFromTop(int y) { return rowFromBottom(size.height - 1 - y); }
};

/// Many programs leave the byte of the alpha 0 in all pixels, and mean an opaque picture.
inline void makeOpaqueIfEmpty(Picture& picture)
{
    constexpr std::uint32_t opaque = 0xff000000;
    if (std::all_of(picture.rgba.begin(), picture.rgba.end(), [](std::uint32_t p) { return (p & opaque) == 0; })) {
        for (std::uint32_t& pixel : picture.rgba)
            pixel |= opaque;
    }
}

} // namespace wedge::decode
