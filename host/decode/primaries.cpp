#include "host/decode/primaries.h"

#include "host/decode/failure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace wedge::decode {

namespace {

using Vector = std::array<double, 3>;

Vector times(const ColourMatrix& m, const Vector& v)
{
    Vector out {};
    for (std::size_t row = 0; row < 3; ++row)
        out[row] = m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2];
    return out;
}

ColourMatrix times(const ColourMatrix& a, const ColourMatrix& b)
{
    ColourMatrix out {};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            for (std::size_t i = 0; i < 3; ++i)
                out[row][column] += a[row][i] * b[i][column];
    return out;
}

ColourMatrix diagonal(const Vector& v) { return { { { v[0], 0, 0 }, { 0, v[1], 0 }, { 0, 0, v[2] } } }; }

[[noreturn]] void failAsNoColours()
{
    throw Failure("its primaries span no colours", "convert the image to Rec.709 (sRGB) primaries");
}

ColourMatrix inverse(const ColourMatrix& m)
{
    ColourMatrix out {};
    for (std::size_t row = 0; row < 3; ++row) {
        const std::size_t r1 = (row + 1) % 3, r2 = (row + 2) % 3;
        for (std::size_t column = 0; column < 3; ++column) {
            const std::size_t c1 = (column + 1) % 3, c2 = (column + 2) % 3;
            out[column][row] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]; // the cofactor
        }
    }
    const double determinant = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
    if (!(std::abs(determinant) > 1e-6))
        failAsNoColours();
    for (auto& row : out)
        for (double& value : row)
            value /= determinant;
    return out;
}

/// Of luminance 1.
Vector xyzOf(const Chromaticity& c)
{
    if (!(c.y > 1e-3 && c.y <= 1.0 && c.x >= 0.0 && c.x <= 1.0))
        failAsNoColours();
    return { c.x / c.y, 1.0, (1.0 - c.x - c.y) / c.y };
}

/// RGB to XYZ, white to luminance 1 (SMPTE RP 177).
ColourMatrix toXyz(const Primaries& p)
{
    ColourMatrix colours {};
    const std::array<Chromaticity, 3> columns { p.red, p.green, p.blue };
    for (std::size_t i = 0; i < 3; ++i) {
        const Chromaticity& c = columns[i];
        if (!(std::abs(c.x) <= 10.0 && std::abs(c.y) <= 10.0)) // some are beyond the visible: ACES has y = -0.077
            failAsNoColours();
        colours[0][i] = c.x;
        colours[1][i] = c.y;
        colours[2][i] = 1.0 - c.x - c.y;
    }
    return times(colours, diagonal(times(inverse(colours), xyzOf(p.white))));
}

/// XYZ under one neutral colour to XYZ under another (Lam, Metamerism and Colour Constancy, 1985: Bradford).
ColourMatrix adaptation(const Chromaticity& from, const Chromaticity& to)
{
    constexpr ColourMatrix cones { { { 0.8951, 0.2664, -0.1614 }, { -0.7502, 1.7135, 0.0367 },
        { 0.0389, -0.0685, 1.0296 } } };
    const Vector before = times(cones, xyzOf(from)), after = times(cones, xyzOf(to));
    return times(
        inverse(cones), times(diagonal({ after[0] / before[0], after[1] / before[1], after[2] / before[2] }), cones));
}

bool near(const Chromaticity& a, const Chromaticity& b)
{
    constexpr double rounding = 1e-3;
    return std::abs(a.x - b.x) < rounding && std::abs(a.y - b.y) < rounding;
}

} // namespace

std::optional<ColourMatrix> matrixToRec709(const Primaries& p, const std::optional<Chromaticity>& neutral)
{
    if (p == Primaries {})
        return std::nullopt;
    const bool isXyz = near(p.red, { 1, 0 }) && near(p.green, { 0, 1 }) && near(p.blue, { 0, 0 });
    const Chromaticity grey = neutral.value_or(isXyz ? rec709.white : p.white);
    if (near(p.red, rec709.red) && near(p.green, rec709.green) && near(p.blue, rec709.blue)
        && near(p.white, rec709.white) && near(grey, rec709.white))
        return std::nullopt;
    const ColourMatrix matrix = times(inverse(toXyz(rec709)), times(adaptation(grey, rec709.white), toXyz(p)));
    for (const auto& row : matrix)
        for (const double factor : row)
            if (!(std::abs(factor) < 1e6))
                failAsNoColours();
    return matrix;
}

std::array<float, 3> converted(const ColourMatrix& matrix, const std::array<float, 3>& rgb)
{
    constexpr double most = std::numeric_limits<float>::max();
    if (!std::isfinite(rgb[0]) || !std::isfinite(rgb[1]) || !std::isfinite(rgb[2]))
        return rgb;
    const Vector out = times(matrix, Vector { rgb[0], rgb[1], rgb[2] });
    std::array<float, 3> result {};
    for (std::size_t c = 0; c < 3; ++c)
        result[c] = static_cast<float>(std::clamp(out[c], -most, most));
    return result;
}

void convert(const ColourMatrix& matrix, std::span<float> rgb)
{
    for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
        const std::array<float, 3> colour = converted(matrix, { rgb[i], rgb[i + 1], rgb[i + 2] });
        std::copy(colour.begin(), colour.end(), rgb.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

} // namespace wedge::decode
