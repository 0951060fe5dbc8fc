// A camera with lens and shutter before textured lines, in two dimensions and double precision: by brute force, rays
// traced from the lens through the plane in focus. For tests of the frequency analysis.
#pragma once

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace wedge::test {

/// The shape of lens or shutter over one axis.
enum class Profile { Uniform, Gaussian };

/// Points over one axis and their weights, which sum to 1.
struct Nodes {
    std::vector<double> at, weight;
};

/// Midpoints over [-extent, extent] with the weights of a Gaussian of that deviation, or equal ones (deviation 0).
inline Nodes midpoints(double extent, double deviation, int count)
{
    Nodes nodes;
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const double x = extent * ((2 * i + 1.0) / count - 1);
        nodes.at.push_back(x);
        nodes.weight.push_back(deviation > 0 ? std::exp(-x * x / (2 * deviation * deviation)) : 1);
        sum += nodes.weight.back();
    }
    for (double& w : nodes.weight)
        w /= sum;
    return nodes;
}

/// Lens positions u, 1 at the lens' rim; Gaussians have a deviation of 1/2 and, so that closed forms hold, no rim.
inline Nodes lensNodes(Profile profile, int count)
{
    return profile == Profile::Uniform ? midpoints(1, 0, count) : midpoints(2.5, 0.5, count);
}

/// Times about the middle of the shutter, which is open from -1/2 to 1/2; Gaussians have a deviation of 1/4.
inline Nodes shutterNodes(Profile profile, int count)
{
    return profile == Profile::Uniform ? midpoints(0.5, 0, count) : midpoints(1.25, 0.25, count);
}

/// Deviations of the above: u of a uniform lens has 1/sqrt 3, t of a box shutter 1/sqrt 12.
inline double lensDeviation(Profile profile) { return profile == Profile::Uniform ? 1 / std::sqrt(3.0) : 0.5; }
inline double shutterDeviation(Profile profile) { return lensDeviation(profile) / 2; }

struct FlatCamera {
    double apertureRadius = 0.02, focusDistance = 3, pixelStep = 0.001;

    /// Where the ray of pixel x and lens position u meets the line at depth z: metres, (5.1) by tracing.
    double landing(double x, double u, double depth) const
    {
        const double onLens = apertureRadius * u, inFocus = x * pixelStep * focusDistance;
        return onLens + (inFocus - onLens) * depth / focusDistance;
    }
    /// Depth at which the circle of confusion is r pixels.
    double depthOf(double r) const { return 1 / (r * pixelStep / apertureRadius + 1 / focusDistance); }
};

/// A line at some depth that moves along itself: what it shows is a function of metres at the middle of the shutter.
struct FlatSurface {
    double depth = 1, velocity = 0; ///< metres, metres a shutter
    std::function<double(double)> shown;

    double seen(const FlatCamera& camera, double x, double u, double t) const
    {
        return shown(camera.landing(x, u, depth) - velocity * t);
    }
};

/// A surface whose circle of confusion is r pixels and whose image moves by v of them; `shown` in pixels.
inline FlatSurface surfaceOf(const FlatCamera& camera, double r, double v, std::function<double(double)> shown)
{
    const double depth = camera.depthOf(r), pixel = depth * camera.pixelStep;
    return { depth, v * pixel, [=](double metres) { return shown(metres / pixel); } };
}

/// The pixel's integral over lens and shutter.
inline double integrated(
    const FlatCamera& camera, const FlatSurface& surface, double x, const Nodes& lens, const Nodes& shutter)
{
    double sum = 0;
    for (std::size_t i = 0; i < lens.at.size(); ++i)
        for (std::size_t j = 0; j < shutter.at.size(); ++j)
            sum += lens.weight[i] * shutter.weight[j] * surface.seen(camera, x, lens.at[i], shutter.at[j]);
    return sum;
}

/// A periodic texture of all frequencies up to 1/2 a pixel, equal amplitudes and random phases, mean 0, deviation 1.
class WhiteTexture {
public:
    explicit WhiteTexture(std::size_t pixels, unsigned seed)
        : period_(static_cast<double>(pixels))
        , table_(pixels * finer)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi);
        const double amplitude = std::sqrt(2.0 / (period_ / 2 - 1));
        for (std::size_t k = 1; k < pixels / 2; ++k) {
            const std::complex<double> turn =
                std::polar(1.0, 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(table_.size()));
            std::complex<double> wave = std::polar(amplitude, phase(random));
            for (double& value : table_) {
                value += wave.real();
                wave *= turn;
            }
        }
    }
    double operator()(double pixel) const
    {
        const double wrapped = (pixel / period_ - std::floor(pixel / period_)) * static_cast<double>(table_.size());
        const auto at = static_cast<std::size_t>(wrapped);
        const double between = wrapped - static_cast<double>(at);
        return table_[at % table_.size()] * (1 - between) + table_[(at + 1) % table_.size()] * between;
    }

private:
    static constexpr std::size_t finer = 32; ///< entries a pixel
    double period_;
    std::vector<double> table_;
};

/// A periodic line of pixels under a Gaussian kernel of that deviation in pixels.
inline std::vector<double> gaussianFiltered(const std::vector<double>& line, double deviation)
{
    const int n = static_cast<int>(line.size()), radius = static_cast<int>(std::ceil(5 * deviation));
    std::vector<double> out;
    for (int i = 0; i < n; ++i) {
        double sum = 0, weights = 0;
        for (int d = -radius; d <= radius; ++d) {
            const double w = d == 0 ? 1 : std::exp(-d * d / (2 * deviation * deviation));
            sum += w * line[static_cast<std::size_t>(((i + d) % n + n) % n)];
            weights += w;
        }
        out.push_back(sum / weights);
    }
    return out;
}

inline double rmsDifference(const std::vector<double>& a, const std::vector<double>& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

} // namespace wedge::test
