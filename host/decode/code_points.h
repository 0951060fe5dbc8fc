#pragma once

#include "host/decode/primaries.h"

#include <array>
#include <cstdint>

namespace wedge::decode {

/// A colour space by numbers (ITU-T H.273): primaries, transfer curve, matrix, and whether the range is full.
struct CodePoints {
    Primaries primaries;
    double gamma = 0.0; ///< of the encoding, or 0 where it is sRGB's

    /// Throws Failure for those that no image of red, green and blue from 0 to 1 has.
    explicit CodePoints(const std::array<std::uint8_t, 4>& codes);
};

} // namespace wedge::decode
