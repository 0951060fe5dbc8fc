// widening.cl's numbers of a pixel, one of a light and one of paths: against the same in double.
#include "kernels/shared/filter_params.h"
#include "kernels/shared/indirect.h"
#include "kernels/shared/packed.h"
#include "kernels/shared/path.h"
#include "kernels/shared/wedge.h"
#include "tests/pass_bench.h"

#include <numbers>

using namespace wedge;
using namespace wedge::test;

TEST_CASE("widen: of a light and of paths one number, its noise and what it is worth")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool specular : { false, true }) {
            scene::Scene scene = smallScene();
            scene.materials[0].specular = glm::vec3(specular ? 0.3f : 0.0f);
            render::Settings settings = sized(render::axisAligned(16), 37, 11);
            settings.bounces = 1;
            DeclaredFrame frame(device, scene, settings);
            const render::PlaneLayout layout = frame.layout;
            const std::size_t channels = specular ? 2 : 1;
            std::mt19937 random(5);
            Planes<float> value(layout, 2, 0.0f), parts(layout, 2, 0.0f), sums(layout, 4, 0.0f), kd(layout, 3, 0.0f),
                ks(layout, 3, 0.0f);
            Planes<std::uint32_t> taken(layout, 1, 0u);
            everyPixel(layout, [&](int x, int y) {
                taken.at(x, y) =
                    random() % 8 == 0 ? 0 : WEDGE_INDIRECT_FIRST_RAYS + static_cast<std::uint32_t>(random() % 60);
                for (std::size_t plane = 0; plane < 2; ++plane) {
                    value.at(x, y, plane) = static_cast<float>(uniform(random));
                    parts.at(x, y, plane) = shared::unpackShort(shared::packShort(static_cast<float>(uniform(random))));
                }
                for (std::size_t plane = 0; plane < 4; ++plane)
                    sums.at(x, y, plane) = static_cast<float>(taken.at(x, y) * uniform(random, 0.1, 2));
                if (random() % 5 != 0)
                    kd.setVector(x, y, { uniform(random), uniform(random), uniform(random) });
                if (random() % 3 != 0)
                    ks.setVector(x, y, { uniform(random), uniform(random), uniform(random) });
            });
            const auto check = [&](const PassBench& pass, const char* seen, std::uint32_t firstPass,
                                   const auto& weightOf, const auto& meanOf) {
                const auto v = pass.pixels<float>(seen), d = pass.pixels<float>("deviation"),
                           w = pass.pixels<float>("weights");
                int black = 0, noisy = 0;
                everyPixel(layout, [&](int x, int y) {
                    const double weight = weightOf(x, y), n = taken.at(x, y),
                                 h = n >= 2 * firstPass ? std::floor(n / 2) : std::floor(firstPass / 2.0);
                    const double all = weight > 0 ? meanOf(x, y, 0) / weight : 0,
                                 part = weight > 0 ? meanOf(x, y, 1) / weight : 0;
                    REQUIRE(std::fabs(w.at(x, y) - weight) < 1e-5);
                    REQUIRE(std::fabs(v.at(x, y) - all) < 1e-5);
                    const double off = n > h ? (part - all) * std::sqrt(h / (n - h)) : 0;
                    REQUIRE(std::fabs(d.at(x, y) - off) < 1e-5);
                    black += weight == 0 ? 1 : 0;
                    noisy += std::fabs(off) > 0.1 ? 1 : 0;
                });
                CHECK(black > 10);
                CHECK(noisy > 100);
            };
            PassBench light(frame, "oneOfLight");
            REQUIRE(light.own<std::uint32_t>("firstPass") == WEDGE_FIRST_PASS_RAYS);
            for (const auto& [name, planes] :
                { std::pair("value", &value), { "parts", &parts }, { "sums", &sums } }) // of as many as there are
                light.plane(name,
                    std::vector(planes->values.begin(),
                        planes->values.begin() + static_cast<std::ptrdiff_t>(light.read<float>(name).size())));
            light.plane("taken", taken);
            light.plane("diffuse", kd);
            light.plane("specular", ks);
            light.run();
            const auto reflected = [&](int x, int y, std::size_t c) {
                const double n = std::max(1u, taken.at(x, y));
                return c == 0 ? luminanceOf(kd.vector(x, y)) / std::numbers::pi * sums.at(x, y) / n
                              : luminanceOf(ks.vector(x, y)) * sums.at(x, y, 2) / n;
            };
            check(
                light, "visibility", WEDGE_FIRST_PASS_RAYS,
                [&](int x, int y) { return reflected(x, y, 0) + (specular ? reflected(x, y, 1) : 0); },
                [&](int x, int y, std::size_t part) {
                    double sum = 0;
                    for (std::size_t c = 0; c < channels; ++c)
                        sum += reflected(x, y, c) * (part == 0 ? value : parts).at(x, y, c);
                    return sum;
                });
            Planes<float> colours(layout, 3, 0.0f);
            everyPixel(layout, [&](int x, int y) {
                colours.setVector(x, y, { uniform(random), uniform(random), uniform(random) });
            });
            PassBench paths(frame, "oneOfPaths");
            REQUIRE(paths.own<std::uint32_t>("firstPass") == WEDGE_INDIRECT_FIRST_RAYS);
            REQUIRE(paths.own<std::uint32_t>("component") == WEDGE_COMPONENT_DIFFUSE);
            paths.plane("reflectance", kd);
            paths.plane("value", sums);
            paths.plane("parts", colours);
            paths.plane("taken", taken);
            const auto ofPart = paths.pixels<float>("parts"); // in 48 bits
            paths.run();
            constexpr double luminances[] = { 0.2126, 0.7152, 0.0722 };
            check(
                paths, "irradiance", WEDGE_INDIRECT_FIRST_RAYS,
                [&](int x, int y) {
                    double sum = 0;
                    for (std::size_t c = 0; c < 3; ++c)
                        sum += luminances[c] * kd.at(x, y, c);
                    return sum;
                },
                [&](int x, int y, std::size_t part) {
                    double sum = 0;
                    for (std::size_t c = 0; c < 3; ++c)
                        sum += luminances[c] * kd.at(x, y, c)
                            * (part == 0 ? sums.at(x, y, c) / std::max(1.0, static_cast<double>(taken.at(x, y)))
                                         : ofPart.at(x, y, c));
                    return sum;
                });
            // Sums become means, and their fourth plane the variance.
            const auto after = paths.pixels<float>("value"), ofPaths = paths.pixels<float>("deviation");
            for (int y = 0; y < static_cast<int>(layout.height); ++y)
                for (int x = 0; x < static_cast<int>(layout.width); ++x) {
                    REQUIRE(after.at(x, y, 3) == ofPaths.at(x, y) * ofPaths.at(x, y));
                    for (std::size_t c = 0; c < 3; ++c)
                        REQUIRE(after.at(x, y, c)
                            == doctest::Approx(sums.at(x, y, c) / std::max(1.0, static_cast<double>(taken.at(x, y))))
                                   .epsilon(1e-6));
                }
            // Of fractions the fourth plane says of what, and all colours have the same. Some samples brought nothing.
            Planes<float> some = sums;
            everyPixel(layout, [&](int x, int y) {
                for (std::size_t plane = 0; plane < 4 && x % 4 == 0; ++plane)
                    some.at(x, y, plane) = 0;
            });
            paths.value("component", WEDGE_COMPONENT_ENVIRONMENT_GLOSSY);
            paths.value("fractions", 1u);
            paths.plane("reflectance", ks);
            paths.plane("value", some);
            paths.run();
            const auto found = paths.pixels<float>("value"), noise = paths.pixels<float>("deviation");
            everyPixel(layout, [&](int x, int y) {
                double sum = 0;
                for (std::size_t c = 0; c < 3; ++c)
                    sum += luminances[c] * some.at(x, y, c);
                const double whole = some.at(x, y, 3), n = taken.at(x, y);
                const double expected = whole > 0 ? sum / whole : n > 0 ? 1 : 0; // nothing is hidden where nothing is
                for (std::size_t c = 0; c < 3; ++c)
                    REQUIRE(std::fabs(found.at(x, y, c) - expected) <= 1e-5 * std::fabs(expected));
                const double part = ofPart.at(x, y, 1) > 0 ? ofPart.at(x, y) / ofPart.at(x, y, 1) : expected,
                             h = n >= 2 * WEDGE_INDIRECT_FIRST_RAYS ? std::floor(n / 2)
                                                                    : std::floor(WEDGE_INDIRECT_FIRST_RAYS / 2.0);
                const bool black = ks.vector(x, y) == glm::dvec3(0);
                const double off = n > h && !black ? (part - expected) * std::sqrt(h / (n - h)) : 0;
                REQUIRE(std::fabs(noise.at(x, y) - off) <= 1e-4 * (1 + std::fabs(off)));
            });
        }
    });
}
