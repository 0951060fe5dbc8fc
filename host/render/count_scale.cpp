#include "host/render/count_scale.h"

#include "kernels/shared/wedge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace wedge::render {
namespace {

/// Samples of all pixels, where those have `scale` times what they ask for, `most` at most.
double samplesAt(float scale, const AskedSamples& asked, float most, const PlaneLayout& frame)
{
    double sum = 0;
    std::vector<float> added((frame.width + WEDGE_TILE - 1) / WEDGE_TILE);
    for (std::uint32_t top = 0; top < frame.height; top += WEDGE_TILE) {
        std::ranges::fill(added, 0.0f);
        for (std::uint32_t y = top; y < std::min(top + WEDGE_TILE, frame.height); ++y) {
            const std::size_t row = shared::pixelIndex(0, y, frame.stride);
            float before = 0;
            for (std::size_t x = 0; x < frame.width; ++x) {
                const float wanted = std::clamp(scale * asked.values[row + x], asked.least, most);
                const auto taken = static_cast<float>(asked.taken[row + x]);
                before += taken;
                added[x / WEDGE_TILE] += std::max(wanted - taken, 0.0f);
            }
            sum += before;
        }
        for (const float tile : added) {
            sum += std::min(tile, asked.room);
        }
    }
    return sum;
}

/// Even counts are not asked for a smaller gain, in parts of the whole variance: what tells of it is noisy.
constexpr double leastGain = 0.1;

/// Calls add(uncertainty, samples) for pixels that have some of that, with the samples they have in the end.
template <typename Add>
void forCounts(const AskedSamples& asked, float scale, float most, const PlaneLayout& frame, const Add& add)
{
    for (std::uint32_t y = 0; y < frame.height; ++y) {
        const std::size_t row = shared::pixelIndex(0, y, frame.stride);
        for (std::size_t i = row; i < row + frame.width; ++i) {
            const float n = std::clamp(scale * asked.values[i], asked.least, most);
            add(asked.uncertainty[i], std::max(n, static_cast<float>(asked.taken[i])));
        }
    }
}

} // namespace

float scaleOf(std::span<const AskedSamples> asked, double budget, float most, const PlaneLayout& frame)
{
    double low = 1e-12, high = 1e12;
    for (int step = 0; step < 40; ++step) {
        const double scale = std::sqrt(low * high);
        double rays = 0;
        for (const AskedSamples& one : asked) {
            rays += one.rays * samplesAt(static_cast<float>(scale), one, most, frame);
        }
        (rays > budget ? high : low) = scale;
    }
    return static_cast<float>(low);
}

EvenCounts evenCounts(std::span<const AskedSamples> asked, float scale, float most, const PlaneLayout& frame)
{
    EvenCounts out;
    double sum = 0, all = 0;
    forCounts(asked[0], scale, most, frame, [&](float, float n) { sum += n; });
    const double mean = sum / (static_cast<double>(frame.width) * frame.height);
    constexpr std::array<double, 5> shares { 0, 0.25, 0.5, 0.75, 1 };
    std::array<double, shares.size()> variances {};
    for (const AskedSamples& one : asked) {
        forCounts(one, scale, most, frame, [&](float uncertainty, float n) {
            const double variance = uncertainty > 0 ? double { uncertainty } * one.rays : 0.0;
            all += variance / n;
            for (std::size_t i = 0; variance > 0 && &one == asked.data() && i < shares.size(); ++i) {
                variances[i] += variance / (n + shares[i] * (mean - n));
            }
        });
    }
    const std::size_t best = static_cast<std::size_t>(std::ranges::min_element(variances) - variances.begin());
    if (variances[0] - variances[best] > leastGain * all) {
        out.share = static_cast<float>(shares[best]);
        out.mean = static_cast<float>(mean);
    }
    return out;
}

} // namespace wedge::render
