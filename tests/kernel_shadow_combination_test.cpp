// combineShadowLights of shadow_combination.cl and wholeLobes of whole_light.cl alone: what sums of lights make of a
// map's whole light, against the host in double.
#include "tests/shadow_lights_support.h"

#include <limits>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

/// Of wider lobes' sums beside own ones'.
constexpr double wideShare = 0.1f;

} // namespace

TEST_CASE("combineShadowLights: what is left of the whole light, each way, and how often it is clamped")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, under(scene::SpecularModel::Phong, 40), settings(render::Shadows::Ratio));
        PassBench primary(frame, "primary"), bench(frame, "combineShadowLights");
        primary.run();
        bench.plane("normal", primary.read<float>("normal"));
        std::mt19937 random(3);
        const std::size_t size = frame.layout.size;
        std::vector<float> reflected = someNumbers(random, 3 * size, 0.1, 1);
        for (std::size_t i = 0; i < size; i += 5) // some are black
            reflected[i] = reflected[size + i] = reflected[2 * size + i] = 0;
        bench.plane("diffuse", reflected);
        bench.plane("specular", someNumbers(random, 3 * size, 0, 1));
        std::vector<std::uint32_t> lights = someCounts(random, size, 4); // none of a quarter, and beside surfaces
        const std::vector<std::uint32_t> objects = primary.read<std::uint32_t>("objectId");
        for (std::size_t i = 0; i < size; ++i)
            lights[i] = objects[i] == 0 ? 0 : lights[i];
        bench.plane("taken", lights);
        // Shadowed is at most unshadowed; some have no light at all.
        const auto sums = [&](std::size_t pairs) {
            std::vector<float> out = someNumbers(random, 6 * pairs * size, 0, 3);
            for (std::size_t pair = 0; pair < pairs; ++pair)
                for (std::size_t i = 0; i < 3 * size; ++i) {
                    float& a = out[6 * pair * size + i];
                    float& u = out[(6 * pair + 3) * size + i];
                    u = random() % 8 == 0 ? 0.0f : u;
                    a = random() % 4 == 0 ? u : std::min(a, u);
                }
            return out;
        };
        bench.plane("whole", someNumbers(random, 3 * size, 0, 2));
        bench.plane("mattSums", sums(1));
        bench.plane("lobeSums", sums(2));
        bench.value("mostRed", 2.0f);
        bench.value("mostGreen", 1.5f);
        bench.value("mostBlue", 1.0f);
        const std::vector<float> before = someNumbers(random, 3 * size);
        const auto run = [&](std::uint32_t shadows, bool prefiltered, bool clamps, bool wide) {
            bench.plane("lit", before);
            bench.value("shadows", shadows);
            bench.value("complete", prefiltered ? WEDGE_COMPLETE_PREFILTERED : WEDGE_COMPLETE_LIGHTS);
            bench.value("clamps", clamps ? 1u : 0u);
            bench.value("wide", wide ? 1u : 0u);
            bench.run();
            return bench.pixels<float>("lit");
        };
        const auto at = [&](const char* name) { return bench.pixels<float>(name); };
        const auto diffuse = at("diffuse"), specular = at("specular"), matt = at("mattSums"), lobes = at("lobeSums");
        const auto taken = bench.pixels<std::uint32_t>("taken");
        const auto start = planesOf(frame.layout, before);
        const auto only = [&](const Planes<float>& after, int x, int y, std::size_t c) {
            return double { after.at(x, y, c) } - start.at(x, y, c);
        };

        SUBCASE("with the lights' own light for the whole all are as additive, within four roundings")
        {
            const auto additive = run(WEDGE_SHADOWS_ADDITIVE, false, false, false);
            for (const std::uint32_t shadows : { WEDGE_SHADOWS_SUBTRACTIVE, WEDGE_SHADOWS_RATIO }) {
                const auto other = run(shadows, false, true, false);
                const auto clamped = bench.pixels<std::uint32_t>("clamped");
                everyPixel(frame.layout, [&](int x, int y) {
                    REQUIRE(clamped.at(x, y) == 0);
                    for (std::size_t c = 0; c < 3; ++c) {
                        const double k = diffuse.at(x, y, c), s = specular.at(x, y, c);
                        const double a = k * matt.at(x, y, c) + s * lobes.at(x, y, c);
                        const double whole = k * matt.at(x, y, c + 3) + s * lobes.at(x, y, c + 3);
                        // The sum with what was there before rounds, too.
                        const double error =
                            std::numeric_limits<float>::epsilon() * (2 * whole + std::abs(start.at(x, y, c)) + a);
                        REQUIRE(std::abs(only(other, x, y, c) - only(additive, x, y, c)) <= error);
                        REQUIRE(std::abs(only(additive, x, y, c) - (taken.at(x, y) > 0 ? a : 0)) <= error);
                    }
                });
            }
        }
        SUBCASE("of the map's own light")
        {
            // The whole light itself, by a ratio of what hides nothing.
            const auto kept = bench.read<float>("mattSums");
            const auto keptLobes = bench.read<float>("lobeSums");
            bench.plane("mattSums", std::vector<float>(kept.size(), 1.0f));
            bench.plane("lobeSums", std::vector<float>(keptLobes.size(), 1.0f));
            bench.plane("specular", std::vector<float>(3 * size, 0.0f));
            const auto ofMatt = run(WEDGE_SHADOWS_RATIO, true, false, true);
            bench.plane("specular", specular);
            const auto both = run(WEDGE_SHADOWS_RATIO, true, false, true);
            bench.plane("mattSums", kept);
            bench.plane("lobeSums", keptLobes);
            const auto wholeOf = at("whole");
            // Of matt surfaces that no light reaches nothing is known to be lit.
            const auto reached = [&](int x, int y, std::size_t c) { return matt.at(x, y, c + 3) > 0 ? 1.0 : 0.0; };
            const auto part = [&](const Planes<float>& planes, int x, int y, std::size_t c, bool wide) {
                const double u = double { planes.at(x, y, c + 3) } + (wide ? wideShare * planes.at(x, y, c + 9) : 0.0);
                const double a = double { planes.at(x, y, c) } + (wide ? wideShare * planes.at(x, y, c + 6) : 0.0);
                return u > 0 ? a / u : 1.0;
            };
            const auto ratio = run(WEDGE_SHADOWS_RATIO, true, false, true);
            const auto clamped = run(WEDGE_SHADOWS_SUBTRACTIVE, true, true, false);
            const auto counts = bench.pixels<std::uint32_t>("clamped");
            const auto open = run(WEDGE_SHADOWS_SUBTRACTIVE, true, false, false);
            const auto none = bench.pixels<std::uint32_t>("clamped");
            std::size_t below = 0;
            everyPixel(frame.layout, [&](int x, int y) {
                bool any = false, perhaps = false;
                for (std::size_t c = 0; c < 3; ++c) {
                    const bool there = taken.at(x, y) > 0;
                    const double k = diffuse.at(x, y, c), s = specular.at(x, y, c);
                    const double wholeMatt = reached(x, y, c) * only(ofMatt, x, y, c),
                                 wholeLobe = there ? s * wholeOf.at(x, y, c) : 0.0;
                    REQUIRE(std::abs(only(both, x, y, c) - only(ofMatt, x, y, c) - wholeLobe) <= 1e-5);
                    const auto near = [](double value, double expected) {
                        return std::abs(value - expected) <= 2e-6 * (3 + std::abs(expected));
                    };
                    const double byRatio =
                        wholeMatt * part(matt, x, y, c, false) + wholeLobe * part(lobes, x, y, c, true);
                    REQUIRE(near(only(ratio, x, y, c), byRatio));
                    const double m = wholeMatt - k * (double { matt.at(x, y, c + 3) } - matt.at(x, y, c));
                    const double l = wholeLobe - s * (double { lobes.at(x, y, c + 3) } - lobes.at(x, y, c));
                    REQUIRE(near(only(open, x, y, c), there ? m + l : 0));
                    REQUIRE(near(only(clamped, x, y, c), there ? std::max(m, 0.0) + std::max(l, 0.0) : 0));
                    any |= there && (m < -1e-5 || l < -1e-5);
                    perhaps |= there && ((k > 0 && m < 1e-5) || (s > 0 && l < 1e-5));
                }
                REQUIRE((counts.at(x, y) == 1 || !any));
                REQUIRE((counts.at(x, y) == 0 || perhaps));
                REQUIRE(none.at(x, y) == 0);
                below += any ? 1 : 0;
            });
            CHECK(below > 100);
        }
    });
}

