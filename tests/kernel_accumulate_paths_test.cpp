// accumulate.cl alone, indirect light: what pixels hold after whatever waves of receivers, of which each has samples or
// not.
#include "kernels/shared/bsdf.h"
#include "kernels/shared/frame.h"
#include "kernels/shared/light.h"
#include "tests/accumulate_oracle.h"

using namespace wedge;
using namespace wedge::test;

namespace {

/// How pixels keep a term.
struct Kept {
    std::uint32_t published;
    bool lean, steps;
};

constexpr double leastTexture = 1e-6; ///< as accumulate.cl has it

/// Indirect light of one component after all rounds, and what it is expected to be.
template <class Reflectance, class Irradiance, class Arrives>
TermPixels accumulated(Accumulation& a, const Rounds& rounds, TermCount count, bool ambient,
    const Reflectance& reflectance, const Irradiance& irradiance, const Arrives& arrives)
{
    TermPixels term(a, count, leastTexture);
    SurfacePixels surfaces(a);
    for (const auto& upTo : rounds) {
        a.begin(upTo);
        term.begin(a);
        term.expectExtremes(
            a, [](const SeenPoint& p) { return p.reflectors; }, 3);
        term.expect(a, [&](std::vector<TermSample>& wave) {
            for (TermSample& s : wave)
                if (s.point.object != 0) {
                    s.texture = ambient ? glm::dvec3(1) : reflectance(s.point);
                    s.irradiance = arrives(s.point);
                    s.plain = luminanceOf(s.irradiance);
                    s.radiance = s.texture * s.irradiance;
                    s.weights =
                        a.published != 0 ? glm::dvec3(1) : (s.texture + leastTexture) * static_cast<double>(s.samples);
                }
        });
        accumulatePaths(a, term, ambient, reflectance, irradiance);
        accumulateSurfaces(a, surfaces);
    }
    return term;
}

} // namespace

TEST_CASE("paths: the means over receivers, each with samples, few with some, or a wave without any; as published, "
          "lean, in steps")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool glossy : { false, true })
            for (const Kept& kept :
                { Kept { 0, false, false }, { 1, false, false }, { 0, true, false }, { 0, true, true } })
                for (const TermCount count : { more, oneEach, fewer, skipping })
                    for (const Rounds& rounds : { oneRound, threeRounds }) {
                        CAPTURE(glossy);
                        CAPTURE(kept.published);
                        CAPTURE(kept.lean);
                        CAPTURE(kept.steps);
                        CAPTURE(rounds.size());
                        CAPTURE(nameOf(count));
                        Accumulation a(device, width, height, window, Receivers::All);
                        a.published = kept.published;
                        a.lean = kept.lean;
                        a.steps = kept.steps;
                        const auto arrives = [](const SeenPoint& p) { return p.irradiance; };
                        const TermPixels term = accumulated(
                            a, rounds, count, false,
                            [&](const SeenPoint& p) { return glossy ? p.specular : p.diffuse; }, arrives, arrives);
                        term.check(a);
                        const auto ofPaths = a.read(term.ofPaths);
                        a.waves.everyPixel(
                            [&](int x, int y) { REQUIRE(ofPaths.at(x, y) == (a.lean ? 0 : term.after.at(x, y))); });
                    }
    });
}

TEST_CASE("paths: with a sample a receiver texture times value is the radiance in each channel")
{
    onEveryDevice([](const device::Device& device) {
        for (const Receivers kind : { Receivers::All, Receivers::Related })
            for (const Rounds& rounds : { oneRound, threeRounds }) {
                Accumulation a(device, width, height, window, kind);
                const auto arrives = [](const SeenPoint& p) { return p.irradiance; };
                const TermPixels term = accumulated(
                    a, rounds, oneEach, false, [](const SeenPoint& p) { return p.diffuse; }, arrives, arrives);
                const auto texture = a.read(term.texture), value = a.read(term.value);
                a.waves.everyPixel([&](int x, int y) {
                    const std::vector<SeenPoint> seen = a.seen(x, y);
                    const glm::dvec3 radiance = sumOf(seen, [](const SeenPoint& p) {
                        return p.object != 0 ? p.diffuse * p.irradiance : glm::dvec3(0);
                    }) / std::max<double>(1, static_cast<double>(seen.size()));
                    for (int c = 0; c < 3; ++c)
                        REQUIRE(std::fabs(texture.vector(x, y)[c] * value.vector(x, y)[c] - radiance[c])
                            <= 2e-5 * radiance[c] + 6 * leastTexture);
                });
            }
    });
}

TEST_CASE("ambient occlusion: what is open over white surfaces, and black where there is none")
{
    onEveryDevice([](const device::Device& device) {
        for (const TermCount count : { more, oneEach, fewer, skipping })
            for (const Rounds& rounds : { oneRound, threeRounds }) {
                Accumulation a(device, width, height, window, Receivers::All);
                const auto occluded = [](const SeenPoint& p) { return p.irradiance / 3.0; };
                const TermPixels term = accumulated(
                    a, rounds, count, true, [](const SeenPoint& p) { return p.diffuse; }, occluded,
                    [&](const SeenPoint& p) { return 1.0 - occluded(p); });
                term.check(a);
                if (count != oneEach)
                    continue;
                const auto texture = a.read(term.texture), value = a.read(term.value);
                a.waves.everyPixel([&](int x, int y) {
                    std::vector<SeenPoint> seen = a.seen(x, y);
                    const double n = std::max<double>(1, static_cast<double>(seen.size()));
                    std::erase_if(seen, [](const SeenPoint& p) { return p.object == 0; });
                    const double hits = static_cast<double>(seen.size());
                    REQUIRE(nearTo(texture.vector(x, y), glm::dvec3(hits / n)));
                    REQUIRE(nearTo(value.vector(x, y),
                        sumOf(seen, [&](const SeenPoint& p) { return 1.0 - occluded(p); }) / std::max(1.0, hits),
                        1e-4));
                });
            }
    });
}
