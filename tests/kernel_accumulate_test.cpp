// accumulate.cl alone, terms: pixels hold the means over their receivers, in whatever waves those came.
#include "kernels/shared/bsdf.h"
#include "kernels/shared/frame.h"
#include "kernels/shared/light.h"
#include "tests/accumulate_support.h"

#include <algorithm>
#include <limits>
#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double leastTexture = 1e-3; ///< as accumulate.cl has it

/// Samples of a term that a pixel takes with `primary` new ones: more than those, unevenly shared.
std::uint32_t termSamples(int x, int y, std::uint32_t primary)
{
    return primary == 0 ? 0 : 2 * primary + static_cast<std::uint32_t>(x + y) % primary;
}

/// A term's planes of pixels.
struct TermPixels {
    Planes<std::uint32_t> before, after; ///< samples taken before and after a round
    device::Buffer<float> texture, value, plain, squares, textureSquares, radiance, extremes, weightOf;
    device::Buffer<std::uint32_t> wanted, taken;

    TermPixels(Accumulation& a, std::size_t values)
        : before(a.waves.layout, 1, 0u)
        , after(a.waves.layout, 1, 0u)
        , texture(a.pixelBuffer(3))
        , value(a.pixelBuffer(values))
        , plain(a.pixelBuffer(1))
        , squares(a.pixelBuffer(1))
        , textureSquares(a.pixelBuffer(1))
        , radiance(a.pixelBuffer(3))
        , extremes(a.pixelBuffer(3))
        , weightOf(a.pixelBuffer(1))
        , wanted(a.waves.bench.filled(a.waves.layout.size, 0u))
        , taken(a.waves.bench.filled(a.waves.layout.size, 0u))
    {
    }
    /// Call after Accumulation::begin().
    void begin(Accumulation& a)
    {
        before = after;
        a.waves.everyPixel([&](int x, int y) {
            const std::uint32_t primary = std::max(a.wanted.at(x, y), a.taken.at(x, y)) - a.taken.at(x, y);
            after.at(x, y) += termSamples(x, y, primary);
        });
        wanted = a.waves.bench.buffer(after.values);
    }
    /// For WEDGE_TERM_PARAMETERS.
    auto planes() const { return std::tie(wanted, taken, texture, value, plain, squares, textureSquares, radiance, extremes); }
};

/// Sums of all terms.
struct SharedPixels {
    device::Buffer<float> radiance;
    device::Buffer<std::uint32_t> samples, ofPaths;
    explicit SharedPixels(Accumulation& a)
        : radiance(a.pixelBuffer(3))
        , samples(a.waves.bench.filled(a.waves.layout.size, 0u))
        , ofPaths(a.waves.bench.filled(a.waves.layout.size, 0u))
    {
    }
};

/// Where a receiver is seen from.
shared::Vec3 viewOf(const SeenPoint& p)
{
    const glm::vec3 v = glm::normalize(glm::vec3(p.normal) + glm::vec3(0.4f, 0.1f, -0.2f));
    return shared::vec3(v.x, v.y, v.z);
}

shared::AreaLight lamp(glm::vec3 power)
{
    shared::AreaLight light {};
    light.power = shared::vec3(power.x, power.y, power.z);
    return light;
}

void accumulateLight(
    Accumulation& a, TermPixels& term, SharedPixels& all, const shared::AreaLight& light, bool starts, bool specular)
{
    const auto mean = [](const SeenPoint& p, std::size_t plane) {
        return p.weight[plane / 2] * (plane % 2 == 1 ? p.visible[plane / 2] : 1.0);
    };
    a.launch("accumulateLight", light, starts ? 1u : 0u, a.lists.pixelFirst, a.lists.pixelCount, a.primaryTaken,
        a.hits, a.vectors([](const SeenPoint& p) { return p.position; }), a.vectors([](const SeenPoint& p) { return p.normal; }),
        a.vectors([](const SeenPoint& p) { return p.position; }), a.objectId, a.objectId,
        a.receiverBuffer<float>(1, [](const SeenPoint& p, std::size_t) { return p.gloss; }), a.lists.pixelOf,
        a.receiverBuffer<std::uint32_t>(1, [](const SeenPoint& p, std::size_t) { return shared::packDirection(viewOf(p)); }),
        a.receiverBuffer<float>(1, [](const SeenPoint&, std::size_t) { return 0; }),
        a.vectors([](const SeenPoint& p) { return p.diffuse; }),
        a.vectors([](const SeenPoint& p) { return p.specular; }), a.sums(specular ? 4 : 2, term.before, term.after, mean),
        a.receiverBuffer<float>(2, [](const SeenPoint& p, std::size_t k) { return p.slopes[k]; }),
        term.planes(), term.weightOf, all.radiance, all.samples);
}

