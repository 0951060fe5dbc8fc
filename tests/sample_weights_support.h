// Kernels that weigh samples, in frames as they are declared, and the check of what they keep.
#pragma once

#include "tests/stored_samples_support.h"

#include <algorithm>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace wedge::test {

constexpr int fieldWidth = 29, fieldHeight = 27;
const image::Window whole { 0, 0, fieldWidth, fieldHeight };

using Samples = std::vector<StoredSample>;
using Weights = std::vector<double>;

struct Product {
    const char *kernel, *filter;
    std::vector<float> values;
};

inline const std::vector<Product>& products()
{
    static const std::vector<Product> all { { "keepClamped", "clamp", { 10, 0, 1 } },
        { "keepTrimmed", "trim", { 0.1f, 0 } }, { "keepMedianOfMeans", "gmon", { 9, 0 } },
        { "keepReweighted", "reweight", { 1, 0, 1 } }, { "keepByDensity", "path-density", { 10, 2, 3, 0, 1, 0, 0 } } };
    return all;
}

inline const Product& productOf(const std::string& kernel)
{
    return *std::ranges::find_if(products(), [&](const Product& each) { return each.kernel == kernel; });
}

/// Calls test(bench, firstPass) for a kernel of frames with and without parts, on every device.
template <class Test>
void inEveryFrame(const std::string& kernel, const Test& test, const render::Options& options = renderOptions())
{
    onEveryDevice([&](const device::Device& device) {
        for (const bool parts : { false, true }) {
            CAPTURE(kernel);
            CAPTURE(parts);
            const Product& product = productOf(kernel);
            const auto method = parts ? render::axisAligned(40) : render::monteCarlo(40);
            DeclaredFrame frame(
                device, smallScene(), keptSettings(method, { product.filter, product.values }), false, options);
            PassBench bench(frame, kernel);
            REQUIRE(bench.has("parts") == parts);
            test(bench, parts ? 16u : 0u);
        }
    });
}

inline void setExposure(PassBench& bench, float exposure) { bench.plane("exposure", std::vector<float> { exposure }); }

/// What weights are of a pixel, and whether that hangs on rounding.
struct Weighed {
    Weights weights;
    bool uncertain = false;
};

/// Checks every pixel of the window with a sample against weigh(x, y), and that no other is touched.
template <class Weigh>
void checkKept(const KeptPlanes& found, const SampleField& field, const image::Window& window, bool madeUp,
    std::uint32_t firstPass, double error, const Weigh& weigh)
{
    unsigned checked = 0, uncertain = 0;
    everyPixelOf({ 0, 0, field.width, field.height }, [&](int x, int y) {
        const bool inside = x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
        const Samples& samples = field.at(x, y);
        if (!inside || samples.empty()) {
            requireUntouched(found, x, y);
            return;
        }
        const Weighed weighed = weigh(x, y);
        ++(weighed.uncertain ? uncertain : checked);
        if (!weighed.uncertain)
            requireKept(found, x, y, samples.size(), keptOf(samples, weighed.weights, error, madeUp, firstPass));
    });
    CHECK(checked > 300);
    CHECK(uncertain < checked / 20);
}

/// What is not finite is brighter than anything.
inline double brightness(const StoredSample& sample)
{
    return isFinite(sample.radiance) ? luminanceOf(sample.radiance) : std::numeric_limits<double>::infinity();
}

inline SampleField someField(unsigned seed)
{
    std::mt19937 random(seed);
    return someSamples(random, fieldWidth, fieldHeight, 40);
}

inline glm::dvec3 keptMean(const KeptPlanes& found, int x, int y)
{
    return found.sums.vector(x, y) / static_cast<double>(found.taken.at(x, y));
}
inline glm::dvec3 plainMean(const Samples& samples)
{
    return keptOf(samples, Weights(samples.size(), 1), 0, true, 0).mean;
}

} // namespace wedge::test
