// LDR-FLIP: P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D. Fairchild, "FLIP: A
// Difference Evaluator for Alternating Images", HPG 2020. Two pipelines meet at the end:
//   colour:  linear RGB -> YCxCz -> contrast sensitivity filter -> clipped RGB -> L*a*b* -> Hunt -> HyAB -> 0 .. 1
//   feature: Y of YCxCz -> edge and point detectors -> difference of magnitudes -> 0 .. 1
//   error = colour ^ (1 - feature)
#include "host/image/colour.h"
#include "host/image/flip_colour.h"
#include "host/image/metrics.h"
#include "host/image/plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace wedge::image {

namespace {

using Planes = std::array<Plane<float>, 3>;
constexpr double pi = std::numbers::pi;

// Contrast sensitivity, one sum of two Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b) per opponent channel, x in degrees.
struct Lobe {
    double a;
    double b;
};
constexpr std::array<std::array<Lobe, 2>, 3> sensitivity { { { { { 1.0, 0.0047 }, { 0.0, 1e-5 } } },
    { { { 1.0, 0.0053 }, { 0.0, 1e-5 } } }, { { { 34.1, 0.04 }, { 13.5, 0.025 } } } } };
constexpr double widestLobe = 0.04;

// Exponent of the colour difference, and the two ends of the piecewise linear map to 0 .. 1 that gives the differences
// below 0.4 of the largest one the range up to 0.95.
constexpr double colourExponent = 0.7;
constexpr double kneeAt = 0.4;
constexpr double kneeTo = 0.95;

// Width of the feature detectors in degrees, and the exponent of the feature difference.
constexpr double featureWidth = 0.082;
constexpr double featureExponent = 0.5;

void scaleTo(Kernel<float>& kernel, double sum)
{
    for (float& weight : kernel)
        weight = static_cast<float>(weight * sum);
}

// Samples f at the whole numbers in -radius .. radius.
template <typename Function>
Kernel<double> sampled(int radius, Function f)
{
    Kernel<double> kernel;
    for (int i = -radius; i <= radius; ++i)
        kernel.push_back(f(static_cast<double>(i)));
    return kernel;
}

// Positive weights scaled to the sum 1 and negative ones to -1.
Kernel<float> normalized(const Kernel<double>& kernel)
{
    double positive = 0.0;
    double negative = 0.0;
    for (const double weight : kernel)
        (weight > 0.0 ? positive : negative) += weight;
    Kernel<float> out;
    for (const double weight : kernel)
        out.push_back(static_cast<float>(weight > 0.0 ? weight / positive : weight < 0.0 ? -weight / negative : 0.0));
    return out;
}

Planes toOpponent(const RgbImage& image)
{
    Planes planes { Plane<float>(image.width, image.height), Plane<float>(image.width, image.height),
        Plane<float>(image.width, image.height) };
    for (std::size_t i = 0; i < planes[0].values.size(); ++i) {
        const Float3 colour = linearRgbToYCxCz({ clipToDisplay(image.rgb[3 * i]), clipToDisplay(image.rgb[3 * i + 1]),
            clipToDisplay(image.rgb[3 * i + 2]) });
        for (std::size_t c = 0; c < 3; ++c)
            planes[c].values[i] = colour[c];
    }
    return planes;
}

// One channel through its contrast sensitivity. A sum of Gaussians is not separable, but each Gaussian is.
Plane<float> seen(const Plane<float>& in, const std::array<Lobe, 2>& lobes, double pixelsPerDegree)
{
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(widestLobe / (2.0 * pi * pi)) * pixelsPerDegree));
    std::array<Kernel<double>, 2> kernels;
    std::array<double, 2> weights {};
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        kernels[i] = sampled(radius,
            [&](double x) { return std::exp(-pi * pi * x * x / (pixelsPerDegree * pixelsPerDegree * lobes[i].b)); });
        const double sum = std::accumulate(kernels[i].begin(), kernels[i].end(), 0.0);
        weights[i] = lobes[i].a * std::sqrt(pi / lobes[i].b) * sum * sum;
    }
    Plane<float> out(in.width, in.height);
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        if (weights[i] == 0.0)
            continue;
        const Kernel<float> alongX = normalized(kernels[i]);
        Kernel<float> alongY = alongX;
        scaleTo(alongY, weights[i] / (weights[0] + weights[1]));
        const Plane<float> part = filterColumns(filterRows(in, alongX), alongY);
        std::transform(out.values.begin(), out.values.end(), part.values.begin(), out.values.begin(), std::plus<>());
    }
    return out;
}

