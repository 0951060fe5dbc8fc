// How wide a Gaussian kernel may be after a lens or a shutter: what it takes from textures and edges, for each profile,
// and what is best against noise. From the profiles' transforms, no images. No device.
#include "kernels/shared/defocus.h"
#include "tests/flatland.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

using namespace wedge::test;

namespace {

constexpr double pi = std::numbers::pi;

/// The transform of a profile of half-extent 1, its dimensions, and its edge: the integral up to x.
struct Shape {
    std::string name;
    int dimensions;
    std::function<double(double)> transform, edge;
};

double discTransform(double w) { return w < 1e-6 ? 1 : 2 * std::cyl_bessel_j(1, w) / w; }
double boxTransform(double w) { return w < 1e-6 ? 1 : std::sin(w) / w; }
/// Gaussians end at 2 deviations, that is at 1.
double gaussianDiscTransform(double w)
{
    double sum = 0, all = 0;
    for (double p = 0.005; p < 1; p += 0.01) {
        sum += p * std::exp(-2 * p * p) * std::cyl_bessel_j(0, w * p);
        all += p * std::exp(-2 * p * p);
    }
    return sum / all;
}
double gaussianLineTransform(double w)
{
    double sum = 0, all = 0;
    for (double p = 0.0025; p < 1; p += 0.005) {
        sum += std::exp(-2 * p * p) * std::cos(w * p);
        all += std::exp(-2 * p * p);
    }
    return sum / all;
}
double discEdge(double x)
{
    const double u = std::clamp(x, -1.0, 1.0);
    return 0.5 + (u * std::sqrt(1 - u * u) + std::asin(u)) / pi;
}
double boxEdge(double x) { return std::clamp(0.5 + 0.5 * x, 0.0, 1.0); }
double gaussianLineEdge(double x)
{
    return 0.5 + 0.5 * std::erf(std::clamp(x, -1.0, 1.0) * std::sqrt(2.0)) / std::erf(std::sqrt(2.0));
}
double gaussianDiscEdge(double x)
{
    const double from = std::clamp(x, -1.0, 1.0);
    double below = 0, all = 0;
    for (double p = -0.9975; p < 1; p += 0.005) { // a chord's mass is exp(-2 p^2) erf(sqrt(2 (1 - p^2)))
        const double mass = std::exp(-2 * p * p) * std::erf(std::sqrt(2 * (1 - p * p)));
        all += mass;
        below += mass * std::clamp((from - p) / 0.005 + 0.5, 0.0, 1.0);
    }
    return below / all;
}

const std::array<Shape, 4> shapes = { { { "uniform lens", 2, discTransform, discEdge },
    { "Gaussian lens", 2, gaussianDiscTransform, gaussianDiscEdge }, { "box shutter", 1, boxTransform, boxEdge },
    { "Gaussian shutter", 1, gaussianLineTransform, gaussianLineEdge } } };

/// Energies of a shape's spectrum in bins of `step`, and how many of them hold 90 % up to `end`.
struct Spectrum {
    static constexpr double step = 0.02, end = 200;
    std::vector<double> energies;
    std::size_t band = 0;
};

Spectrum spectrumOf(const Shape& shape)
{
    Spectrum out;
    double all = 0, below = 0;
    for (double w = Spectrum::step / 2; w < Spectrum::end; w += Spectrum::step) {
        out.energies.push_back(std::pow(shape.transform(w), 2) * (shape.dimensions == 2 ? w : 1));
        all += out.energies.back();
    }
    while (below < 0.9 * all)
        below += out.energies[out.band++];
    return out;
}

/// What a kernel of that deviation does to a white texture's energy within the band of 90 %, over all of it.
struct TextureError {
    double error = 0; ///< energy of the difference
    double lost = 0; ///< difference of the energies
};

TextureError textureError(const Spectrum& spectrum, double deviation)
{
    TextureError out;
    double all = 0;
    for (std::size_t i = 0; i < spectrum.band; ++i) {
        const double w = (static_cast<double>(i) + 0.5) * Spectrum::step;
        const double kernel = std::exp(-0.5 * w * w * deviation * deviation);
        out.error += spectrum.energies[i] * (1 - kernel) * (1 - kernel);
        out.lost += spectrum.energies[i] * (1 - kernel * kernel);
        all += spectrum.energies[i];
    }
    return { out.error / all, out.lost / all };
}

/// The deviation that brings the chosen part of it to 1 %.
double onePercent(const Spectrum& spectrum, double TextureError::*part)
{
    double lo = 0, hi = 1;
    for (int i = 0; i < 20; ++i)
        (textureError(spectrum, (lo + hi) / 2).*part < 0.01 ? lo : hi) = (lo + hi) / 2;
    return lo;
}

struct EdgeError {
    double rms = 0, worst = 0; ///< of an edge of height 1; the mean over the profile's extent
};

EdgeError edgeError(const Shape& shape, double deviation)
{
    constexpr int finer = 60; // points a half-extent
    const auto at = [](int i) { return static_cast<double>(i) / finer; };
    std::vector<double> edge;
    for (int i = -6 * finer; i <= 6 * finer; ++i)
        edge.push_back(shape.edge(at(i)));
    std::vector<double> weights;
    for (int d = -3 * finer; d <= 3 * finer; ++d)
        weights.push_back(std::exp(-at(d) * at(d) / (2 * deviation * deviation)));
    EdgeError out;
    for (int i = 3 * finer; i <= 9 * finer; ++i) {
        double sum = 0, all = 0;
        for (int d = 0; d <= 6 * finer; ++d) {
            sum += weights[static_cast<std::size_t>(d)] * edge[static_cast<std::size_t>(i + d - 3 * finer)];
            all += weights[static_cast<std::size_t>(d)];
        }
        const double error = sum / all - edge[static_cast<std::size_t>(i)];
        out.worst = std::max(out.worst, std::fabs(error));
        out.rms += error * error / (2 * finer);
    }
    out.rms = std::sqrt(out.rms);
    return out;
}

/// The deviation with the least mean square error of an edge that `samples` a pixel show, of that half-extent in
/// pixels.
double bestWidth(
    const Shape& shape, const std::vector<std::array<double, 2>>& biases, double samples, double halfExtent)
{
    double least = std::numeric_limits<double>::infinity(), best = 0;
    for (const auto& [width, bias] : biases) {
        const double axis = std::max(1.0, 2 * std::sqrt(pi) * width * halfExtent);
        const double noise = 1 / (6 * samples * std::pow(axis, shape.dimensions)); // mean of p (1 - p) is 1/6
        if (bias * bias + noise < least) {
            least = bias * bias + noise;
            best = width;
        }
    }
    return best;
}

} // namespace