TEST_CASE("combineShadowLights: of sums over the map, what no light reaches is as if nothing hid it")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(
            device, under(scene::SpecularModel::Phong, 40), settings(render::Shadows::Ratio, render::WholeLight::Map));
        PassBench combine(frame, "combineShadowLights");
        std::mt19937 random(5);
        const std::size_t size = frame.layout.size;
        for (const char* name : { "diffuse", "specular", "wholeMatt", "whole" })
            combine.plane(name, someNumbers(random, 3 * size, 0.1, 2));
        std::vector<float> matt = someNumbers(random, 6 * size, 0.1, 1), lobes = someNumbers(random, 12 * size, 0.1, 1);
        for (std::size_t i = 0; i < size; i += 3) { // nothing reaches these
            for (std::size_t plane = 0; plane < 6; ++plane)
                matt[plane * size + i] = 0;
            for (std::size_t plane = 0; plane < 12; ++plane)
                lobes[plane * size + i] = 0;
        }
        combine.plane("mattSums", matt);
        combine.plane("lobeSums", lobes);
        combine.plane("taken", std::vector<std::uint32_t>(size, 1));
        combine.plane("lit", std::vector<float>(3 * size, 0.0f));
        combine.run();
        const auto at = [&](const char* name) { return combine.pixels<float>(name); };
        const auto lit = at("lit"), diffuse = at("diffuse"), specular = at("specular"), ofMatt = at("wholeMatt"),
                   ofLobes = at("whole"), m = at("mattSums"), l = at("lobeSums");
        std::size_t open = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            for (std::size_t c = 0; c < 3; ++c) {
                const double all = m.at(x, y, c + 3),
                             wide = double { l.at(x, y, c + 3) } + wideShare * l.at(x, y, c + 9);
                const double share = all > 0 ? m.at(x, y, c) / all : 1;
                const double lobeShare =
                    wide > 0 ? (double { l.at(x, y, c) } + wideShare * l.at(x, y, c + 6)) / wide : 1;
                const double expected = diffuse.at(x, y, c) * ofMatt.at(x, y, c) * share
                    + specular.at(x, y, c) * ofLobes.at(x, y, c) * lobeShare;
                REQUIRE(lit.at(x, y, c) == doctest::Approx(expected).epsilon(1e-5));
                open += all > 0 ? 0 : 1;
            }
        });
        CHECK(open > 1000);
    });
}