/// Reflected radiance of one receiver under unoccluded light, and under what is visible of it.
glm::dvec3 reflected(const SeenPoint& p, const shared::AreaLight& light, bool specular, bool occluded)
{
    glm::dvec3 out(0);
    if (p.object == 0)
        return out;
    out = p.diffuse * (p.weight[0] * (occluded ? p.visible[0] : 1) / std::numbers::pi);
    if (specular)
        out += p.specular * (p.weight[1] * (occluded ? p.visible[1] : 1));
    return out * glm::dvec3(light.power.x, light.power.y, light.power.z);
}

/// The least and largest of the slopes or distances that are not 0.
std::pair<double, double> extremesOf(const std::vector<SeenPoint>& points, const std::function<const double*(const SeenPoint&)>& of)
{
    double least = std::numeric_limits<double>::infinity(), largest = 0;
    for (const SeenPoint& p : points)
        if (p.object != 0) {
            least = of(p)[0] > 0 ? std::min(least, of(p)[0]) : least;
            largest = std::max(largest, of(p)[1]);
        }
    return { std::isinf(least) ? 0.0 : least, largest };
}

/// One light's planes against the means over all that each pixel has seen.
void checkLight(Accumulation& a, const TermPixels& term, const shared::AreaLight& light, bool specular)
{
    const auto texture = a.read(term.texture), value = a.read(term.value), unweighted = a.read(term.plain);
    const auto squares = a.read(term.squares), textureSquares = a.read(term.textureSquares);
    const auto extremes = a.read(term.extremes), weight = a.read(term.weightOf);
    const auto taken = a.read(term.taken);
    for (const Planes<float>* planes : { &texture, &value, &unweighted, &squares, &textureSquares, &extremes, &weight })
        checkElsewhere(a, *planes);
    a.waves.everyPixel([&](int x, int y) {
        const std::vector<SeenPoint> seen = a.seen(x, y);
        const double n = std::max<double>(1, static_cast<double>(seen.size()));
        const auto t = [&](const SeenPoint& p) { return luminanceOf(reflected(p, light, specular, false)); };
        const auto l = [&](const SeenPoint& p) { return luminanceOf(reflected(p, light, specular, true)); };
        const double weights = sumOf(seen, t), hits = sumOf(seen, [](const SeenPoint& p) { return p.object != 0 ? 1.0 : 0.0; });
        REQUIRE(nearTo(texture.vector(x, y), sumOf(seen, [&](const SeenPoint& p) { return reflected(p, light, specular, false); }) / n));
        REQUIRE(nearTo(value.at(x, y), weights > 0 ? sumOf(seen, l) / weights : 0.0));
        REQUIRE(nearTo(squares.at(x, y), sumOf(seen, [&](const SeenPoint& p) { return l(p) * l(p); }) / n));
        REQUIRE(nearTo(textureSquares.at(x, y), sumOf(seen, [&](const SeenPoint& p) { return t(p) * t(p); }) / n));
        REQUIRE(nearTo(weight.at(x, y), weights / n));
        // Where no light can arrive none is visible.
        REQUIRE(nearTo(unweighted.at(x, y),
            sumOf(seen, [&](const SeenPoint& p) { return t(p) > 0 ? l(p) / t(p) : 0.0; }) / std::max(hits, 1.0)));
        const auto [least, largest] = extremesOf(seen, [](const SeenPoint& p) { return p.slopes; });
        REQUIRE(nearTo(extremes.at(x, y), least));
        REQUIRE(nearTo(extremes.at(x, y, 1), largest));
        REQUIRE(taken.at(x, y) == term.after.at(x, y));
    });
}

} // namespace

