// What pixels are to hold of a term after its waves, in double, and the planes in which accumulate.cl keeps that.
#pragma once

#include "tests/accumulate_support.h"

#include <algorithm>
#include <string>
#include <tuple>

namespace wedge::test {

/// What one receiver of a wave adds to a term.
struct TermSample {
    SeenPoint point;
    std::uint32_t samples; ///< of the term, that it has taken
    bool known = true; ///< whether its texture is
    glm::dvec3 texture, radiance, irradiance; ///< black where nothing was hit
    double plain; ///< luminance of the irradiance
    glm::dvec3 weights; ///< of the irradiance, in each channel
};

/// The means of a pixel.
struct TermMeans {
    glm::dvec3 texture {}, value {}, radiance {};
    double plain = 0, squares = 0, textureSquares = 0, floor = 0; ///< floor: what weights are besides textures
    double deviation = 0; ///< of the value's luminance, by halves of waves, or from what is held
    double primary = 0, hits = 0, taken = 0,
           sampled = 0; ///< samples, those that hit, the term's, and primary ones with some
    double least = std::numeric_limits<double>::infinity(), largest = 0, sums[4] {};

    /// Adds the receivers of a wave, as published or not.
    void add(const std::vector<TermSample>& wave, bool published)
    {
        if (wave.empty())
            return;
        const auto sum = [&](const auto& of) {
            decltype(of(wave[0])) all {};
            for (const TermSample& s : wave)
                all += s.samples > 0 && s.point.object != 0 ? of(s) : decltype(all) {};
            return all;
        };
        const double all = static_cast<double>(wave.size());
        const double ran =
            static_cast<double>(std::ranges::count_if(wave, [](const TermSample& s) { return s.samples > 0; }));
        // Of earlier waves it is not kept which samples hit.
        const double share = primary > 0 ? hits / primary : 0;
        const glm::dvec3 held = published ? glm::dvec3(hits) : taken * (texture + floor * share);
        const glm::dvec3 weights = held + sum([](const TermSample& s) { return s.weights; });
        addDeviation(wave, luminanceOf(held), luminanceOf(value * held));
        const glm::dvec3 weighted = value * held + sum([](const TermSample& s) { return s.weights * s.irradiance; });
        for (int c = 0; c < 3; ++c)
            value[c] = weights[c] > 0 ? weighted[c] / weights[c] : 0;
        const double heldHits = share * sampled, newHits = sum([](const TermSample&) { return 1.0; });
        plain =
            (plain * heldHits + sum([](const TermSample& s) { return s.plain; })) / std::max(heldHits + newHits, 1e-9);
        const double had = std::max(sampled + ran, 1.0);
        squares =
            (squares * sampled + sum([](const TermSample& s) { return std::pow(luminanceOf(s.radiance), 2); })) / had;
        radiance = (radiance * sampled + sum([](const TermSample& s) { return s.radiance; })) / had;
        if (std::ranges::all_of(wave, [](const TermSample& s) { return s.known; })) {
            glm::dvec3 textures {};
            double squared = 0;
            for (const TermSample& s : wave) {
                textures += s.texture;
                squared += std::pow(luminanceOf(s.texture), 2);
            }
            texture = (texture * primary + textures) / (primary + all);
            textureSquares = (textureSquares * primary + squared) / (primary + all);
        }
        for (const TermSample& s : wave) {
            hits += s.point.object != 0 ? 1 : 0;
            taken += s.samples;
        }
        primary += all;
        sampled += ran;
    }
    /// held, heldValue: luminances of earlier waves' weights, and of what they weigh
    void addDeviation(const std::vector<TermSample>& wave, double held, double heldValue)
    {
        double total = 0, before = 0, halves[2] = {}, weights[2] = {}; // of the first half of the samples, of the rest
        for (const TermSample& s : wave)
            total += s.samples;
        for (const TermSample& s : wave) {
            const int half = before < total / 2 ? 0 : 1;
            before += s.samples;
            if (s.samples > 0 && s.point.object != 0) {
                halves[half] += luminanceOf(s.weights * s.irradiance);
                weights[half] += luminanceOf(s.weights);
            }
        }
        const double all = weights[0] + weights[1], mean = all > 0 ? (halves[0] + halves[1]) / all : 0;
        double apart = halves[0] - mean * weights[0] - (halves[1] - mean * weights[1]);
        // Of one half alone, from what is held already.
        if (weights[0] == 0 || weights[1] == 0)
            apart = held > 0 ? std::sqrt(held / (held + all)) * (all * mean - all * heldValue / held) : 0;
        deviation = held + all > 0 ? (deviation * held + apart) / (held + all) : 0;
    }
    /// Adds the slopes or distances of receivers that took samples, and of lights the motions of shadows.
    void addExtremes(
        const std::vector<TermSample>& wave, const std::function<const double*(const SeenPoint&)>& of, int planes)
    {
        for (const TermSample& s : wave)
            if (s.point.object != 0 && s.samples > 0) {
                least = of(s.point)[0] > 0 ? std::min(least, of(s.point)[0]) : least;
                largest = std::max(largest, of(s.point)[1]);
                for (int k = 2; k < planes; ++k)
                    sums[k - 2] += of(s.point)[k];
            }
    }
    double luminance() const { return luminanceOf(texture * value); }
    double leastOrNone() const { return std::isinf(least) ? 0 : least; }
    /// The sum of inverse distances, or what has three tenths of its mean as near as the least.
    double nearness() const { return std::max(sums[0], std::isinf(least) ? 0.0 : 0.3 * taken / least); }
};

/// How many samples of a term pixel (x, y) takes with `primary` new ones in that round.
using TermCount = std::uint32_t (*)(int x, int y, std::uint32_t primary, std::size_t round);
/// More than there are receivers, unevenly shared.
inline std::uint32_t more(int x, int y, std::uint32_t primary, std::size_t)
{
    return primary == 0 ? 0 : 2 * primary + static_cast<std::uint32_t>(x + y) % primary;
}
inline std::uint32_t oneEach(int, int, std::uint32_t primary, std::size_t) { return primary; }
/// From one up to all but one.
inline std::uint32_t fewer(int x, int y, std::uint32_t primary, std::size_t round)
{
    return primary < 2 ? primary : 1 + static_cast<std::uint32_t>(x + 2 * y + static_cast<int>(round)) % (primary - 1);
}
/// Fewer, and none at all in the second round.
inline std::uint32_t skipping(int x, int y, std::uint32_t primary, std::size_t round)
{
    return round == 1 ? 0 : fewer(x, y, primary, round);
}
inline std::string nameOf(TermCount count)
{
    return count == more ? "more" : count == oneEach ? "one each" : count == fewer ? "fewer" : "skipping";
}

/// A term's planes of pixels, and what they are to hold.
struct TermPixels {
    Planes<std::uint32_t> before, after; ///< samples taken before and after a round
    device::Buffer<float> texture, value, plain, squares, textureSquares, radiance, deviation, extremes, shadows;
    device::Buffer<float> error, extreme, spreads; ///< of lean frames
    device::Buffer<std::uint32_t> wanted, taken, samples, ofPaths;
    std::vector<TermMeans> means, measured; ///< measured: after the first wave, which alone measures in lean frames
    std::size_t round = 0;
    TermCount count;
    bool light = false; ///< or indirect light
    bool moves = false; ///< things whose shadows are seen