TEST_CASE("the recommended kernel, 0.177 of a blur's half-extent, under every profile")
{
    for (const Shape& shape : shapes) {
        CAPTURE(shape.name);
        const double width = WEDGE_KERNEL_WIDTH;
        const Spectrum spectrum = spectrumOf(shape);
        const EdgeError edge = edgeError(shape, width);
        const double asError = onePercent(spectrum, &TextureError::error),
                     asLoss = onePercent(spectrum, &TextureError::lost);
        const TextureError texture = textureError(spectrum, width);
        CHECK(texture.error < 0.0111);
        CHECK(asError > 0.17);
        CHECK(asLoss > 0.047);
        CHECK(asLoss < 0.1);
        CHECK(edge.rms < 0.0135);
        CHECK(edge.rms > 0.010);
        CHECK(edge.worst < 0.0355);
        MESSAGE(shape.name << ": band of 90 % to " << static_cast<double>(spectrum.band) * Spectrum::step
                           << " rad, of its energy lost " << texture.lost << ", error " << texture.error
                           << ", 1 % lost at " << asLoss << ", 1 % error at " << asError << "; edge " << edge.rms
                           << " RMS, " << edge.worst << " at most; at 1 % error " << edgeError(shape, asError).rms
                           << ", " << edgeError(shape, asError).worst);
    }
}

TEST_CASE("the best width falls with samples and extent: as (n r^2)^-0.18 after a lens, (n v)^-0.25 after a shutter")
{
    for (const Shape& shape : { shapes[0], shapes[2] }) {
        CAPTURE(shape.name);
        const bool lens = shape.dimensions == 2;
        std::vector<std::array<double, 2>> biases;
        for (double width = 0.06; width < 0.6; width *= 1.03)
            biases.push_back({ width, edgeError(shape, width).rms });
        for (const double extent : { 8.0, 15.0, 30.0 })
            for (const double samples : { 4.0, 16.0, 64.0 }) {
                CAPTURE(extent);
                CAPTURE(samples);
                const double law = lens ? 0.65 * std::pow(samples * extent * extent, -0.176)
                                        : 0.86 * std::pow(samples * extent, -0.25);
                CHECK(bestWidth(shape, biases, samples, extent) == doctest::Approx(law).epsilon(0.07));
            }
    }
}

TEST_CASE("disc and box together in two dimensions: variances add along the velocity, across it the disc's is left")
{
    constexpr double step = 0.05, end = 20;
    for (const double half : { 0.5, 1.0, 2.0, 4.0 }) { // of the motion, over the disc's radius
        CAPTURE(half);
        std::vector<double> alongs(static_cast<std::size_t>(end / step) + 1), acrosses(alongs.size());
        double all = 0;
        for (std::size_t i = 0; i < alongs.size(); ++i)
            for (std::size_t j = 0; j < alongs.size(); ++j) {
                const double x = (static_cast<double>(i) + 0.5) * step, y = (static_cast<double>(j) + 0.5) * step;
                const double energy = std::pow(discTransform(std::hypot(x, y)) * boxTransform(half * x), 2);
                alongs[i] += energy;
                acrosses[j] += energy;
                all += energy;
            }
        const auto limit = [&](const std::vector<double>& strips) {
            double below = 0;
            std::size_t i = 0;
            for (; below + strips[i] < 0.9 * all; ++i)
                below += strips[i];
            return (static_cast<double>(i) + (0.9 * all - below) / strips[i]) * step;
        };
        // Deviations: 1/2 of a disc, 1/sqrt 3 of a box.
        const double along = limit(alongs) * std::sqrt(0.25 + half * half / 3), across = limit(acrosses) / 2;
        MESSAGE("v/2 over r " << half << ": 90 % along " << along << ", across " << across << " over the deviation");
        CHECK(along > 1.03); // a Gaussian's is 1.16, a box's alone 1.52
        CHECK(along < 1.16);
        CHECK(across > 1.03);
        CHECK(across < 1.16);
    }
}
