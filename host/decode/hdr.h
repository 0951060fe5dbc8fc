#pragma once

#include "host/decode/bytes.h"
#include "host/decode/picture.h"

#include <array>
#include <functional>
#include <span>

namespace wedge::decode {

/// Three mantissas and the exponent they share.
using Rgbe = std::array<std::uint8_t, 4>;

/// Radiance HDR: `#?RADIANCE` or `#?RGBE`, FORMAT=32-bit_rle_rgbe, rows from the top and pixels from the left (`-Y
/// +X`), flat or run-length coded in the old or the new way. EXPOSURE and the like are not looked at.
class HdrReader {
public:
    /// Reads the header. Throws Failure.
    explicit HdrReader(Bytes bytes);

    Size size() const { return size_; }

    /// Calls row(y, pixels) for each row from the top. Throws Failure where data are missing or contradict the size.
    void readRows(const std::function<void(int y, std::span<const Rgbe> pixels)>& row);

private:
    ByteReader in_;
    Size size_;
};

/// Mantissa * 2^(exponent - 136); an exponent of 0 is black.
float hdrValue(std::uint8_t mantissa, std::uint8_t exponent);

/// The picture clipped to 0 .. 1 and encoded with a gamma of 2.2, for textures, which have 8 bits.
Picture decodeHdr(Bytes bytes, const Limits& limits);

} // namespace wedge::decode
