#pragma once

#include <array>

namespace wedge::image {

/// How radiance, which has no upper end, becomes what a display of range 0 .. 1 shows. Docs: docs/command-line.md,
/// "Pictures".
enum class View {
    Srgb, ///< as it is, clipped
    Filmic, ///< a curve for each channel, with a toe and a shoulder
    Agx, ///< a curve over stops, of channels that are mixed: bright colours fade to white
};

/// How pictures of 8 bits are made of radiance.
struct Look {
    float exposureStops = 0; ///< radiance is multiplied by 2^exposureStops first
    View view = View::Srgb;
};

/// Linear Rec.709 of the display, each 0 to 1, for linear Rec.709 of any values: NaN and what is below 0 count as 0.
std::array<float, 3> applyView(View view, const std::array<float, 3>& rgb);

} // namespace wedge::image
