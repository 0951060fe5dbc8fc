#include "host/image/colour.h"
#include "host/image/metrics.h"
#include "host/image/plane.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace wedge::image {

namespace {

constexpr int windowRadius = 5;
constexpr double windowSigma = 1.5;
constexpr double c1 = 0.01 * 0.01;
constexpr double c2 = 0.03 * 0.03;

Plane<double> displayLuma(const RgbImage& image)
{
    const std::vector<float> encoded = displayReferred(image);
    Plane<double> luma(image.width, image.height);
    for (std::size_t i = 0; i < luma.values.size(); ++i)
        luma.values[i] = 0.2126 * encoded[3 * i] + 0.7152 * encoded[3 * i + 1] + 0.0722 * encoded[3 * i + 2];
    return luma;
}

Plane<double> product(const Plane<double>& a, const Plane<double>& b)
{
    Plane<double> out(a.width, a.height);
    std::transform(a.values.begin(), a.values.end(), b.values.begin(), out.values.begin(), std::multiplies<>());
    return out;
}

Plane<double> transposed(const Plane<double>& in)
{
    Plane<double> out(in.height, in.width);
    for (int y = 0; y < in.height; ++y)
        for (int x = 0; x < in.width; ++x)
            out.row(x)[y] = in.row(y)[x];
    return out;
}

// Where windows are centred along an axis of n pixels: [begin, end).
struct Centres {
    int begin;
    int end;
    explicit Centres(int n)
        : begin(n > 2 * windowRadius ? windowRadius : 0)
        , end(n - begin)
    {
    }
};

// Gaussian mean along x at every centre, the weights normalised over the pixels that exist.
Plane<double> meanAlongRows(const Plane<double>& in)
{
    const Centres centres(in.width);
    Plane<double> out(centres.end - centres.begin, in.height);
    for (int x = centres.begin; x < centres.end; ++x) {
        const int first = std::max(0, x - windowRadius);
        const int last = std::min(in.width - 1, x + windowRadius);
        std::vector<double> weights;
        for (int i = first; i <= last; ++i)
            weights.push_back(std::exp(-0.5 * (i - x) * (i - x) / (windowSigma * windowSigma)));
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        for (int y = 0; y < in.height; ++y)
            out.row(y)[x - centres.begin] =
                std::inner_product(weights.begin(), weights.end(), in.row(y) + first, 0.0) / sum;
    }
    return out;
}

Plane<double> windowMean(const Plane<double>& in) { return transposed(meanAlongRows(transposed(meanAlongRows(in)))); }

} // namespace

double ssim(const RgbImage& image, const RgbImage& reference)
{
    requireSameSize(image, reference);
    const Plane<double> a = displayLuma(image);
    const Plane<double> b = displayLuma(reference);
    const Plane<double> meanA = windowMean(a);
    const Plane<double> meanB = windowMean(b);
    const Plane<double> meanAA = windowMean(product(a, a));
    const Plane<double> meanBB = windowMean(product(b, b));
    const Plane<double> meanAB = windowMean(product(a, b));
    double sum = 0.0;
    for (std::size_t i = 0; i < meanA.values.size(); ++i) {
        const double ma = meanA.values[i];
        const double mb = meanB.values[i];
        const double varA = meanAA.values[i] - ma * ma;
        const double varB = meanBB.values[i] - mb * mb;
        const double covariance = meanAB.values[i] - ma * mb;
        sum += (2.0 * ma * mb + c1) * (2.0 * covariance + c2) / ((ma * ma + mb * mb + c1) * (varA + varB + c2));
    }
    return sum / static_cast<double>(meanA.values.size());
}

} // namespace wedge::image
