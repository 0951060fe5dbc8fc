#include "benchmarks/common/squared_error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace wedge::benchmark {
namespace {

constexpr double leastOwnPart = 0.01;

struct Pixel {
    double squared; ///< error, the reference's noise in it
    double noise; ///< squared, of the reference
};

/// Without the reference's noise.
double own(double squared, double noise) { return std::max(squared - noise, leastOwnPart * squared); }

/// One image's, pixel by pixel, means over the channels.
std::vector<Pixel> pixelErrors(const image::RgbImage& image, const Reference& reference)
{
    std::vector<Pixel> out(image.rgb.size() / 3);
    for (std::size_t i = 0; i < out.size(); ++i) {
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
            const double error = static_cast<double>(image.rgb[c]) - reference.image.rgb[c];
            const double noise = reference.deviation.rgb[c];
            out[i].squared += error * error / 3.0;
            out[i].noise += noise * noise / 3.0;
        }
    }
    return out;
}

double mean(const std::vector<Pixel>& pixels, std::size_t count)
{
    double squared = 0, noise = 0;
    for (std::size_t i = 0; i < count; ++i) {
        squared += pixels[i].squared;
        noise += pixels[i].noise;
    }
    return own(squared, noise) / static_cast<double>(count);
}

/// Variance of mean() over references of as much noise. Of a pixel whose error is e and whose reference's is a Gaussian
/// of variance s^2, the squared difference has 2 s^4 + 4 e^2 s^2, and the estimate of s^2 that is taken off, one number
/// squared, 2 s^4 again; of that number the fourth power is 3 s^4.
double referenceVariance(const std::vector<Pixel>& pixels)
{
    double sum = 0;
    for (const Pixel& p : pixels) {
        sum += p.noise * (4.0 / 3.0 * p.noise + 4.0 * std::max(p.squared - p.noise, 0.0));
    }
    const auto n = static_cast<double>(pixels.size());
    return sum / (n * n);
}

double meanOf(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Standard error of the mean of the values; 0 for one.
double standardError(const std::vector<double>& values)
{
    if (values.size() < 2) {
        return 0;
    }
    const double middle = meanOf(values);
    double sum = 0;
    for (const double v : values) {
        sum += (v - middle) * (v - middle);
    }
    const auto n = static_cast<double>(values.size());
    return std::sqrt(sum / (n * (n - 1)));
}

double level(const image::RgbImage& image)
{
    return std::accumulate(image.rgb.begin(), image.rgb.end(), 0.0) / static_cast<double>(image.rgb.size());
}

} // namespace

double SquaredError::rmse() const { return std::sqrt(mean); }
double SquaredError::trimmedRmse() const { return std::sqrt(trimmed); }

SquaredError squaredError(const std::vector<image::RgbImage>& images, const Reference& reference)
{
    std::vector<double> whole, trimmed, bias, fromReference;
    const double truth = std::max(level(reference.image), 1e-30);
    for (const image::RgbImage& image : images) {
        std::vector<Pixel> pixels = pixelErrors(image, reference);
        whole.push_back(mean(pixels, pixels.size()));
        fromReference.push_back(referenceVariance(pixels));
        std::ranges::sort(pixels, std::less {}, [](const Pixel& p) { return p.squared; });
        const auto left = static_cast<std::size_t>(std::ceil((1.0 - worstPixels) * static_cast<double>(pixels.size())));
        trimmed.push_back(mean(pixels, left));
        bias.push_back((level(image) - level(reference.image)) / truth);
    }
    SquaredError out;
    out.mean = meanOf(whole);
    out.trimmed = meanOf(trimmed);
    out.deviation = out.mean > 0 ? standardError(whole) / out.mean : 0;
    out.referenceDeviation = out.mean > 0 ? std::sqrt(meanOf(fromReference)) / out.mean : 0;
    out.bias = meanOf(bias);
    out.biasDeviation = standardError(bias);
    return out;
}

} // namespace wedge::benchmark
