#pragma once

#include <array>

namespace wedge::image {

using Float3 = std::array<float, 3>;

/// The colour spaces that FLIP passes through. RGB is linear Rec.709; the white is D65, xy = (0.31271, 0.32902).

/// The opponent space in which the eye filters, linear in RGB:
/// Y = 116 Y/Yn - 16, Cx = 500 (X/Xn - Y/Yn), Cz = 200 (Y/Yn - Z/Zn).
Float3 linearRgbToYCxCz(const Float3& rgb);

/// Its inverse; the result may lie outside 0 .. 1.
Float3 yCxCzToLinearRgb(const Float3& yCxCz);

/// CIE L*a*b* (1976).
Float3 linearRgbToLab(const Float3& rgb);

/// Chroma shrunk with the lightness, after Hunt, who found that colours look less colourful in dim light:
/// (L, 0.01 L a, 0.01 L b).
Float3 huntAdjusted(const Float3& lab);

/// The HyAB distance for large colour differences (Abasi, Tehran, Fairchild 2020): |dL| + sqrt(da^2 + db^2).
double hyab(const Float3& a, const Float3& b);

} // namespace wedge::image
