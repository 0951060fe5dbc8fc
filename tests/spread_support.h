// Light that filters of samples leave out, and where it goes: what kernels of filter/spread.cl are held against.
#pragma once

#include "tests/stored_samples_support.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace wedge::test {

/// An image, no larger than the frame, and the pixels of it that are made.
struct Area {
    int width, height;
    image::Window window;
};

inline const std::vector<Area>& areas()
{
    static const std::vector<Area> all { { 29, 27, { 0, 0, 29, 27 } }, { 29, 27, { 7, 3, 25, 20 } },
        { 1, 1, { 0, 0, 1, 1 } }, { 29, 2, { 0, 0, 29, 2 } } };
    return all;
}

/// What pixels lose and the surfaces that they see. Beside images, what would get and give light if it were looked at.
struct Lost {
    explicit Lost(const render::PlaneLayout& layout)
        : objectId(layout, 1, 1u)
        , taken(layout, 1, 1u)
        , normal(layout, 3, 0.0f)
        , excess(layout, 3, 1e3f)
    {
        std::fill_n(normal.values.begin() + static_cast<std::ptrdiff_t>(2 * layout.size), layout.size, 1.0f);
    }
    Planes<std::uint32_t> objectId, taken;
    Planes<float> normal, excess;
};

/// Objects in patches, each with faces whose normals are 20, 30 and more degrees apart; pixels that lose nothing, and
/// pixels without samples.
inline Lost someLoss(const render::PlaneLayout& layout, const Area& area, std::mt19937& random)
{
    Lost out(layout);
    everyPixelOf({ 0, 0, area.width, area.height }, [&](int x, int y) {
        const double angle = std::numbers::pi / 180 * (std::array { 0, 20, 50, 24, 51 })[random() % 5];
        out.objectId.at(x, y) = 1 + static_cast<std::uint32_t>(x / 8 + y / 10) % 3;
        out.normal.setVector(x, y, { std::sin(angle), 0, std::cos(angle) });
        out.taken.at(x, y) = random() % 9 == 0 ? 0 : 1 + static_cast<std::uint32_t>(random()) % 30;
        out.excess.setVector(x, y,
            random() % 3 == 0
                ? glm::dvec3(0)
                : glm::dvec3(uniform(random), uniform(random), uniform(random)) * std::pow(10, uniform(random, -2, 2)));
    });
    return out;
}

/// Whether what one pixel loses may go to another.
inline bool spreads(const Lost& of, glm::ivec2 from, glm::ivec2 to)
{
    const glm::dvec3 a = of.normal.vector(from.x, from.y), b = of.normal.vector(to.x, to.y);
    return of.taken.at(from.x, from.y) > 0 && of.taken.at(to.x, to.y) > 0
        && of.objectId.at(from.x, from.y) == of.objectId.at(to.x, to.y) && glm::dot(a, b) >= 0.9;
}

/// The weight of two pixels, a Gaussian that ends at two standard deviations, either way.
inline double gaussianOf(glm::ivec2 a, glm::ivec2 b, double sigma)
{
    const int reach = static_cast<int>(std::ceil(2 * sigma));
    const glm::dvec2 d(a - b);
    if (std::abs(a.x - b.x) > reach || std::abs(a.y - b.y) > reach)
        return 0;
    return std::exp(-glm::dot(d, d) / (2 * sigma * sigma));
}

/// Calls visit(to, share) for all pixels that get some of what a pixel loses; shares add up to 1.
template <class Visit>
void sharesOf(const Lost& of, const Area& area, glm::ivec2 from, double sigma, const Visit& visit)
{
    double sum = 0;
    std::vector<std::pair<glm::ivec2, double>> weights;
    everyPixelOf({ 0, 0, area.width, area.height }, [&](int x, int y) {
        const double weight = spreads(of, from, { x, y }) ? gaussianOf(from, { x, y }, sigma) : 0;
        if (weight > 0)
            weights.emplace_back(glm::ivec2(x, y), weight);
        sum += weight;
    });
    for (const auto& to : weights)
        visit(to.first, to.second / sum);
}

/// What pixels get.
struct Gained {
    Planes<float> sums, parts;
};

