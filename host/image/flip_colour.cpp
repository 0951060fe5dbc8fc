#include "host/image/flip_colour.h"

#include <cmath>

namespace wedge::image {

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// Rec.709 primaries and the white of the header, from their chromaticities.
constexpr Matrix rgbToXyz { { { 0.412386563253, 0.357591490921, 0.180450491204 },
    { 0.212636821677, 0.715182981841, 0.072180196481 }, { 0.019330620152, 0.119197163640, 0.950372587005 } } };
constexpr Matrix xyzToRgb { { { 3.241003232976, -1.537398969489, -0.498615881996 },
    { -0.969224252203, 1.875929983695, 0.041554226340 }, { 0.055639419852, -0.204011206124, 1.057148977188 } } };
constexpr std::array<double, 3> white { 0.950428545377, 1.0, 1.088900370798 };

std::array<double, 3> times(const Matrix& m, const std::array<double, 3>& v)
{
    std::array<double, 3> out {};
    for (std::size_t row = 0; row < 3; ++row)
        out[row] = m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2];
    return out;
}

// X, Y and Z as fractions of the white's.
std::array<double, 3> relativeXyz(const Float3& rgb)
{
    std::array<double, 3> xyz = times(rgbToXyz, { rgb[0], rgb[1], rgb[2] });
    for (std::size_t i = 0; i < 3; ++i)
        xyz[i] /= white[i];
    return xyz;
}

Float3 toFloat(double a, double b, double c)
{
    return { static_cast<float>(a), static_cast<float>(b), static_cast<float>(c) };
}

// The cube root of CIE 15, linear near black.
double labCurve(double t)
{
    constexpr double delta = 6.0 / 29.0;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

} // namespace

Float3 linearRgbToYCxCz(const Float3& rgb)
{
    const auto [x, y, z] = relativeXyz(rgb);
    return toFloat(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z));
}

Float3 yCxCzToLinearRgb(const Float3& yCxCz)
{
    const double y = (yCxCz[0] + 16.0) / 116.0;
    const double x = y + yCxCz[1] / 500.0;
    const double z = y - yCxCz[2] / 200.0;
    const auto [r, g, b] = times(xyzToRgb, { x * white[0], y * white[1], z * white[2] });
    return toFloat(r, g, b);
}

Float3 linearRgbToLab(const Float3& rgb)
{
    const auto [x, y, z] = relativeXyz(rgb);
    return toFloat(
        116.0 * labCurve(y) - 16.0, 500.0 * (labCurve(x) - labCurve(y)), 200.0 * (labCurve(y) - labCurve(z)));
}

Float3 huntAdjusted(const Float3& lab) { return { lab[0], 0.01f * lab[0] * lab[1], 0.01f * lab[0] * lab[2] }; }

double hyab(const Float3& a, const Float3& b)
{
    const double da = a[1] - b[1];
    const double db = a[2] - b[2];
    return std::abs(a[0] - b[0]) + std::sqrt(da * da + db * db);
}

} // namespace wedge::image
