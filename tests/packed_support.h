// Planes of pixels in fewer bits (kernels/core/packed_planes.h), made of plain ones and read back, and what rounding is
// allowed.
#pragma once

#include "kernels/shared/material.h"
#include "kernels/shared/packed.h"
#include "tests/render_support.h"

#include <cstdint>
#include <cstring>

namespace wedge::test {

/// Bits of a colour: three floats, packColour(), packFraction().
constexpr std::uint32_t plainBits = 96, colourBits = 47, fractionBits = 32;
/// Of a term's texture and value. Of lights the value is a visibility, of indirect light the texture a reflectance:
/// both are fractions. The other has any range.
constexpr std::uint32_t textureBits(bool lean, bool light)
{
    return !lean ? plainBits : light ? colourBits : fractionBits;
}
constexpr std::uint32_t valueBits(bool lean, bool light) { return textureBits(lean, !light); }

/// The 16 bits of pixel (x, y) in the first (which: 0) or second half of a plane.
template <class T>
std::uint16_t shortOf(const Planes<T>& plane, int x, int y, std::size_t which)
{
    std::uint16_t out;
    const char* bytes = reinterpret_cast<const char*>(plane.values.data());
    std::memcpy(&out, bytes + sizeof(out) * (which * plane.layout.size + plane.index(x, y)), sizeof(out));
    return out;
}

/// One of the two numbers of each pixel.
inline Planes<float> numbersOf(const Planes<float>& packed, std::size_t which)
{
    Planes<float> out(packed.layout, 1, 0.0f);
    for (int y = 0; y < static_cast<int>(packed.layout.height); ++y)
        for (int x = 0; x < static_cast<int>(packed.layout.width); ++x)
            out.at(x, y) = shared::unpackShort(shortOf(packed, x, y, which));
    return out;
}

/// Bits of a float.
inline std::uint32_t wordOf(float x)
{
    std::uint32_t out;
    std::memcpy(&out, &x, sizeof(out));
    return out;
}

/// The vectors of planes of so many bits.
inline Planes<float> coloursOf(const Planes<float>& packed, std::uint32_t bits)
{
    if (bits == plainBits)
        return packed;
    Planes<float> out(packed.layout, 3, 0.0f);
    for (int y = 0; y < static_cast<int>(packed.layout.height); ++y)
        for (int x = 0; x < static_cast<int>(packed.layout.width); ++x) {
            const std::uint32_t low = wordOf(packed.at(x, y));
            // The upper bits are in the second plane's first half.
            const shared::Vec3 c = bits == fractionBits ? shared::unpackFraction(low)
                                                        : shared::unpackColour({ low, shortOf(packed, x, y, 2) });
            out.setVector(x, y, { c.x, c.y, c.z });
        }
    return out;
}

inline Planes<float> normalsOf(const Planes<float>& packed)
{
    Planes<float> out(packed.layout, 3, 0.0f);
    for (int y = 0; y < static_cast<int>(packed.layout.height); ++y)
        for (int x = 0; x < static_cast<int>(packed.layout.width); ++x) {
            const shared::Vec3 n = shared::unpackNormal(wordOf(packed.at(x, y)));
            out.setVector(x, y, { n.x, n.y, n.z });
        }
    return out;
}

/// What is left of a number or a colour once it is packed.
inline float rounded(double x) { return shared::unpackShort(shared::packShort(static_cast<float>(x))); }
inline glm::dvec3 rounded(glm::dvec3 c, std::uint32_t bits)
{
    if (bits == plainBits)
        return c;
    const shared::Vec3 v = shared::vec3(static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z));
    const shared::Vec3 out = bits == fractionBits ? shared::unpackFraction(shared::packFraction(v))
                                                  : shared::unpackColour(shared::packColour(v));
    return { out.x, out.y, out.z };
}

/// A unit of the last place at most of numbers near to x.
inline double unitOf(double x) { return std::fabs(x) / 127; }
/// Of colours, in all channels.
inline double unitOf(glm::dvec3 c, std::uint32_t bits)
{
    const double largest = std::max({ c.x, c.y, c.z });
    return bits == plainBits ? 0 : bits == fractionBits ? std::max(largest / 255, 1e-7) : largest / 4095;
}

} // namespace wedge::test