/// Hands a kernel what it has of a loss.
inline void setLoss(PassBench& bench, const Lost& lost, const Area& area, const image::Window& window, float sigma)
{
    auto p = paramsOf(bench.layout);
    p.width = static_cast<std::uint32_t>(area.width);
    p.height = static_cast<std::uint32_t>(area.height);
    render::setRectangle(p, window);
    bench.value("p", p);
    bench.window(window);
    bench.value("sigma", sigma);
    bench.plane("objectId", lost.objectId);
    bench.plane("normal", lost.normal);
    bench.plane("taken", lost.taken);
    bench.plane("excess", lost.excess);
}

/// What spreadExcess makes of `before`; it has been handed all else.
inline Gained gainedBy(PassBench& excess, const Planes<float>& before)
{
    excess.plane("sums", before);
    const bool parts = excess.has("parts");
    if (parts)
        excess.plane("parts", Planes<float>(excess.layout, 3, 1.0f));
    excess.run();
    return { excess.pixels<float>("sums"), parts ? excess.pixels<float>("parts") : Planes<float>(excess.layout, 0, 0) };
}

/// A frame whose samples are filtered by path density; parts: with means of a part of them.
inline DeclaredFrame spreadFrame(const device::Device& device, bool parts, float widest)
{
    return DeclaredFrame(device, smallScene(),
        keptSettings(parts ? render::axisAligned(16) : render::monteCarlo(16),
            { "path-density", { 10, 2, 3, 3, 0, 0, 0, widest } }));
}

/// What pixels of an area gain, in double; sigmaOf(x, y): by what each one's loss is spread.
template <class SigmaOf>
std::vector<glm::dvec3> gainsOf(const Lost& lost, const Area& area, const SigmaOf& sigmaOf)
{
    std::vector<glm::dvec3> out(static_cast<std::size_t>(area.width * area.height), glm::dvec3(0));
    everyPixelOf({ 0, 0, area.width, area.height }, [&](int x, int y) {
        if (lost.taken.at(x, y) == 0 || lost.excess.vector(x, y) == glm::dvec3(0))
            return;
        sharesOf(lost, area, { x, y }, sigmaOf(x, y), [&](glm::ivec2 to, double share) {
            out[indexOf(to.x, to.y, area.width)] += share * lost.excess.vector(x, y);
        });
    });
    return out;
}

/// Holds what is found against sums before and gains in double.
inline void checkGains(const Gained& found, const Lost& lost, const Area& area, const Planes<float>& before,
    const std::vector<glm::dvec3>& gains)
{
    everyPixelOf(area.window, [&](int x, int y) {
        CAPTURE(x);
        CAPTURE(y);
        const glm::dvec3 gain = gains[indexOf(x, y, area.width)];
        const double n = lost.taken.at(x, y);
        for (int k = 0; k < 3; ++k) {
            const double expected = before.vector(x, y)[k] + n * gain[k];
            REQUIRE(found.sums.vector(x, y)[k] == doctest::Approx(expected).epsilon(1e-5));
            if (!found.parts.values.empty())
                REQUIRE(std::fabs(found.parts.vector(x, y)[k] - (1 + gain[k]))
                    <= 2e-4 * (1 + std::max({ gain.x, gain.y, gain.z })));
        }
        REQUIRE(found.sums.at(x, y, 3) == before.at(x, y, 3));
    });
}

/// Whether each object has what its pixels lose; found: of sums that were 0.
inline void checkBalance(const Gained& found, const Lost& lost, const Area& area, const Planes<float>& per)
{
    std::map<std::uint32_t, glm::dvec3> balance, all;
    everyPixelOf(area.window, [&](int x, int y) {
        const std::uint32_t n = lost.taken.at(x, y), object = lost.objectId.at(x, y);
        if (n == 0) {
            REQUIRE(found.sums.vector(x, y) == glm::dvec3(0));
            REQUIRE(per.at(x, y) == 0);
            return;
        }
        REQUIRE((per.at(x, y) > 0) == (lost.excess.vector(x, y) != glm::dvec3(0)));
        balance[object] += found.sums.vector(x, y) / double { static_cast<double>(n) } - lost.excess.vector(x, y);
        all[object] += lost.excess.vector(x, y);
    });
    CHECK(all.size() == 3);
    for (const auto& object : all)
        REQUIRE(glm::length(balance[object.first]) <= 1e-5 * glm::length(object.second));
}

} // namespace wedge::test
