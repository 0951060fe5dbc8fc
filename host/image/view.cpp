#include "host/image/view.h"

#include "host/image/colour.h"

#include <algorithm>
#include <cmath>

namespace wedge::image {
namespace {

/// NaN and what is below 0 to 0, and so little that sums stay finite.
float bounded(float value) { return value > 0.0f ? std::min(value, 1e30f) : 0.0f; }

/// John Hable's curve ("Filmic Tonemapping Operators", filmicworlds.com, 2010; Uncharted 2),
/// ((x (A x + C B) + D E) / (x (A x + B) + D F)) - E / F with A = 0.15, B = 0.5, C = 0.1, D = 0.2, E = 0.02, F = 0.3,
/// over one denominator: so it is 0 at 0 to the last bit.
float hable(float x) { return x * (0.14f * x + 1.0f / 60.0f) / (x * (0.15f * x + 0.5f) + 0.06f); }

/// Twice the radiance, as its author shows it, and from his white on 1.
float filmic(float value)
{
    constexpr float bias = 2.0f, white = 11.2f;
    return hable(std::min(bias * bounded(value), white)) / hable(white);
}

/// The shares of the two other channels in each, in the order of channels; what remains to 1 is its own.
using Mixing = std::array<std::array<float, 3>, 3>;

/// By differences, so that equal channels stay equal to the last bit.
std::array<float, 3> mixed(const Mixing& shares, const std::array<float, 3>& rgb)
{
    std::array<float, 3> result = rgb;
    for (std::size_t to = 0; to < 3; ++to) {
        for (std::size_t from = 0; from < 3; ++from) {
            result[to] += shares[to][from] * (rgb[from] - rgb[to]);
        }
    }
    return result;
}

// AgX by Troy Sobotka (github.com/sobotka/AgX), with the constants of Benjamin Wrensch's fit ("Minimal AgX
// Implementation", iolite-engine.com, 2023). Shares on the diagonals follow from the others: they are within 2e-4 of
// the published ones.
constexpr Mixing inset = { { { 0.0f, 0.0784336f, 0.0792237451f }, { 0.0423282423f, 0.0f, 0.0791661275f },
    { 0.0423756549f, 0.0784336f, 0.0f } } };
constexpr Mixing outset = { { { 0.0f, -0.0980208811f, -0.0990297441f }, { -0.0528968518f, 0.0f, -0.0989611768f },
    { -0.0529716355f, -0.0980434501f, 0.0f } } };

/// A value over its range of stops, 10 below to 6.5 above middle grey (0.18), through the contrast curve: encoded for a
/// display whose exponent is 2.2.
float contrast(float value)
{
    constexpr float least = -12.47393f, most = 4.026069f;
    const float x = (std::clamp(std::log2(std::max(value, 1e-30f)), least, most) - least) / (most - least);
    return std::max(
        ((((((15.5f * x - 40.14f) * x + 31.96f) * x - 6.868f) * x + 0.4298f) * x + 0.1191f) * x) - 0.00232f, 0.0f);
}

std::array<float, 3> agx(const std::array<float, 3>& rgb)
{
    std::array<float, 3> values = mixed(inset, { bounded(rgb[0]), bounded(rgb[1]), bounded(rgb[2]) });
    std::ranges::transform(values, values.begin(), contrast);
    values = mixed(outset, values);
    std::ranges::transform(
        values, values.begin(), [](float encoded) { return std::pow(clipToDisplay(encoded), 2.2f); });
    return values;
}

} // namespace

std::array<float, 3> applyView(View view, const std::array<float, 3>& rgb)
{
    switch (view) {
    case View::Filmic:
        return { filmic(rgb[0]), filmic(rgb[1]), filmic(rgb[2]) };
    case View::Agx:
        return agx(rgb);
    case View::Srgb:
        break;
    }
    return { clipToDisplay(rgb[0]), clipToDisplay(rgb[1]), clipToDisplay(rgb[2]) };
}

} // namespace wedge::image