    TermPixels(Accumulation& a, TermCount counts, double floor = 0)
        : before(a.waves.layout, 1, 0u)
        , after(a.waves.layout, 1, 0u)
        , texture(a.pixelBuffer(3))
        , value(a.pixelBuffer(3))
        , plain(a.pixelBuffer(1))
        , squares(a.pixelBuffer(1))
        , textureSquares(a.pixelBuffer(1))
        , radiance(a.pixelBuffer(3))
        , deviation(a.pixelBuffer(1))
        , extremes(a.pixelBuffer(3))
        , shadows(a.pixelBuffer(4))
        , error(a.pixelBuffer(1))
        , extreme(a.pixelBuffer(1))
        , spreads(a.pixelBuffer(1))
        , wanted(a.waves.bench.filled(a.waves.layout.size, 0u))
        , taken(a.waves.bench.filled(a.waves.layout.size, 0u))
        , samples(a.waves.bench.filled(a.waves.layout.size, 0u))
        , ofPaths(a.waves.bench.filled(a.waves.layout.size, 0u))
        , means(a.waves.layout.size)
        , count(counts)
    {
        for (TermMeans& m : means)
            m.floor = floor;
    }
    /// Call after Accumulation::begin().
    void begin(Accumulation& a)
    {
        before = after;
        a.waves.everyPixel([&](int x, int y) {
            const std::uint32_t primary = std::max(a.wanted.at(x, y), a.taken.at(x, y)) - a.taken.at(x, y);
            after.at(x, y) += count(x, y, primary, round);
        });
        wanted = a.waves.bench.buffer(after.values);
        // Lean frames know from elsewhere how many there are before a wave.
        taken = a.once() ? a.waves.bench.buffer(before.values) : taken;
        ++round;
    }
    std::uint32_t bitsOfTexture(const Accumulation& a) const
    {
        return a.steps ? colourBits : textureBits(a.lean, light);
    }
    std::uint32_t bitsOfValue(const Accumulation& a) const { return a.steps ? colourBits : valueBits(a.lean, light); }
    /// What the kernels are handed of it.
    std::vector<Handed> planes(const Accumulation& a) const
    {
        const bool sums = a.measures && !a.lean, spread = a.measures && a.lean, once = a.measures && a.once();
        const bool both = sums || (a.measures && a.steps && !light), motions = sums || (a.measures && a.steps);
        std::vector<Handed> out = group("term",
            { plane("texture", texture, Accumulation::colour(bitsOfTexture(a))),
                plane("value", value, Accumulation::colour(bitsOfValue(a))),
                onlyIf(a.published != 0, vectors("radiance", radiance)), plane("deviation", deviation, a.number()),
                onlyIf(a.measures && !once, plane("plain", plain)), onlyIf(sums, plane("squares", squares)),
                onlyIf(sums, plane("textureSquares", textureSquares)),
                onlyIf(once, plane("error", error, render::shortFloats)),
                onlyIf(spread, plane("spreads", spreads, render::shortPairs)) });
        const graph::Format ends = light ? graph::pairs : a.steps ? render::shortReflectors : graph::vectors;
        const std::vector<Handed> others { plane("wanted", wanted), plane("termTaken", taken),
            onlyIf(both, plane("extremes", extremes, ends)),
            onlyIf(spread && !both, plane("extreme", extreme, render::shortFloats)),
            onlyIf(motions && moves, plane("shadowSums", shadows, graph::floatPlanes(4))),
            onlyIf(once && moves, plane("shadowMotion", shadows, render::shortPairs)),
            onlyIf(!a.lean, plane("samples", samples)), onlyIf(!a.lean, plane("indirectSamples", ofPaths)) };
        out.insert(out.end(), others.begin(), others.end());
        return out;
    }

