// Stored samples of an image, in bands of rows as frames have them in memory, and what is left of a pixel's samples by
// their weights, in double.
#pragma once

#include "kernels/shared/sample_filter.h"
#include "tests/pass_bench.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

namespace wedge::test {

/// CIELAB of linear sRGB, of which 1 is D65 white: CIE 15 and IEC 61966-2-1.
inline glm::dvec3 labOracle(const glm::dvec3& rgb)
{
    const glm::dvec3 x(0.4124564, 0.3575761, 0.1804375), y(0.2126729, 0.7151522, 0.0721750),
        z(0.0193339, 0.1191920, 0.9503041);
    const auto curve = [&](const glm::dvec3& row) {
        const double t = glm::dot(row, rgb) / (row.x + row.y + row.z);
        const double knee = 6.0 / 29;
        return t > knee * knee * knee ? std::cbrt(t) : t / (3 * knee * knee) + 4.0 / 29;
    };
    return { 116 * curve(y) - 16, 500 * (curve(x) - curve(y)), 200 * (curve(y) - curve(z)) };
}

/// A number as 16 bits have it.
inline double inShort(double x) { return shared::unpackShort(shared::packShort(static_cast<float>(x))); }

inline bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Where a pixel is in rows that lie one after another.
inline std::size_t indexOf(int x, int y, int width)
{
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

/// Spaces in which samples' colours are compared.
enum class Space { Lab, Rgb };

/// A colour in pixels: CIELAB by 20, or RGB scaled so that white is as far from black.
inline glm::dvec3 colourOracle(const glm::dvec3& exposed, Space space)
{
    return space == Space::Lab ? labOracle(exposed) / 20.0 : exposed * (5 / std::sqrt(3.0));
}

struct StoredSample {
    glm::dvec3 radiance; ///< floats
    glm::dvec3 colour; ///< in pixels, as 16 bits have it; what is no number is as far as can be
};

inline StoredSample storedSample(const glm::dvec3& radiance, double exposure = 1, Space space = Space::Lab)
{
    const glm::dvec3 rounded(glm::vec3 { radiance });
    if (!isFinite(rounded))
        return { rounded, { inShort(1e30), 0, 0 } };
    const glm::dvec3 colour = colourOracle(exposure * rounded, space);
    return { rounded, { inShort(colour.x), inShort(colour.y), inShort(colour.z) } };
}

/// An image's samples, any number to a pixel.
struct SampleField {
    SampleField(int w, int h)
        : width(w)
        , height(h)
        , pixels(static_cast<std::size_t>(w * h))
    {
    }
    std::vector<StoredSample>& at(int x, int y) { return pixels[indexOf(x, y, width)]; }
    const std::vector<StoredSample>& at(int x, int y) const { return pixels[indexOf(x, y, width)]; }
    bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }

    int width, height;
    std::vector<std::vector<StoredSample>> pixels;
};

template <class Visit>
void everyPixelOf(const image::Window& window, const Visit& visit)
{
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            visit(x, y);
}

/// The lists that bands are stored in. What no sample has been stored in holds some other pixel's.
class BandMemory {
public:
    BandMemory(const PassBench& bench, std::uint32_t slots, std::uint32_t perPixel)
        : slots_(slots)
        , perPixel_(perPixel)
        , stride_(bench.layout.stride)
        , random_(5)
        , drawn_(bench.layout, 1, 0u)
        , radiance_(someNumbers(random_, bench.elements("radiance"), 0, 3))
        , colours_(bench.elements("colours"))
        , ranges_(someNumbers(random_, bench.elements("ranges"), -1e30, 1e30))
    {
        REQUIRE(std::size_t { slots } * perPixel * 3 <= radiance_.size());
        for (std::uint32_t& colour : colours_)
            colour = shared::packShort(static_cast<float>(uniform(random_, 0, 5)));
    }
    void draw(const SampleField& field, int firstRow, int endRow)
    {
        everyPixelOf({ 0, firstRow, field.width, std::min(endRow, field.height) }, [&](int x, int y) {
            const std::vector<StoredSample>& samples = field.at(x, y);
            REQUIRE(samples.size() <= perPixel_);
            drawn_.at(x, y) = static_cast<std::uint32_t>(samples.size());
            store(shared::pixelIndex(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), stride_) % slots_,
                samples);
        });
    }
    void handTo(PassBench& bench) const
    {
        bench.value("slots", slots_);
        bench.value("perPixel", perPixel_);
        bench.plane("drawn", drawn_);
        bench.plane("radiance", radiance_);
        bench.plane("colours", colours_);
        bench.plane("ranges", ranges_);
    }

private:
    void store(std::size_t slot, const std::vector<StoredSample>& samples)
    {
        double low = 1e30, high = -1e30;
        for (std::size_t j = 0; j < samples.size(); ++j) {
            for (int k = 0; k < 3; ++k) {
                const std::size_t at = (3 * slot + static_cast<std::size_t>(k)) * perPixel_ + j;
                radiance_[at] = static_cast<float>(samples[j].radiance[k]);
                colours_[at] = shared::packShort(static_cast<float>(samples[j].colour[k]));
            }
            low = std::min(low, samples[j].colour.x);
            high = std::max(high, samples[j].colour.x);
        }
        if (!samples.empty()) {
            ranges_[2 * slot] = static_cast<float>(low);
            ranges_[2 * slot + 1] = static_cast<float>(high);
        }
    }