TEST_CASE("lights: pixels hold the means over their receivers, in one wave and in several, and lights add up")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool specular : { false, true })
            for (const Receivers kind : { Receivers::All, Receivers::LitSurfaces })
                for (const Rounds& rounds : { oneRound, threeRounds }) {
                    CAPTURE(specular);
                    CAPTURE(rounds.size());
                    Accumulation a(device, width, height, window, kind,
                        specular ? Defines { { "WEDGE_SPECULAR", "1" } } : Defines());
                    const shared::AreaLight red = lamp({ 3, 2, 1 }), blue = lamp({ 0.2f, 1, 4 });
                    TermPixels first(a, 1), second(a, 1);
                    SharedPixels all(a);
                    SurfacePixels surfaces(a);
                    for (const auto& upTo : rounds) {
                        a.begin(upTo);
                        first.begin(a);
                        second.begin(a);
                        accumulateLight(a, first, all, red, true, specular);
                        accumulateLight(a, second, all, blue, false, specular);
                        accumulateSurfaces(a, surfaces);
                    }
                    checkLight(a, first, red, specular);
                    checkLight(a, second, blue, specular);
                    const auto radiance = a.read(all.radiance);
                    const auto samples = a.read(all.samples);
                    checkElsewhere(a, radiance);
                    a.waves.everyPixel([&](int x, int y) {
                        const std::vector<SeenPoint> seen = a.seen(x, y);
                        const glm::dvec3 sum = sumOf(seen, [&](const SeenPoint& p) {
                            return reflected(p, red, specular, true) + reflected(p, blue, specular, true);
                        });
                        REQUIRE(nearTo(radiance.vector(x, y), sum / std::max<double>(1, static_cast<double>(seen.size()))));
                        REQUIRE(samples.at(x, y) == first.after.at(x, y) + second.after.at(x, y));
                    });
                }
    });
}

TEST_CASE("lights: texture times value is the radiance, and what plain means miss is their covariance (5.10)")
{
    onEveryDevice([](const device::Device& device) {
        for (const Receivers kind : { Receivers::All, Receivers::LitSurfaces }) {
            Accumulation a(device, width, height, window, kind, { { "WEDGE_SPECULAR", "1" } });
            const shared::AreaLight light = lamp({ 3, 2, 1 });
            TermPixels term(a, 1);
            SharedPixels all(a);
            a.begin(total);
            term.begin(a);
            accumulateLight(a, term, all, light, true, true);
            a.end();
            const auto texture = a.read(term.texture), value = a.read(term.value), plain = a.read(term.plain);
            const auto radiance = a.read(all.radiance);
            double largest = 0;
            a.waves.everyPixel([&](int x, int y) {
                const double k = luminanceOf(texture.vector(x, y));
                REQUIRE(nearTo(k * value.at(x, y), luminanceOf(radiance.vector(x, y))));
                if (kind == Receivers::All || a.taken.at(x, y) == 0)
                    return;
                // L - k E is the mean of (k_i - k)(E_i - E).
                const std::vector<SeenPoint> seen = a.seen(x, y);
                const double n = static_cast<double>(seen.size());
                const auto ki = [&](const SeenPoint& p) { return luminanceOf(reflected(p, light, true, false)); };
                const auto ei = [&](const SeenPoint& p) { return luminanceOf(reflected(p, light, true, true)) / ki(p); };
                const double meanK = sumOf(seen, ki) / n, meanE = sumOf(seen, ei) / n;
                const double covariance = sumOf(seen, [&](const SeenPoint& p) { return (ki(p) - meanK) * (ei(p) - meanE); }) / n;
                const double error = luminanceOf(radiance.vector(x, y)) - k * plain.at(x, y);
                REQUIRE(std::fabs(error - covariance) < 1e-5);
                largest = std::max(largest, std::fabs(covariance));
            });
            CHECK((largest > 0.05 || kind == Receivers::All));
        }
    });
}

