#pragma once

#include "host/decode/bytes.h"
#include "host/decode/picture.h"
#include "host/decode/primaries.h"

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

namespace wedge::decode {

/// Three mantissas and the exponent they share.
using Rgbe = std::array<std::uint8_t, 4>;

/// Radiance HDR: `#?RADIANCE` or `#?RGBE`, FORMAT=32-bit_rle_rgbe, rows from the top and pixels from the left (`-Y
/// +X`), flat or run-length coded in the old or the new way. Of its header EXPOSURE, COLORCORR and PRIMARIES are what
/// radiance() goes by (Ward, "Radiance File Formats"); a GAMMA other than 1, of programs that are not his, is refused.
class HdrReader {
public:
    /// Reads the header. Throws Failure.
    explicit HdrReader(Bytes bytes);

    Size size() const { return size_; }

    /// Calls row(y, pixels) for each row from the top. Throws Failure where data are missing or contradict the size.
    void readRows(const std::function<void(int y, std::span<const Rgbe> pixels)>& row);

    /// A channel's radiance, in the primaries of the file: its value over all EXPOSUREs and COLORCORRs, which say what
    /// the pixels were multiplied with. At most the largest float.
    float value(const Rgbe& pixel, std::size_t channel) const;

    /// What makes values colours of Rec.709, if anything does. Without PRIMARIES they are, as in most files.
    const std::optional<ColourMatrix>& matrix() const { return matrix_; }

    /// A pixel's radiance, linear Rec.709.
    std::array<float, 3> radiance(const Rgbe& pixel) const;

private:
    void readVariable(std::string_view line);

    ByteReader in_;
    Size size_;
    std::array<double, 3> multiplied_ { 1.0, 1.0, 1.0 };
    std::optional<ColourMatrix> matrix_;
    bool hasFormat_ = false;
};

/// Mantissa * 2^(exponent - 136); an exponent of 0 is black.
float hdrValue(std::uint8_t mantissa, std::uint8_t exponent);

/// The picture clipped to 0 .. 1, for textures, which have 8 bits. Colours are encoded with the sRGB curve, numbers are
/// left as they are, whatever the PRIMARIES.
Picture decodeHdrFor(TextureUse use, Bytes bytes, const Limits& limits);

/// The same for colours.
Picture decodeHdr(Bytes bytes, const Limits& limits);

} // namespace wedge::decode
