// reflectors.cl alone: from the samples' variance against the same in double.
#include "tests/reflector_support.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Of samples of indirect light in a frame of that size.
Planes<float> varianceOf(const device::Device& device, shared::ReflectorParams p, const Planes<float>& sums,
    const Planes<std::uint32_t>& taken, const Planes<float>& reflectance)
{
    render::Settings settings = sized(render::axisAligned(32), static_cast<int>(p.width), static_cast<int>(p.height));
    settings.bounces = 1;
    DeclaredFrame frame(device, smallScene(), settings);
    PassBench pass(frame, "sampleVariance");
    pass.value("p", p);
    pass.plane("sums", sums);
    pass.plane("taken", taken);
    pass.plane("reflectance", reflectance);
    pass.run();
    return pass.pixels<float>("variance");
}

} // namespace

TEST_CASE("sampleVariance is the variance of the samples' luminance as the image shows it")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto& [width, height] : { std::pair(1, 1), { 37, 11 } })
            for (const std::uint32_t component : { WEDGE_COMPONENT_DIFFUSE, WEDGE_COMPONENT_AMBIENT }) {
                const render::PlaneLayout layout(width, height);
                Planes<float> sums(layout, 4, 0.0f), reflectance(layout, 3, 0.0f);
                Planes<std::uint32_t> taken(layout, 1, 0u);
                Planes<double> exact(layout, 1, 0.0), scale(layout, 1, 0.0);
                std::mt19937 random(3);
                everyPixel(layout, [&](int x, int y) {
                    const auto n = static_cast<std::uint32_t>(random() % 5 == 0 ? random() % 3 : 2 + random() % 60);
                    const glm::dvec3 colour(uniform(random), uniform(random), uniform(random));
                    // Every third pixel's samples are all the same.
                    const double spread = random() % 3 == 0 ? 0 : std::pow(10.0, uniform(random, -2, 1));
                    glm::dvec3 sum(0);
                    std::vector<double> luminances;
                    double squares = 0;
                    for (unsigned i = 0; i < n; ++i) {
                        const glm::dvec3 sample = colour * (1 + spread * uniform(random));
                        sum += sample;
                        luminances.push_back(luminanceOf(sample));
                        squares += luminances.back() * luminances.back();
                    }
                    sums.setVector(x, y, sum);
                    sums.at(x, y, 3) = static_cast<float>(squares);
                    taken.at(x, y) = n;
                    reflectance.setVector(x, y, { uniform(random), uniform(random), uniform(random) });
                    const double k = component == WEDGE_COMPONENT_AMBIENT ? 1 : luminanceOf(reflectance.vector(x, y));
                    const double mean = luminanceOf(sum) / std::max(n, 1u);
                    for (const double l : luminances)
                        exact.at(x, y) += n > 1 ? (l - mean) * (l - mean) / (n - 1) * k * k : 0.0;
                    scale.at(x, y) = n > 1 ? squares / (n - 1) * k * k : 0.0;
                });
                shared::ReflectorParams p = paramsFor(layout);
                p.component = component;
                const Planes<float> found = varianceOf(device, p, sums, taken, reflectance);
                everyPixel(layout, [&](int x, int y) {
                    REQUIRE(found.at(x, y) >= 0.0f);
                    REQUIRE(std::fabs(found.at(x, y) - exact.at(x, y)) <= 2e-6 * scale.at(x, y));
                });
            }
    });
}

TEST_CASE("sampleVariance of fractions is that of samples that see all or nothing")
{
    onEveryDevice([](const device::Device& device) {
        const render::PlaneLayout layout(21, 3);
        Planes<float> sums(layout, 4, 0.0f), reflectance(layout, 3, 0.5f);
        Planes<std::uint32_t> taken(layout, 1, 0u);
        std::mt19937 random(4);
        everyPixel(layout, [&](int x, int y) {
            // What is seen of n samples that bring 3 each; of the first column none brings anything.
            const auto n = static_cast<std::uint32_t>(random() % 20);
            const auto seen = static_cast<std::uint32_t>(random() % (n + 1));
            taken.at(x, y) = n;
            const float each = x == 0 ? 0.0f : 3.0f;
            sums.setVector(x, y, glm::dvec3(each * static_cast<float>(seen)));
            sums.at(x, y, 3) = each * static_cast<float>(n);
        });
        shared::ReflectorParams p = paramsFor(layout);
        p.component = WEDGE_COMPONENT_ENVIRONMENT_GLOSSY;
        p.fractions = 1;
        const Planes<float> found = varianceOf(device, p, sums, taken, reflectance);
        everyPixel(layout, [&](int x, int y) {
            const double n = taken.at(x, y), f = n > 0 && x > 0 ? sums.at(x, y) / sums.at(x, y, 3) : 0;
            const double expected = n > 1 ? n / (n - 1) * f * (1 - f) * 0.25 : 0; // of the reflectance 0.5
            REQUIRE(std::fabs(found.at(x, y) - expected) <= 1e-5 * expected + 1e-7);
        });
    });
}