TEST_CASE("paths: means weighted by reflectances, in one wave and in several, and components add up")
{
    onEveryDevice([](const device::Device& device) {
        for (const Rounds& rounds : { oneRound, threeRounds }) {
            CAPTURE(rounds.size());
            Accumulation a(device, width, height, window, Receivers::All);
            TermPixels first(a, 3), second(a, 3);
            SharedPixels all(a);
            SurfacePixels surfaces(a);
            const auto reflectance = [](const SeenPoint& p, bool glossy) { return glossy ? p.specular : p.diffuse; };
            const auto add = [&](TermPixels& term, bool glossy) {
                term.begin(a);
                const auto mean = [](const SeenPoint& p, std::size_t c) { return c < 3 ? p.irradiance[static_cast<int>(c)] : 1.0; };
                a.launch("accumulatePaths", glossy ? 0u : 1u, 0u, a.lists.pixelFirst, a.lists.pixelCount, a.primaryTaken, a.hits,
                    a.objectId, a.vectors([&](const SeenPoint& p) { return reflectance(p, glossy); }),
                    a.sums(4, term.before, term.after, mean),
                    a.receiverBuffer<float>(3, [](const SeenPoint& p, std::size_t k) { return p.reflectors[k]; }),
                    term.planes(), all.radiance, all.samples, all.ofPaths);
            };
            for (const auto& upTo : rounds) {
                a.begin(upTo);
                add(first, false);
                add(second, true);
                accumulateSurfaces(a, surfaces);
            }
            const auto radiance = a.read(all.radiance);
            const auto samples = a.read(all.samples), ofPaths = a.read(all.ofPaths);
            a.waves.everyPixel([&](int x, int y) {
                const std::vector<SeenPoint> seen = a.seen(x, y);
                const glm::dvec3 sum = sumOf(seen, [&](const SeenPoint& p) {
                    return p.object != 0 ? (p.diffuse + p.specular) * p.irradiance : glm::dvec3(0);
                });
                REQUIRE(nearTo(radiance.vector(x, y), sum / std::max<double>(1, static_cast<double>(seen.size()))));
                REQUIRE(samples.at(x, y) == first.after.at(x, y) + second.after.at(x, y));
                REQUIRE(ofPaths.at(x, y) == samples.at(x, y));
            });
            for (const bool glossy : { false, true }) {
                const TermPixels& term = glossy ? second : first;
                const auto texture = a.read(term.texture), value = a.read(term.value), plain = a.read(term.plain);
                const auto squares = a.read(term.squares), textureSquares = a.read(term.textureSquares);
                const auto extremes = a.read(term.extremes);
                for (const Planes<float>* planes : { &texture, &value, &plain, &squares, &textureSquares, &extremes })
                    checkElsewhere(a, *planes);
                a.waves.everyPixel([&](int x, int y) {
                    std::vector<SeenPoint> seen = a.seen(x, y);
                    const double n = std::max<double>(1, static_cast<double>(seen.size()));
                    std::erase_if(seen, [](const SeenPoint& p) { return p.object == 0; });
                    const double hits = std::max<double>(1, static_cast<double>(seen.size()));
                    const auto k = [&](const SeenPoint& p) { return reflectance(p, glossy); };
                    const glm::dvec3 mean = sumOf(seen, k) / n;
                    const glm::dvec3 weights = sumOf(seen, [&](const SeenPoint& p) { return k(p) + leastTexture; });
                    const glm::dvec3 weighted = sumOf(seen, [&](const SeenPoint& p) { return (k(p) + leastTexture) * p.irradiance; });
                    REQUIRE(nearTo(texture.vector(x, y), mean));
                    REQUIRE(nearTo(value.vector(x, y), seen.empty() ? glm::dvec3(0) : weighted / weights, 1e-4));
                    REQUIRE(nearTo(plain.at(x, y), sumOf(seen, [](const SeenPoint& p) { return luminanceOf(p.irradiance); }) / hits));
                    REQUIRE(nearTo(squares.at(x, y),
                        sumOf(seen, [&](const SeenPoint& p) { return std::pow(luminanceOf(k(p) * p.irradiance), 2); }) / n));
                    REQUIRE(nearTo(textureSquares.at(x, y),
                        sumOf(seen, [&](const SeenPoint& p) { return std::pow(luminanceOf(k(p)), 2); }) / n));
                    const auto [least, largest] = extremesOf(seen, [](const SeenPoint& p) { return p.reflectors; });
                    REQUIRE(nearTo(extremes.at(x, y), least));
                    REQUIRE(nearTo(extremes.at(x, y, 1), largest));
                    REQUIRE(nearTo(extremes.at(x, y, 2), sumOf(seen, [](const SeenPoint& p) { return p.reflectors[2]; })));
                    // Their product is the radiance, but for what the least texture changes.
                    const glm::dvec3 l = sumOf(seen, [&](const SeenPoint& p) { return k(p) * p.irradiance; }) / n;
                    REQUIRE(glm::length(mean * value.vector(x, y) - l) < 6 * leastTexture);
                });
            }
        }
    });
}

