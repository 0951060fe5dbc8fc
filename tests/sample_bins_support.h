// Samples of an image's pixels by their brightness (kernels/sinks/sample_bins.h), and kernels that are handed them, in
// frames as they are declared.
#pragma once

#include "tests/stored_samples_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace wedge::test {

constexpr std::size_t binsOfPixel = 8, numbersOfBin = 5;
/// L* of exposed radiance over 20 where bins end; the last has no end.
constexpr std::array<double, binsOfPixel - 1> binEnds { 0.75, 1.75, 3, 4.75, 7.5, 12, 20 };
constexpr std::uint32_t mostInBin = 65535;
/// Shares and measures of 16 bits have 8 bits of mantissa, of which the first is not stored: from 1 to 2 they are 2^-7
/// apart, so that rounding takes none farther away than 2^-8 of what it is.
constexpr double roundingOfShorts = 1.0 / 256;
/// Weights of bins are 2^-11 apart from 1 to 2, and means 2^-12 from 1/2 to 1; both are rounded up or down by chance.
constexpr double roundingOfBins = 1.0 / 2048;

struct Bin {
    glm::dvec3 mean { 0 };
    double weight = 0;
    std::uint32_t count = 0;
};
using Bins = std::array<Bin, binsOfPixel>;

/// A bin in numbers of 16 bits: a colour of 47 bits (shared/packed.h), of the weight the exponent from 2^-20 to 2^11
/// and 11 digits behind the first, and the count.
using CodedBin = std::array<std::uint16_t, numbersOfBin>;

inline CodedBin coded(const Bin& bin)
{
    const shared::PackedColour colour = shared::packColour(toVec3(bin.mean));
    int exponent = 0;
    const double fraction = std::frexp(std::max(bin.weight, 0x1p-20), &exponent); // from 1/2 to 1
    const auto weight = (exponent + 19) * 2048 + std::lround((fraction - 0.5) * 4096);
    return { static_cast<std::uint16_t>(colour.low & 0xffffu), static_cast<std::uint16_t>(colour.low >> 16),
        static_cast<std::uint16_t>(colour.high), static_cast<std::uint16_t>(weight),
        static_cast<std::uint16_t>(bin.count) };
}

/// Back: of bins without samples the weight is of no meaning.
inline Bin decoded(const CodedBin& of)
{
    const shared::Vec3 mean = shared::unpackColour({ of[0] | static_cast<std::uint32_t>(of[1]) << 16, of[2] });
    const double weight = std::ldexp(1 + of[3] % 2048 / 2048.0, of[3] / 2048 - 20);
    return { toGlm(mean), of[4] > 0 ? weight : 0, of[4] };
}

/// A bin as those numbers have it.
inline Bin binOf(const glm::dvec3& mean, double weight, std::uint32_t count)
{
    return decoded(coded({ mean, weight, count }));
}

inline std::uint64_t samplesIn(const Bins& bins)
{
    std::uint64_t out = 0;
    for (const Bin& bin : bins)
        out += bin.count;
    return out;
}

struct BinField {
    BinField(int w, int h)
        : width(w)
        , height(h)
        , pixels(indexOf(0, h, w))
    {
    }
    Bins& at(int x, int y) { return pixels[indexOf(x, y, width)]; }
    const Bins& at(int x, int y) const { return pixels[indexOf(x, y, width)]; }
    bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }

    int width, height;
    std::vector<Bins> pixels;
};

/// A colour whose L*, over 20, is that; of a hue.
inline glm::dvec3 colourOf(double lightness, const glm::dvec3& hue)
{
    const double root = (20 * lightness + 16) / 116, knee = 6.0 / 29;
    const double y = root > knee ? root * root * root : 3 * knee * knee * (root - 4.0 / 29);
    return hue * (y / luminanceOf(hue));
}

/// Random bins: pixels without a sample, with few and with many, up to what 16 bits count; dark bins with most of the
/// samples, of hues that change slowly, and bright ones with single samples.
inline BinField someBins(unsigned seed, int width, int height)
{
    std::mt19937 random(seed);
    BinField out(width, height);
    const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(random()) % end; };
    everyPixelOf({ 0, 0, width, height }, [&](int x, int y) {
        const std::uint32_t kind = below(12);
        if (kind == 0)
            return;
        for (std::size_t b = 0; b < binsOfPixel; ++b) {
            if (below(static_cast<std::uint32_t>(b) + 2) != 0)
                continue;
            const double begin = b == 0 ? 0 : binEnds[b - 1], end = b + 1 < binsOfPixel ? binEnds[b] : 30;
            const glm::dvec3 hue(0.5 + 0.2 * std::sin(0.35 * x), 0.4 * uniform(random, 0.5, 1), 0.3);
            const std::uint32_t count = kind == 1 ? mostInBin - below(2)
                : b < 3                           ? 1 + below(9)
                                                  : 1 + below(kind == 2 ? 20 : 2);
            out.at(x, y)[b] = binOf(colourOf(uniform(random, begin, end), hue), uniform(random, 0.01, 4), count);
        }
    });
    return out;
}