    /// Adds the receivers' slopes or distances to the expected ones; before expect().
    void expectExtremes(const Accumulation& a, const std::function<const double*(const SeenPoint&)>& of, int planes)
    {
        for (std::size_t r = 0; r < a.points.size(); ++r)
            means[after.index(a.lists.x(r), a.lists.y(r))].addExtremes(
                { { a.points[r], a.shareOf(r, before, after), true, {}, {}, {}, 0, {} } }, of, planes);
    }
    /// Adds the wave to the expected means: `of` tells what a pixel's receivers, whose samples are set, add.
    template <class Of>
    void expect(const Accumulation& a, const Of& of)
    {
        std::vector<std::vector<TermSample>> waves(means.size());
        for (std::size_t r = 0; r < a.points.size(); ++r)
            waves[after.index(a.lists.x(r), a.lists.y(r))].push_back(
                { a.points[r], a.shareOf(r, before, after), true, {}, {}, {}, 0, {} });
        for (std::size_t i = 0; i < means.size(); ++i) {
            of(waves[i]);
            means[i].add(waves[i], a.published != 0);
        }
        measured = round == 1 || a.steps ? means : measured;
        for (TermMeans& m : means) {
            const double spread = m.squares - std::pow(m.luminance(), 2);
            m.texture = rounded(m.texture, bitsOfTexture(a));
            m.value = rounded(m.value, bitsOfValue(a));
            if (a.lean)
                m.deviation =
                    static_cast<double>(shared::unpackShort(shared::packShort(static_cast<float>(m.deviation))));
            // Squares go on from spreads, which are not below 0 where the weighted mean is more than the plain one.
            if (a.steps)
                m.squares = std::max(0.0, spread) + std::pow(m.luminance(), 2);
        }
    }