TEST_CASE("combineShadowLights, wholeLobes: the whole light of a smooth map is the integral over it")
{
    onEveryDevice([](const device::Device& device) {
        // L = 1 + 0.5 d.up: pi (1 + n.up / 3) / pi by diffuse reflection, exactly of the harmonics.
        auto slope = even(glm::vec3(0), 64, 32);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x)
                set(*slope, x, y, glm::dvec3(1 + 0.5 * std::cos(std::numbers::pi * (y + 0.5) / 32)));
        scene::Scene scene = under(scene::SpecularModel::Phong, 30);
        render::setEnvironment(scene, slope);
        DeclaredFrame frame(device, scene, settings(render::Shadows::Ratio));
        Traced traced(frame, render::mapLights(*frame.scene().picture(), count));
        const PassBench& primary = traced.primary;
        PassBench combine(frame, "combineShadowLights"), whole(frame, "wholeLobes");
        const std::size_t size = frame.layout.size;
        whole.take(traced.pass);
        std::vector<float> reflected(3 * size, 1.0f);
        for (std::size_t i = 0; i < size; i += 3)
            reflected[i] = reflected[size + i] = reflected[2 * size + i] = 0;
        whole.plane("specular", reflected);
        whole.plane("whole", std::vector<float>(3 * size, 0.0f));
        whole.run();
        combine.plane("normal", primary.read<float>("normal"));
        combine.plane("taken", std::vector<std::uint32_t>(size, 1));
        for (const char* name : { "mattSums", "lobeSums" })
            combine.plane(name, std::vector<float>(combine.read<float>(name).size(), 1.0f));
        combine.plane("diffuse", std::vector<float>(3 * size, 1.0f));
        combine.plane("specular", std::vector<float>(3 * size, 0.0f));
        combine.plane("lit", std::vector<float>(3 * size, 0.0f));
        combine.run();
        const auto object = primary.pixels<std::uint32_t>("objectId");
        const auto normal = primary.pixels<float>("normal"), position = primary.pixels<float>("position");
        const glm::dvec3 eye = toGlm(primary.own<shared::FrameParams>("frame").eye);
        const auto lit = combine.pixels<float>("lit"), lobes = whole.pixels<float>("whole");
        const auto reflects = whole.pixels<float>("specular");
        std::size_t seen = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            if (object.at(x, y) == 0)
                return;
            const glm::dvec3 n = normal.vector(x, y), view = glm::normalize(eye - position.vector(x, y));
            REQUIRE(lit.at(x, y) == doctest::Approx(1 + n.y / 3).epsilon(0.005));
            if (reflects.at(x, y) == 0) {
                REQUIRE(lobes.at(x, y) == 0);
            } else if ((x + y) % 7 == 0) {
                double expected = 0;
                const shared::Gloss gloss = shared::makeGloss(30, WEDGE_PHONG);
                constexpr int rows = 90;
                for (int row = 0; row < rows; ++row)
                    for (int column = 0; column < 2 * rows; ++column) {
                        const double polar = std::numbers::pi * (row + 0.5) / rows,
                                     turn = std::numbers::pi * (column + 0.5) / rows;
                        const glm::dvec3 l(
                            std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn));
                        const double solidAngle = std::sin(polar) * std::numbers::pi / rows * std::numbers::pi / rows;
                        expected +=
                            solidAngle * std::max(glm::dot(n, l), 0.0) * lobe(gloss, n, view, l) * (1 + 0.5 * l.y);
                    }
                REQUIRE(lobes.at(x, y) == doctest::Approx(expected).epsilon(0.03));
                ++seen;
            }
        });
        CHECK(seen > 60);
    });
}