/// Planes of bins as passes have them; beside the image, bins that would count.
inline std::vector<std::uint32_t> planesOfBins(const BinField& field, const render::PlaneLayout& layout)
{
    std::vector<std::uint32_t> out(binsOfPixel * numbersOfBin * layout.size);
    const CodedBin beside = coded({ glm::dvec3(0.5), 0.5, 3 });
    for (std::size_t at = 0; at < out.size(); ++at)
        out[at] = beside[at / layout.size % numbersOfBin];
    const Planes<std::uint32_t> indices(layout, 0, 0u);
    everyPixelOf({ 0, 0, field.width, field.height }, [&](int x, int y) {
        for (std::size_t b = 0; b < binsOfPixel; ++b) {
            const CodedBin numbers = coded(field.at(x, y)[b]);
            for (std::size_t k = 0; k < numbersOfBin; ++k)
                out[indices.index(x, y, b * numbersOfBin + k)] = numbers[k];
        }
    });
    return out;
}

/// A pixel's bins of such planes.
template <class Numbers>
Bins binsAt(const Planes<Numbers>& planes, int x, int y)
{
    Bins out;
    for (std::size_t b = 0; b < binsOfPixel; ++b) {
        CodedBin numbers {};
        for (std::size_t k = 0; k < numbersOfBin; ++k)
            numbers[k] = static_cast<std::uint16_t>(planes.at(x, y, b * numbersOfBin + k));
        out[b] = decoded(numbers);
    }
    return out;
}

/// An image, no larger than the frame, and the pixels of it that are made.
struct BinArea {
    int width, height;
    image::Window window;
};

/// The frame and a window of it, and images smaller than the four pixels that are looked at.
inline const std::vector<BinArea>& binAreas()
{
    static const std::vector<BinArea> all { { 29, 27, { 0, 0, 29, 27 } }, { 29, 27, { 7, 3, 25, 20 } },
        { 1, 1, { 0, 0, 1, 1 } }, { 3, 2, { 0, 0, 3, 2 } }, { 29, 1, { 2, 0, 29, 1 } }, { 2, 27, { 0, 1, 2, 26 } } };
    return all;
}

/// A frame whose pixels have several receivers, with a filter of samples.
inline render::Settings binnedSettings(const render::Settings& settings, const render::ChosenFilter& filter)
{
    render::Settings s = keptSettings(settings, filter);
    s.antialias = true;
    return s;
}

/// Sets the image and its window, the bins and the exposure.
inline void setBins(PassBench& bench, const BinField& field, const BinArea& area)
{
    auto p = paramsOf(bench.layout);
    p.width = static_cast<std::uint32_t>(area.width);
    p.height = static_cast<std::uint32_t>(area.height);
    render::setRectangle(p, area.window);
    bench.value("p", p);
    bench.window(area.window);
    bench.plane("bins", planesOfBins(field, bench.layout));
}

/// Shares of bins that a kernel makes. What it writes beside its window fails the test (PassBench).
inline Planes<float> sharesMade(PassBench& bench, const BinField& field, const BinArea& area, float exposure)
{
    setBins(bench, field, area);
    bench.plane("exposure", std::vector<float> { exposure });
    bench.plane("shares", Planes<float>(bench.layout, binsOfPixel, untouched));
    if (bench.has("density"))
        bench.plane("density", Planes<float>(bench.layout, 1, untouched));
    bench.run();
    return bench.pixels<float>("shares");
}

/// The same with brighter bins and less exposure: shares are to be the same, to the bit.
inline void requireSameOfScaled(PassBench& bench, const BinField& field, const BinArea& area, float exposure)
{
    const Planes<float> shares = sharesMade(bench, field, area, exposure);
    for (const double times : { 0.5, 1024.0 }) {
        CAPTURE(times);
        BinField scaled = field;
        for (Bins& bins : scaled.pixels)
            for (Bin& bin : bins)
                bin.mean *= times;
        const Planes<float> found = sharesMade(bench, scaled, area, static_cast<float>(exposure / times));
        REQUIRE(found.values == shares.values);
    }
}

} // namespace wedge::test
