// Re-weighting of bright samples (Zirr et al., Re-weighting Firefly Samples for Improved Finite-Sample Monte Carlo
// Estimates, 2018) in double, of samples in whatever form.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace wedge::test {

constexpr std::size_t cascades = 6;
constexpr double cascadeBase = 8;
using Cascades = std::array<double, cascades>;

/// How much of a sample of that luminance is in each cascade, in all 1: of base^j and base^(j+1) so much that the
/// inverses of the luminance and of these are in the same proportion; what is darker or brighter than all is in the
/// first or the last.
inline Cascades cascadesOf(double luminance)
{
    Cascades out {};
    const double position = std::log(std::max(luminance, 1.0)) / std::log(cascadeBase);
    const auto lower = static_cast<std::size_t>(std::floor(position + 1e-12));
    if (lower + 1 >= cascades) {
        out[cascades - 1] = 1;
        return out;
    }
    const double low = 1 / std::pow(cascadeBase, lower), high = low / cascadeBase, own = 1 / std::max(luminance, 1.0);
    out[lower] = (own - high) / (low - high);
    out[lower + 1] = 1 - out[lower];
    return out;
}

/// Adds the light of so many samples of that luminance.
inline void addLight(Cascades& light, double luminance, double count)
{
    const Cascades shares = cascadesOf(luminance);
    for (std::size_t c = 0; c < cascades; ++c)
        light[c] += count * shares[c] * luminance;
}

/// Samples of the brightness of cascade c or of one beside it.
inline double samplesAt(const Cascades& light, std::size_t c)
{
    double sum = 0;
    for (std::size_t at = c == 0 ? 0 : c - 1; at < std::min(c + 2, cascades); ++at)
        sum += light[at] / std::pow(cascadeBase, at);
    return sum;
}

/// How far cascades are trusted: half the sum of what counts say, (samples - 1) / kappa, and of what the pixel's
/// brightness so far says, in samples of the cascade's over kappa, up to the base times that where kappa is large.
/// Counts are the pixel's own where the 3x3 around it has one on average. n: samples of the pixel; around: of 3x3
/// pixels
inline Cascades trustOf(const Cascades& own, const Cascades& around, double n, double kappa, bool& uncertain)
{
    const double error = std::clamp(1 / kappa, 0.0, 1.0);
    double brightest = 1, trusted = 0;
    Cascades trust {};
    for (std::size_t c = 0; c < cascades; ++c) {
        const double near = samplesAt(around, c) / 9, count = near < 1 ? near : samplesAt(own, c);
        uncertain |= std::fabs(near - 1) < 1e-4;
        brightest = std::max(brightest, trusted / n);
        const double colour =
            brightest * n / (kappa * std::pow(cascadeBase, c)) * (cascadeBase + (1 - cascadeBase) * error);
        trust[c] = c == 0 ? 1 : std::clamp(((count - 1) / kappa + colour) / 2, 0.0, 1.0);
        trusted += trust[c] * own[c];
    }
    return trust;
}

/// What counts of a sample of that luminance.
inline double trustIn(const Cascades& trust, double luminance)
{
    const Cascades shares = cascadesOf(luminance);
    return std::inner_product(shares.begin(), shares.end(), trust.begin(), 0.0);
}

} // namespace wedge::test