    std::uint32_t slots_, perPixel_, stride_;
    std::mt19937 random_;
    Planes<std::uint32_t> drawn_;
    std::vector<float> radiance_;
    std::vector<std::uint32_t> colours_;
    std::vector<float> ranges_;
};

/// What a kernel that keeps samples has made; of planes that its frame has not, nothing.
struct KeptPlanes {
    Planes<float> sums, excess, parts, density;
    Planes<std::uint32_t> taken, notFinite;
};

/// In planes that nothing is written to.
constexpr float untouched = 7.0f;
constexpr std::uint32_t uncounted = 77;

/// Runs a kernel that keeps samples over the pixels of a window, band by band of so many rows, as StoredSamples does:
/// where a band has been drawn, pixels are filtered around which all has been.
inline KeptPlanes keep(PassBench& bench, const SampleField& field, const image::Window& window, int rows,
    std::uint32_t perPixel, std::uint32_t firstPass = 0)
{
    constexpr int reach = WEDGE_SAMPLE_REACH;
    BandMemory memory(bench, static_cast<std::uint32_t>(rows + 2 * reach) * bench.layout.stride, perPixel);
    bench.value("firstPass", firstPass);
    bench.plane("sums", Planes<float>(bench.layout, 4, untouched));
    bench.plane("excess", Planes<float>(bench.layout, 3, untouched));
    bench.plane("taken", Planes<std::uint32_t>(bench.layout, 1, 0u));
    bench.plane("notFinite", Planes<std::uint32_t>(bench.layout, 1, uncounted));
    if (bench.has("parts"))
        bench.plane("parts", Planes<float>(bench.layout, 3, untouched));
    if (bench.has("density"))
        bench.plane("density", Planes<float>(bench.layout, 1, untouched));
    auto p = paramsOf(bench.layout);
    p.width = static_cast<std::uint32_t>(field.width);
    p.height = static_cast<std::uint32_t>(field.height);
    for (int first = 0; first - reach < field.height; first += rows) {
        memory.draw(field, first, first + rows);
        const image::Window covered { window.x0, std::max(window.y0, first - reach), window.x1,
            std::min(window.y1, first - reach + rows) };
        if (covered.y0 >= covered.y1)
            continue;
        memory.handTo(bench);
        render::setRectangle(p, covered);
        bench.value("p", p);
        bench.items(
            static_cast<std::size_t>(covered.x1 - covered.x0) * static_cast<std::size_t>(covered.y1 - covered.y0));
        bench.run();
    }
    const auto floats = [&](const char* name) {
        return bench.has(name) ? bench.pixels<float>(name) : Planes<float>(bench.layout, 0, 0);
    };
    return { floats("sums"), floats("excess"), floats("parts"), floats("density"), bench.pixels<std::uint32_t>("taken"),
        bench.pixels<std::uint32_t>("notFinite") };
}

/// What a pixel's samples come to.
struct KeptOracle {
    glm::dvec3 mean { 0 }, plain { 0 }, part { 0 };
    double squared = 0; ///< mean of squared luminance
    std::uint32_t notFinite = 0; ///< samples
    double error = 0; ///< of a mean, for errors of the weights, times the largest sample
};

/// Samples of a pixel that are the first of two parts: half of them, or half of the first pass where that is more.
inline std::size_t firstPartOf(std::size_t count, std::size_t firstPass)
{
    return count >= 2 * firstPass ? count / 2 : firstPass / 2;
}

