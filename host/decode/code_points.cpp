#include "host/decode/code_points.h"

#include "host/decode/failure.h"

#include <string>

namespace wedge::decode {

namespace {

/// Those of ITU-T H.273 that images have.
Primaries primariesOf(unsigned code)
{
    constexpr Chromaticity d65 = rec709.white;
    switch (code) {
    case 1: // Rec.709
    case 2: // not stated
        return rec709;
    case 5: // Rec.601 of 625 lines
        return { { 0.64, 0.33 }, { 0.29, 0.60 }, { 0.15, 0.06 }, d65 };
    case 6: // of 525 lines
    case 7:
        return { { 0.630, 0.340 }, { 0.310, 0.595 }, { 0.155, 0.070 }, d65 };
    case 9: // Rec.2020, Rec.2100
        return { { 0.708, 0.292 }, { 0.170, 0.797 }, { 0.131, 0.046 }, d65 };
    case 11: // P3 of cinemas
        return { { 0.680, 0.320 }, { 0.265, 0.690 }, { 0.150, 0.060 }, { 0.314, 0.351 } };
    case 12: // P3 of displays
        return { { 0.680, 0.320 }, { 0.265, 0.690 }, { 0.150, 0.060 }, d65 };
    default:
        throw Failure("its cICP chunk has primaries (" + std::to_string(code) + ") that are not read",
            "save it with those of sRGB");
    }
}

/// As CodePoints::gamma. The camera curves of video count as sRGB, which shows them as they are meant.
double gammaOf(unsigned code)
{
    switch (code) {
    case 1: // Rec.709 and its like
    case 2: // not stated
    case 6:
    case 13: // sRGB
    case 14:
    case 15:
        return 0.0;
    case 4:
        return 1.0 / 2.2;
    case 5:
        return 1.0 / 2.8;
    case 8:
        return 1.0;
    default: // PQ and HLG among them, which have no range of 0 to 1
        throw Failure("its cICP chunk has a transfer curve (" + std::to_string(code) + ") that is not read",
            "save it as EXR, or with the curve of sRGB");
    }
}

} // namespace

CodePoints::CodePoints(const std::array<std::uint8_t, 4>& codes)
    : primaries(primariesOf(codes[0]))
    , gamma(gammaOf(codes[1]))
{
    if (codes[2] != 0 || codes[3] != 1)
        throw Failure("its cICP chunk says that it is no RGB of full range", "save it as RGB of full range");
}

} // namespace wedge::decode
