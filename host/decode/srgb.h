#pragma once

#include <cmath>
#include <cstdint>

namespace wedge::decode {

/// The sRGB curve (IEC 61966-2-1): a linear value in 0 .. 1 to the encoded one in 0 .. 1.
inline float encodeSrgb(float linear)
{
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// Its inverse.
inline float decodeSrgb(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// A value, clipped to 0 .. 1, as 8 bits.
inline std::uint8_t byteOf(float value)
{
    const float clipped = value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f;
    return static_cast<std::uint8_t>(clipped * 255.0f + 0.5f);
}

} // namespace wedge::decode