// What the eye keeps of the image, in Hunt-adjusted L*a*b*.
Planes perceived(const Planes& opponent, double pixelsPerDegree)
{
    Planes out { seen(opponent[0], sensitivity[0], pixelsPerDegree), seen(opponent[1], sensitivity[1], pixelsPerDegree),
        seen(opponent[2], sensitivity[2], pixelsPerDegree) };
    for (std::size_t i = 0; i < out[0].values.size(); ++i) {
        Float3 rgb = yCxCzToLinearRgb({ out[0].values[i], out[1].values[i], out[2].values[i] });
        for (float& value : rgb)
            value = clipToDisplay(value);
        const Float3 lab = huntAdjusted(linearRgbToLab(rgb));
        for (std::size_t c = 0; c < 3; ++c)
            out[c].values[i] = lab[c];
    }
    return out;
}

// The largest colour difference of the RGB cube, between its green and its blue corner.
double largestColourDifference()
{
    return std::pow(
        hyab(huntAdjusted(linearRgbToLab({ 0, 1, 0 })), huntAdjusted(linearRgbToLab({ 0, 0, 1 }))), colourExponent);
}

double redistributed(double difference, double largest)
{
    const double knee = kneeAt * largest;
    if (difference < knee)
        return kneeTo / knee * difference;
    return kneeTo + (difference - knee) / (largest - knee) * (1.0 - kneeTo);
}

// Magnitudes of the edge and point detectors, first and second derivatives of a Gaussian along x and y.
struct Features {
    Plane<float> edges;
    Plane<float> points;
};

Plane<float> magnitude(const Plane<float>& a, const Plane<float>& b)
{
    Plane<float> out(a.width, a.height);
    std::transform(a.values.begin(), a.values.end(), b.values.begin(), out.values.begin(),
        [](float x, float y) { return std::sqrt(x * x + y * y); });
    return out;
}

Features detectFeatures(const Plane<float>& opponentY, double pixelsPerDegree)
{
    const double sigma = 0.5 * featureWidth * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    const auto gaussian = [sigma](double x) { return std::exp(-x * x / (2.0 * sigma * sigma)); };
    const Kernel<float> smooth = normalized(sampled(radius, gaussian));
    const Kernel<float> edge = normalized(sampled(radius, [&](double x) { return -x * gaussian(x); }));
    const Kernel<float> point =
        normalized(sampled(radius, [&](double x) { return (x * x / (sigma * sigma) - 1.0) * gaussian(x); }));
    Plane<float> y = opponentY;
    for (float& value : y.values)
        value = (value + 16.0f) / 116.0f;
    const Plane<float> smoothX = filterRows(y, smooth);
    const Plane<float> smoothY = filterColumns(y, smooth);
    return { magnitude(filterRows(smoothY, edge), filterColumns(smoothX, edge)),
        magnitude(filterRows(smoothY, point), filterColumns(smoothX, point)) };
}

double featureDifference(const Features& a, const Features& b, std::size_t i)
{
    const double edges = std::abs(a.edges.values[i] - b.edges.values[i]);
    const double points = std::abs(a.points.values[i] - b.points.values[i]);
    return std::clamp(std::pow(std::max(edges, points) / std::numbers::sqrt2, featureExponent), 0.0, 1.0);
}

} // namespace

FlipResult flip(const RgbImage& image, const RgbImage& reference, double pixelsPerDegree)
{
    requireSameSize(image, reference);
    if (!(pixelsPerDegree > 0.0))
        throw std::logic_error("flip: pixelsPerDegree is not positive");
    const Planes opponentImage = toOpponent(image);
    const Planes opponentReference = toOpponent(reference);
    const Planes seenImage = perceived(opponentImage, pixelsPerDegree);
    const Planes seenReference = perceived(opponentReference, pixelsPerDegree);
    const Features featuresImage = detectFeatures(opponentImage[0], pixelsPerDegree);
    const Features featuresReference = detectFeatures(opponentReference[0], pixelsPerDegree);

    FlipResult result { 0.0, image.width, image.height, std::vector<float>(opponentImage[0].values.size()) };
    const double largest = largestColourDifference();
    for (std::size_t i = 0; i < result.error.size(); ++i) {
        const Float3 a { seenImage[0].values[i], seenImage[1].values[i], seenImage[2].values[i] };
        const Float3 b { seenReference[0].values[i], seenReference[1].values[i], seenReference[2].values[i] };
        const double colour = redistributed(std::pow(hyab(a, b), colourExponent), largest);
        const double error = std::pow(colour, 1.0 - featureDifference(featuresImage, featuresReference, i));
        result.error[i] = static_cast<float>(error);
        result.mean += error;
    }
    result.mean /= static_cast<double>(result.error.size());
    return result;
}

} // namespace wedge::image