TEST_CASE("ambient occlusion: what is open over white surfaces, and black where there is none")
{
    onEveryDevice([](const device::Device& device) {
        for (const Rounds& rounds : { oneRound, threeRounds }) {
            Accumulation a(device, width, height, window, Receivers::All);
            TermPixels term(a, 3);
            SharedPixels all(a);
            SurfacePixels surfaces(a);
            const auto occluded = [](const SeenPoint& p) { return p.irradiance / 3.0; };
            for (const auto& upTo : rounds) {
                a.begin(upTo);
                term.begin(a);
                a.launch("accumulatePaths", 1u, 1u, a.lists.pixelFirst, a.lists.pixelCount, a.primaryTaken, a.hits, a.objectId,
                    a.vectors([](const SeenPoint& p) { return p.diffuse; }),
                    a.sums(4, term.before, term.after,
                        [&](const SeenPoint& p, std::size_t c) { return c < 3 ? occluded(p)[static_cast<int>(c)] : 1.0; }),
                    a.receiverBuffer<float>(3, [](const SeenPoint& p, std::size_t k) { return p.reflectors[k]; }),
                    term.planes(), all.radiance, all.samples, all.ofPaths);
                accumulateSurfaces(a, surfaces);
            }
            const auto radiance = a.read(all.radiance), texture = a.read(term.texture), value = a.read(term.value);
            a.waves.everyPixel([&](int x, int y) {
                std::vector<SeenPoint> seen = a.seen(x, y);
                const double n = std::max<double>(1, static_cast<double>(seen.size()));
                std::erase_if(seen, [](const SeenPoint& p) { return p.object == 0; });
                const double hits = static_cast<double>(seen.size());
                const glm::dvec3 open = sumOf(seen, [&](const SeenPoint& p) { return 1.0 - occluded(p); });
                REQUIRE(nearTo(radiance.vector(x, y), open / n));
                REQUIRE(nearTo(texture.vector(x, y), glm::dvec3(hits / n)));
                REQUIRE(nearTo(value.vector(x, y), open / std::max(1.0, hits)));
            });
        }
    });
}

TEST_CASE("lights as published: plain means of the form factor's visible part, and of the lobe towards the light's centre")
{
    onEveryDevice([](const device::Device& device) {
        for (const Rounds& rounds : { oneRound, threeRounds }) {
            Accumulation a(device, width, height, window, Receivers::All, { { "WEDGE_SPECULAR", "1" } });
            a.published = 1;
            shared::AreaLight light = lamp({ 300, 200, 100 });
            light.centre = shared::vec3(12, 22, -3);
            light.normal = shared::vec3(0, -1, 0);
            TermPixels term(a, 1);
            SharedPixels all(a);
            SurfacePixels surfaces(a);
            for (const auto& upTo : rounds) {
                a.begin(upTo);
                term.begin(a);
                accumulateLight(a, term, all, light, true, true);
                accumulateSurfaces(a, surfaces);
            }
            const glm::dvec3 centre(12, 22, -3), power(300, 200, 100);
            const auto irradiance = [&](const SeenPoint& p) {
                const glm::dvec3 d = centre - p.position;
                const double squared = glm::dot(d, d);
                return p.weight[0] * p.visible[0] * std::max(0.0, glm::dot(p.normal, d)) * std::max(0.0, d.y) / (squared * squared);
            };
            const auto texture = [&](const SeenPoint& p) {
                const auto narrow = [](glm::dvec3 v) { return shared::vec3(float(v.x), float(v.y), float(v.z)); };
                const shared::Vec3 view = shared::unpackDirection(shared::packDirection(viewOf(p)));
                const double lobe = shared::specularLobe(narrow(p.normal), view, narrow(glm::normalize(centre - p.position)),
                    static_cast<float>(p.gloss), WEDGE_SPECULAR_BLINN_PHONG);
                return power * (p.diffuse / std::numbers::pi + p.specular * lobe);
            };
            const auto value = a.read(term.value), plain = a.read(term.plain), k = a.read(term.texture);
            const auto own = a.read(term.radiance), radiance = a.read(all.radiance);
            double largest = 0;
            a.waves.everyPixel([&](int x, int y) {
                std::vector<SeenPoint> seen = a.seen(x, y);
                const double n = std::max<double>(1, static_cast<double>(seen.size()));
                std::erase_if(seen, [](const SeenPoint& p) { return p.object == 0; });
                const double hits = std::max<double>(1, static_cast<double>(seen.size()));
                const glm::dvec3 l = sumOf(seen, [&](const SeenPoint& p) { return texture(p) * irradiance(p); }) / n;
                REQUIRE(nearTo(value.at(x, y), sumOf(seen, irradiance) / hits, 1e-4));
                REQUIRE(nearTo(plain.at(x, y), sumOf(seen, irradiance) / hits, 1e-4));
                REQUIRE(nearTo(k.vector(x, y), sumOf(seen, texture) / n, 1e-4));
                REQUIRE(nearTo(own.vector(x, y), l, 1e-4));
                REQUIRE(nearTo(radiance.vector(x, y), l, 1e-4));
                largest = std::max(largest, l.x);
            });
            CHECK(largest > 0.05);
        }
    });
}