TEST_CASE("combineShadowLights: matt surfaces that face the black half of a map are black")
{
    onEveryDevice([](const device::Device& device) {
        auto above = even(glm::vec3(0), 64, 32);
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 64; ++x)
                set(*above, x, y, glm::dvec3(1));
        scene::Scene scene = under(scene::SpecularModel::Phong, 30);
        render::setEnvironment(scene, above);
        for (const render::Shadows shadows : { render::Shadows::Ratio, render::Shadows::Subtractive }) {
            DeclaredFrame frame(device, scene, settings(shadows));
            PassBench combine(frame, "combineShadowLights");
            const std::size_t size = frame.layout.size;
            std::vector<float> down(3 * size, 0.0f);
            std::fill(down.begin() + static_cast<std::ptrdiff_t>(size),
                down.begin() + static_cast<std::ptrdiff_t>(2 * size), -1.0f);
            combine.plane("normal", down);
            combine.plane("taken", std::vector<std::uint32_t>(size, 1));
            combine.plane("diffuse", std::vector<float>(3 * size, 1.0f));
            const std::size_t numbers = combine.read<float>("mattSums").size();
            for (const float brought : { 0.0f, 1e-3f }) { // by lights in front of it, which nothing hides
                combine.plane("mattSums", std::vector<float>(numbers, brought));
                combine.plane("lit", std::vector<float>(3 * size, 0.0f));
                combine.run();
                CHECK(std::ranges::all_of(
                    combine.read<float>("lit"), [](float value) { return std::abs(value) < 1e-3f; }));
            }
        }
    });
}