    /// Holds what the kernels made against the means.
    void check(Accumulation& a) const
    {
        const auto k = coloursOf(a.read(texture), bitsOfTexture(a)), e = coloursOf(a.read(value), bitsOfValue(a));
        const auto own = a.read(radiance), noise = a.lean ? numbersOf(a.read(deviation), 0) : a.read(deviation);
        for (const Planes<float>* plane : { &k, &e, &own, &noise })
            checkElsewhere(a, *plane);
        int apart = 0, noisy = 0, pixels = 0;
        a.waves.everyPixel([&](int x, int y) {
            CAPTURE(x);
            CAPTURE(y);
            const TermMeans& m = means[after.index(x, y)];
            // In fewer bits a rounding decides between two.
            const double unitOfTexture = unitOf(m.texture, bitsOfTexture(a)),
                         unitOfValue = unitOf(m.value, bitsOfValue(a));
            const bool nearTexture = nearTo(k.vector(x, y), m.texture),
                       nearValue = nearTo(e.vector(x, y), m.value, 1e-4);
            REQUIRE((nearTexture || glm::length(k.vector(x, y) - m.texture) <= 1.5 * unitOfTexture));
            for (std::size_t c = 0; c < 3; ++c)
                REQUIRE(std::fabs(e.at(x, y, c) - m.value[static_cast<int>(c)])
                    <= 1e-4 * m.value[static_cast<int>(c)] + 1e-6 + (a.steps ? 3 : 1) * unitOfValue);
            REQUIRE(std::fabs(noise.at(x, y) - m.deviation)
                <= 2e-4 * luminanceOf(m.value) + 1e-5 + (a.lean ? std::fabs(m.deviation) / 64 : 0));
            noisy += std::fabs(m.deviation) > 0.1 * luminanceOf(m.value) ? 1 : 0;
            apart += nearTexture && nearValue ? 0 : 1;
            ++pixels;
            REQUIRE(nearTo(own.vector(x, y), a.published != 0 ? m.radiance : glm::dvec3(0), 1e-4));
        });
        CHECK((!a.lean || apart < 0.1 * pixels));
        CHECK(noisy > 0);
        if (a.lean)
            checkDifferences(a);
        else
            checkMeasured(a);
    }
    void checkMeasured(Accumulation& a) const
    {
        const auto unweighted = a.read(plain), squared = a.read(squares), squaredTexture = a.read(textureSquares);
        const auto found = a.read(extremes), motions = a.read(shadows);
        const auto ran = a.read(taken), all = a.read(samples);
        for (const Planes<float>* plane : { &unweighted, &squared, &squaredTexture, &found })
            checkElsewhere(a, *plane);
        a.waves.everyPixel([&](int x, int y) {
            CAPTURE(x);
            CAPTURE(y);
            const TermMeans& m = means[after.index(x, y)];
            REQUIRE(nearTo(unweighted.at(x, y), m.plain, 1e-4));
            REQUIRE(nearTo(squared.at(x, y), m.squares, 1e-4));
            REQUIRE(nearTo(squaredTexture.at(x, y), m.textureSquares, 1e-4));
            REQUIRE(nearTo(found.at(x, y), m.leastOrNone()));
            REQUIRE(nearTo(found.at(x, y, 1), m.largest));
            if (!light)
                REQUIRE(nearTo(found.at(x, y, 2), m.sums[0]));
            for (std::size_t plane = 0; light && plane < 4; ++plane)
                REQUIRE(nearTo(motions.at(x, y, plane), m.sums[plane]));
            REQUIRE(ran.at(x, y) == after.at(x, y));
            REQUIRE(all.at(x, y) == after.at(x, y));
        });
    }
    /// The error of taking the term apart, deviations, and the least slope or the sum of inverse distances: of the
    /// first wave, or of all, where each wave's means are rounded before the next one goes on with them.
    void checkDifferences(Accumulation& a) const
    {
        const bool distances = a.steps && !light;
        const auto apart = numbersOf(a.read(error), 0), least = numbersOf(a.read(distances ? extremes : extreme), 0),
                   inverse = numbersOf(a.read(extremes), 1);
        const auto unweighted = a.read(plain);
        const double off = a.steps ? 3e-3 : 1e-5, near = a.steps ? 0.03 : 0.01;
        const auto ofSample = numbersOf(a.read(spreads), 0), ofTexture = numbersOf(a.read(spreads), 1);
        for (const Planes<float>* plane : { &apart, &least, &inverse, &ofSample, &ofTexture })
            checkElsewhere(a, *plane);
        int errors[2] = {}, deviations = 0;
        a.waves.everyPixel([&](int x, int y) {
            CAPTURE(x);
            CAPTURE(y);
            const TermMeans& m = measured[after.index(x, y)];
            const double t = luminanceOf(m.texture), l = luminanceOf(m.texture * m.value), difference = l - t * m.plain;
            if (a.steps)
                REQUIRE(nearTo(unweighted.at(x, y), m.plain, 1e-4));
            else
                REQUIRE(std::fabs(apart.at(x, y) - difference) <= unitOf(difference) + off * (l + t * m.plain));
            const double variances[] = { std::max(0.0, m.squares - l * l), std::max(0.0, m.textureSquares - t * t) };
            REQUIRE(
                nearTo(std::pow(ofSample.at(x, y), 2), variances[0], near + off * m.squares / (variances[0] + 1e-9)));
            REQUIRE(nearTo(
                std::pow(ofTexture.at(x, y), 2), variances[1], near + off * m.textureSquares / (variances[1] + 1e-9)));
            REQUIRE(nearTo(least.at(x, y), light || distances ? m.leastOrNone() : m.nearness(), 1.0 / 256));
            REQUIRE((!distances || nearTo(inverse.at(x, y), m.sums[0], 1.0 / 64)));
            ++errors[difference > 0 ? 1 : 0];
            deviations += variances[0] > 0.01 && variances[1] > 0.01 ? 1 : 0;
        });
        CHECK(errors[0] > 10);
        CHECK(errors[1] > 10);
        CHECK(deviations > 10);
        for (const std::uint32_t added : a.waves.bench.read(samples))
            REQUIRE(added == 0);
    }
    /// The one motion of a light's shadows in the first wave, or that there are several.
    void checkShadows(Accumulation& a) const
    {
        const auto motions = a.read(shadows);
        int one = 0, several = 0;
        a.waves.everyPixel([&](int x, int y) {
            CAPTURE(x);
            CAPTURE(y);
            const double* sums = measured[after.index(x, y)].sums;
            const double n = std::max(sums[3], 1.0), mx = sums[0] / n, my = sums[1] / n, squared = mx * mx + my * my;
            const double spread = std::max(0.0, sums[2] / n - squared), allowed = std::pow(a.oneVelocity, 2) * squared;
            if (sums[3] > 0 && std::fabs(spread - allowed) < 1e-4)
                return;
            const double foundX = shared::unpackShort(shortOf(motions, x, y, 0)),
                         foundY = shared::unpackShort(shortOf(motions, x, y, 1));
            if (spread > allowed) {
                REQUIRE(foundX == std::numeric_limits<double>::infinity());
                REQUIRE(foundY == 0);
                ++several;
                return;
            }
            REQUIRE(nearTo(foundX, mx, 1.0 / 256));
            REQUIRE(nearTo(foundY, my, 1.0 / 256));
            one += mx > 0 ? 1 : 0;
        });
        CHECK(one > 20);
        CHECK(several > 20);
    }
};

/// Where a receiver is seen from.
inline shared::Vec3 viewOf(const SeenPoint& p)
{
    const glm::vec3 v = glm::normalize(glm::vec3(p.normal) + glm::vec3(0.4f, 0.1f, -0.2f));
    return shared::vec3(v.x, v.y, v.z);
}

/// Launches accumulateLight for the wave.
inline void accumulateLight(
    Accumulation& a, TermPixels& term, const shared::AreaLight& light, bool exact, bool specular)
{
    const auto mean = [](const SeenPoint& p, std::size_t plane) {
        return p.weight[plane / 2] * (plane % 2 == 1 ? p.visible[plane / 2] : 1.0);
    };
    a.launch("accumulateLight",
        std::vector { value("light", light), plane("hits", a.hits, a.hitCounts()),
            vectors("position", a.vectors([](const SeenPoint& p) { return p.position; })),
            vectors("normal", a.vectors([](const SeenPoint& p) { return p.normal; })),
            vectors("origin", a.vectors([](const SeenPoint& p) { return p.position; })), plane("geometric", a.objectId),
            plane("objectId", a.objectId), plane("gloss", a.glosses()), plane("pixelOf", a.lists.pixelOf),
            plane("view",
                a.receiverBuffer<std::uint32_t>(
                    1, [](const SeenPoint& p, std::size_t) { return shared::packDirection(viewOf(p)); })),
            plane("time", a.receiverBuffer<float>(1, [](const SeenPoint&, std::size_t) { return 0; })),
            vectors("diffuse", a.vectors([](const SeenPoint& p) { return p.diffuse; })),
            vectors("specular", a.vectors([](const SeenPoint& p) { return p.specular; })),
            plane("sums", a.sums(specular ? 4 : 2, term.before, term.after, mean)),
            onlyIf(exact,
                plane("unshadowed",
                    a.receiverBuffer<float>(2, [](const SeenPoint& p, std::size_t k) { return p.unshadowed[k]; }),
                    graph::pairs)),
            plane(
                "slopes", a.receiverBuffer<float>(6, [](const SeenPoint& p, std::size_t k) { return p.slopes[k]; })) },
        term.planes(a));
}

/// Launches accumulatePaths for the wave; mean: of the samples of a receiver, in each channel; bins: what samples by
/// brightness are handed as, or nothing.
template <class Reflectance, class Mean>
void accumulatePaths(Accumulation& a, TermPixels& term, bool ambient, const Reflectance& reflectance, const Mean& mean,
    const std::vector<Handed>& bins = {})
{
    a.launch("accumulatePaths",
        std::vector { value("ambient", ambient ? 1u : 0u), plane("hits", a.hits, a.hitCounts()),
            plane("objectId", a.objectId), vectors("reflectance", a.vectors(reflectance)),
            plane("sums",
                a.sums(4, term.before, term.after,
                    [&](const SeenPoint& p, std::size_t c) { return c < 3 ? mean(p)[static_cast<int>(c)] : 1.0; })),
            plane("reflectors",
                a.receiverBuffer<float>(3, [](const SeenPoint& p, std::size_t k) { return p.reflectors[k]; })) },
        bins, term.planes(a));
}

} // namespace wedge::test