/// The mean by weights, which may be wrong by `error` each; or if nothing is made up for, over all samples. What is no
/// number counts nowhere.
inline KeptOracle keptOf(const std::vector<StoredSample>& samples, const std::vector<double>& weights, double error,
    bool madeUp, std::size_t firstPass)
{
    KeptOracle out;
    double sum = 0, partSum = 0, count = 0, largest = 0;
    for (std::size_t j = 0; j < samples.size(); ++j) {
        const glm::dvec3& v = samples[j].radiance;
        if (!isFinite(v)) {
            ++out.notFinite;
            continue;
        }
        const double own = madeUp ? weights[j] : 1;
        out.mean += weights[j] * v;
        out.squared += weights[j] * std::pow(luminanceOf(v), 2);
        out.plain += v;
        sum += own;
        count += 1;
        if (j < firstPartOf(samples.size(), firstPass)) {
            out.part += weights[j] * v;
            partSum += own;
        }
        largest = std::max({ largest, v.x, v.y, v.z });
    }
    out.mean = sum > 0 ? out.mean / sum : glm::dvec3(0);
    out.squared = sum > 0 ? out.squared / sum : 0;
    out.plain = count > 0 ? out.plain / count : glm::dvec3(0);
    out.part = partSum > 1e-3 ? out.part / partSum : out.mean;
    out.error = sum > 0 ? (2 * error * count / std::min(sum, partSum > 1e-3 ? partSum : sum) + 2e-6) * largest : 1e-9;
    return out;
}

/// Checks what has been made of a pixel with samples.
inline void requireKept(const KeptPlanes& found, int x, int y, std::size_t count, const KeptOracle& expected)
{
    CAPTURE(x);
    CAPTURE(y);
    CAPTURE(count);
    CAPTURE(expected.error);
    const double n = static_cast<double>(count);
    REQUIRE(found.taken.at(x, y) == count);
    REQUIRE(found.notFinite.at(x, y) == expected.notFinite);
    for (int k = 0; k < 3; ++k) {
        CAPTURE(k);
        CAPTURE(expected.mean[k]);
        CAPTURE(found.sums.vector(x, y)[k] / n);
        REQUIRE(std::fabs(found.sums.vector(x, y)[k] / n - expected.mean[k]) <= expected.error);
        CAPTURE(found.excess.vector(x, y)[k]);
        REQUIRE(std::fabs(found.excess.vector(x, y)[k] - (expected.plain[k] - expected.mean[k])) <= expected.error);
        if (!found.parts.values.empty()) {
            CAPTURE(expected.part[k]);
            CAPTURE(found.parts.vector(x, y)[k]);
            const double largest = std::max({ expected.part.x, expected.part.y, expected.part.z });
            REQUIRE(std::fabs(found.parts.vector(x, y)[k] - expected.part[k]) <= expected.error + largest / 4000);
        }
    }
    // Of a square no sample is larger than the error's largest.
    const double largest = expected.error / 2e-6;
    REQUIRE(std::fabs(found.sums.at(x, y, 3) / n - expected.squared) <= 2 * expected.error * largest);
}

/// Checks that nothing has been written where there is no sample, or beside the window.
inline void requireUntouched(const KeptPlanes& found, int x, int y)
{
    CAPTURE(x);
    CAPTURE(y);
    REQUIRE(found.taken.at(x, y) == 0);
    REQUIRE(found.notFinite.at(x, y) == uncounted);
    for (std::size_t k = 0; k < 4; ++k)
        REQUIRE(found.sums.at(x, y, k) == untouched);
    for (std::size_t k = 0; k < 3; ++k)
        REQUIRE(found.excess.at(x, y, k) == untouched);
    if (!found.density.values.empty())
        REQUIRE(found.density.at(x, y) == untouched);
}

/// Random samples: around colours that change from pixel to pixel, some far from them, some that are no numbers; pixels
/// with none, few, and up to `most`.
inline SampleField someSamples(
    std::mt19937& random, int width, int height, std::uint32_t most, Space space = Space::Lab)
{
    SampleField out(width, height);
    const float bad[] = { std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity() };
    const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(random()) % end; };
    everyPixelOf({ 0, 0, width, height }, [&](int x, int y) {
        const std::uint32_t kind = below(16);
        const std::uint32_t count = kind == 0 ? 0 : kind == 1 ? most - below(3) : 1 + below(std::min(most, 8u));
        const double hue = 0.4 + 0.2 * std::sin(0.35 * x) + 0.15 * std::cos(0.5 * y);
        for (std::uint32_t j = 0; j < count; ++j) {
            const double wide = random() % 5 == 0 ? 3 : 0.5;
            const double scale = std::exp(wide * uniform(random, -1, 1));
            glm::dvec3 v = scale * glm::dvec3(hue, 0.4 * uniform(random, 0.3, 1), 0.8 - hue);
            if (random() % 23 == 0)
                v = glm::dvec3(uniform(random), uniform(random), uniform(random))
                    * std::pow(10, uniform(random, -1, 2));
            if (random() % 40 == 0)
                v[static_cast<int>(random() % 3)] = bad[random() % 3];
            out.at(x, y).push_back(storedSample(v, 1, space));
        }
    });
    return out;
}

/// A frame of paths whose samples a filter keeps some of.
inline render::Settings keptSettings(render::Settings settings, const render::ChosenFilter& filter)
{
    render::Settings s = sized(std::move(settings), 29, 27);
    s.bounces = 1;
    s.filters = { filter };
    return s;
}

} // namespace wedge::test
