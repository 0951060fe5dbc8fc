// accumulate.cl alone: over many waves whose receivers have few samples of a term, its texture times its value goes to
// the mean of their products, also where more light arrives the brighter a surface is.
#include "kernels/shared/bsdf.h"
#include "kernels/shared/frame.h"
#include "kernels/shared/light.h"
#include "tests/accumulate_oracle.h"

#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr std::uint32_t waveCount = 60, receiversOfWave = 4;

/// A sample of the first receivers of a wave, or of two: others go without, and which they are has nothing to do with
/// them.
std::uint32_t oneOrTwo(int x, int y, std::uint32_t primary, std::size_t round)
{
    return primary < 2 ? primary : 1 + static_cast<std::uint32_t>(x + y + static_cast<int>(round)) % 2;
}
/// As many as there are receivers, and none in every other wave.
std::uint32_t allOrNone(int, int, std::uint32_t primary, std::size_t round) { return round % 2 == 0 ? primary : 0; }

/// Holds the deviations that pixels keep against how far their values, of independent samples of one kind, are apart; a
/// wave of one sample tells nothing, and there are none.
void checkDeviations(Accumulation& a, const TermPixels& term)
{
    const auto texture = a.read(term.texture), value = a.read(term.value), deviation = a.read(term.deviation);
    double sum = 0, squares = 0, expected = 0, pixels = 0;
    a.waves.everyPixel([&](int x, int y) {
        const double t = luminanceOf(texture.vector(x, y)), l = luminanceOf(texture.vector(x, y) * value.vector(x, y));
        sum += l / t;
        squares += l / t * (l / t);
        expected += deviation.at(x, y) * deviation.at(x, y);
        ++pixels;
    });
    const double variance = squares / pixels - sum / pixels * (sum / pixels);
    CAPTURE(pixels);
    CAPTURE(variance);
    CAPTURE(expected / pixels);
    CHECK(expected / pixels > 0.7 * variance);
    CHECK(expected / pixels < 1.4 * variance);
}

/// Runs the waves, and holds the mean over pixels of texture times value minus that of `expected` against its standard
/// error in each channel.
template <class Launch, class Expected>
void checkConverges(Accumulation& a, TermPixels& term, const Launch& launch, const Expected& expected)
{
    SurfacePixels surfaces(a);
    for (std::uint32_t k = 1; k <= waveCount; ++k) {
        a.begin([&](int, int) { return k * receiversOfWave; });
        term.begin(a);
        launch();
        accumulateSurfaces(a, surfaces);
    }
    if (term.count == allOrNone)
        checkDeviations(a, term);
    const auto texture = a.read(term.texture), value = a.read(term.value);
    glm::dvec3 sum {}, squares {}, mean {};
    double pixels = 0;
    a.waves.everyPixel([&](int x, int y) {
        const glm::dvec3 truth = sumOf(a.seen(x, y), expected) / static_cast<double>(a.taken.at(x, y));
        const glm::dvec3 error = texture.vector(x, y) * value.vector(x, y) - truth;
        sum += error;
        squares += error * error;
        mean += truth;
        ++pixels;
    });
    for (int c = 0; c < 3; ++c) {
        CAPTURE(c);
        const double bias = sum[c] / pixels, deviation = std::sqrt(squares[c] / pixels - bias * bias);
        CAPTURE(bias);
        CAPTURE(mean[c] / pixels);
        // The ratio of means is biased by a part in some hundred samples; not to be mistaken for a systematic error.
        CHECK(std::fabs(bias) < 4 * deviation / std::sqrt(pixels) + 0.004 * mean[c] / pixels);
        CHECK(deviation < 0.2 * mean[c] / pixels);
    }
}

} // namespace

TEST_CASE("lights: few samples converge where the unshadowed shading is known")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool specular : { false, true })
            for (const TermCount count : { oneOrTwo, allOrNone }) {
                CAPTURE(specular);
                CAPTURE((count == oneOrTwo));
                Accumulation a(device, width, height, window, Receivers::Related,
                    specular ? Defines { { "WEDGE_SPECULAR", "1" } } : Defines());
                TermPixels term(a, count);
                term.light = true;
                shared::AreaLight light {};
                light.power = shared::vec3(3, 2, 1);
                checkConverges(
                    a, term, [&] { accumulateLight(a, term, light, true, specular); },
                    [&](const SeenPoint& p) {
                        if (p.object == 0)
                            return glm::dvec3(0);
                        const glm::dvec3 lobe =
                            specular ? p.specular * (p.unshadowed[1] * p.visible[1]) : glm::dvec3(0);
                        return glm::dvec3(3, 2, 1)
                            * (p.diffuse * (p.unshadowed[0] * p.visible[0] / std::numbers::pi) + lobe);
                    });
            }
    });
}

TEST_CASE("paths: few samples converge")
{
    onEveryDevice([](const device::Device& device) {
        for (const TermCount count : { oneOrTwo, allOrNone }) {
            CAPTURE((count == oneOrTwo));
            Accumulation a(device, width, height, window, Receivers::Related);
            TermPixels term(a, count, 1e-6);
            checkConverges(
                a, term,
                [&] {
                    accumulatePaths(
                        a, term, false, [](const SeenPoint& p) { return p.diffuse; },
                        [](const SeenPoint& p) { return p.irradiance; });
                },
                [](const SeenPoint& p) { return p.object != 0 ? p.diffuse * p.irradiance : glm::dvec3(0); });
        }
    });
}
