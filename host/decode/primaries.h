#pragma once

#include <array>
#include <optional>
#include <span>

namespace wedge::decode {

/// CIE x and y of a colour.
struct Chromaticity {
    double x = 0.0, y = 0.0;
    bool operator==(const Chromaticity&) const = default;
};

/// Which colours the channels of an image stand for, and which colour equal channels are.
struct Primaries {
    Chromaticity red, green, blue, white;
    bool operator==(const Primaries&) const = default;
};

/// Those of Rec.709 and sRGB, with white D65: what all images are when they have been read.
constexpr Primaries rec709 { { 0.64, 0.33 }, { 0.30, 0.60 }, { 0.15, 0.06 }, { 0.3127, 0.3290 } };

/// Rows of factors of linear red, green and blue.
using ColourMatrix = std::array<std::array<double, 3>, 3>;

/// What makes linear colours of these primaries colours of Rec.709, or nothing where they already are (within 0.001,
/// since files round) or all are 0, as programs write that know none. The neutral colour becomes D65, by Bradford's
/// adaptation as of ICC profiles and of OpenEXR's reader for ACES, so that greys stay grey. neutral: by default the
/// white, of XYZ itself D65. Throws Failure where the primaries span no colours.
std::optional<ColourMatrix> matrixToRec709(
    const Primaries& primaries, const std::optional<Chromaticity>& neutral = std::nullopt);

/// The colour in Rec.709; one that is not finite stays as it is.
std::array<float, 3> converted(const ColourMatrix& matrix, const std::array<float, 3>& rgb);

/// All of an image's, interleaved.
void convert(const ColourMatrix& matrix, std::span<float> rgb);

} // namespace wedge::decode
