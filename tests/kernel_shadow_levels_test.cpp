// shadow_levels.cl, kernel by kernel, and what composite.cl makes of it, against the host in double.
#include "kernels/shared/styled_shadows.h"
#include "tests/lamp.h"
#include "tests/pass_bench.h"
#include "tests/render_oracles.h"
#include "tests/styled_floor.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 33, height = 7;

/// Something specular under a lamp whose shadows are larger, softer and rounder on the first object.
scene::Scene styledScene(bool twoSided, float penumbra)
{
    scene::Scene scene = smallScene();
    scene.materials[0].specular = glm::vec3(0.3f);
    scene.areaLights = { lamp(scene::LightProfile::Uniform, twoSided) };
    scene::ShadowStyle style = floors::style(0.1f, 0.05f, 0.1f, 0.2f);
    style.penumbra = penumbra;
    scene.areaLights.front().styles = { style };
    return scene;
}

class LevelFrame : public DeclaredFrame {
public:
    explicit LevelFrame(const device::Device& device, bool twoSided = false, float penumbra = 0.5f)
        : DeclaredFrame(device, styledScene(twoSided, penumbra), sized(render::axisAligned(16), width, height))
    {
    }
    const scene::AreaLight& light() const { return scene().areaLights.front(); }
};

double transferred(double d, double soft)
{
    if (soft <= 0)
        return d > 0 ? 1 : 0;
    const double t = std::clamp(d / soft + 0.5, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Its mean over distances from a to b, sum by sum.
double meanTransferred(double a, double b, double soft)
{
    constexpr int steps = 10000;
    double sum = 0;
    for (int k = 0; k < steps; ++k)
        sum += transferred(a + (b - a) * (k + 0.5) / steps, soft);
    return sum / steps;
}

} // namespace

TEST_CASE("levelMatte: lit above a level, in shadow below, unknown where the whole light is behind the surface")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool twoSided : { false, true }) {
            LevelFrame frame(device, twoSided);
            PassBench pass(frame, "levelMatte");
            CHECK(pass.own<float>("level") == doctest::Approx(0.5 + 0.5 * (0.5 * (1 - std::cos(0.19634954)) - 0.5)));
            std::mt19937 random(1);
            Planes<float> position(frame.layout, 3, 0.0f), normal(frame.layout, 3, 0.0f), value(frame.layout, 2, 0.0f);
            Planes<std::uint32_t> ids(frame.layout, 1, 0u);
            everyPixel(frame.layout, [&](int x, int y) {
                position.setVector(x, y, { uniform(random, -3, 3), uniform(random, -1, 5), uniform(random, -3, 3) });
                normal.setVector(x, y, unitVector(random));
                value.at(x, y) = static_cast<float>(uniform(random));
                ids.at(x, y) = static_cast<std::uint32_t>(random() % 5);
            });
            pass.plane("position", position);
            pass.plane("normal", normal);
            pass.plane("objectId", ids);
            pass.plane("value", value);
            pass.value("level", 0.4f);
            pass.run();
            const Planes<float> matte = pass.pixels<float>("matte");
            std::array<int, 3> found {};
            everyPixel(frame.layout, [&](int x, int y) {
                bool seen = false;
                const glm::dvec3 at = position.vector(x, y), n = normal.vector(x, y);
                for (const double a : { -1.0, 1.0 })
                    for (const double b : { -1.0, 1.0 })
                        seen = seen || glm::dot(pointOf(frame.light(), a, b) - at, n) > 0;
                const double before = glm::dot(lightNormal(frame.light()), at - glm::dvec3(frame.light().centre));
                seen = seen && ids.at(x, y) != 0 && (twoSided || before > 0);
                const float lit = std::clamp(value.at(x, y) - 0.4f + 0.5f, 0.0f, 1.0f);
                REQUIRE(matte.at(x, y) == (seen ? lit : WEDGE_MATTE_UNKNOWN));
                ++found[matte.at(x, y) < 0 ? 0 : matte.at(x, y) > 0.5f ? 1 : 2];
            });
            CHECK(*std::ranges::min_element(found) > 10);
        }
    });
}

TEST_CASE("addLevel: the mean of the transfer function over distances that are linear between two levels")
{
    onEveryDevice([](const device::Device& device) {
        LevelFrame frame(device);
        for (const float soft : { 0.0f, 0.3f, 50.0f }) {
            CAPTURE(soft);
            PassBench pass(frame, "addLevel");
            std::mt19937 random(2);
            const std::size_t size = frame.layout.size;
            const std::vector<float> plain = someNumbers(random, size), before = someNumbers(random, size);
            std::vector<float> styled = someNumbers(random, size), styledBefore = someNumbers(random, size);
            for (std::size_t i = 0; i < size; i += 5)
                styledBefore[i] = styled[i] + 1e-5f * styledBefore[i]; // hardly apart
            pass.plane("distance", plain);
            pass.plane("previous", before);
            pass.plane("smoothed", styled);
            pass.plane("previousSmoothed", styledBefore);
            const float zero = 0.05f, zeroBefore = -0.1f, inflation = 0.2f;
            pass.plane("zeros", std::vector<float> { zero, 7 });
            pass.plane("previousZeros", std::vector<float> { zeroBefore, 7 });
            pass.value("inflation", inflation);
            pass.value("softness", soft);
            pass.value("both", 0.5f);
            pass.value("beforeThem", 0.125f);
            pass.value("afterThem", 0.25f);
            pass.value("end", 0.5f);
            pass.value("pairs", 4.0f);
            pass.run();
            const Planes<float> change = pass.pixels<float>("change");
            const Planes<float> a = planesOf(frame.layout, before), b = planesOf(frame.layout, plain);
            const Planes<float> c = planesOf(frame.layout, styledBefore), d = planesOf(frame.layout, styled);
            everyPixel(frame.layout, [&](int x, int y) {
                const auto seen = [&](double from, double to, double width) {
                    const double step = 0.5 * (to - from);
                    return 0.5 * meanTransferred(from, to, width) + 0.125 * meanTransferred(from - step, from, width)
                        + 0.25 * meanTransferred(to, to + step, width);
                };
                const double from = double { c.at(x, y) } - double { zeroBefore } - double { inflation };
                const double to = double { d.at(x, y) } - double { zero } - double { inflation };
                const double asIs = seen(a.at(x, y), b.at(x, y), 0);
                REQUIRE(std::abs(change.at(x, y, WEDGE_LEVEL_PLAIN) - asIs) < 3e-4); // steps of the oracle's
                REQUIRE(std::abs(change.at(x, y, WEDGE_LEVEL_STYLED) - seen(from, to, soft)) < 3e-4);
                REQUIRE(change.at(x, y, WEDGE_LEVEL_MOVED)
                    == doctest::Approx(
                        (std::abs(to - double { b.at(x, y) }) + std::abs(from - double { a.at(x, y) })) / 8)
                           .epsilon(1e-4));
                REQUIRE(change.at(x, y, WEDGE_LEVEL_NEAREST) == std::min(std::abs(a.at(x, y)), std::abs(b.at(x, y))));
            });
            // Once more: sums, and the nearest of all.
            pass.value("beforeThem", 0.0f);
            std::vector<float> far = plain;
            std::ranges::transform(far, far.begin(), [](float v) { return v + 3; });
            pass.plane("distance", far);
            pass.plane("previous", far);
            pass.run();
            const Planes<float> twice = pass.pixels<float>("change");
            everyPixel(frame.layout, [&](int x, int y) {
                REQUIRE(twice.at(x, y, WEDGE_LEVEL_NEAREST) == change.at(x, y, WEDGE_LEVEL_NEAREST));
                REQUIRE(twice.at(x, y, WEDGE_LEVEL_PLAIN)
                    == doctest::Approx(double { change.at(x, y, WEDGE_LEVEL_PLAIN) } + 0.75));
            });
        }
    });
}

TEST_CASE("addLevel of a single level: on one side of its edge all of the light is seen, on the other nothing")
{
    onEveryDevice([](const device::Device& device) {
        LevelFrame frame(device, false, 0);
        PassBench pass(frame, "addLevel");
        CHECK_FALSE(pass.has("previous"));
        CHECK(pass.own<float>("both") + pass.own<float>("beforeThem") + pass.own<float>("afterThem") == 1.0f);
        std::mt19937 random(5);
        const std::vector<float> plain = someNumbers(random, frame.layout.size);
        const std::vector<float> styled = someNumbers(random, frame.layout.size);
        pass.plane("distance", plain);
        pass.plane("smoothed", styled);
        pass.plane("zeros", std::vector<float> { 0.05f, 7 });
        const float soft = 0.3f, inflation = 0.2f;
        pass.value("inflation", inflation);
        pass.value("softness", soft);
        pass.run();
        const Planes<float> change = pass.pixels<float>("change");
        const Planes<float> distance = planesOf(frame.layout, plain), moved = planesOf(frame.layout, styled);
        everyPixel(frame.layout, [&](int x, int y) {
            const double d = double { distance.at(x, y) }, to = double { moved.at(x, y) } - 0.05 - double { inflation };
            REQUIRE(change.at(x, y, WEDGE_LEVEL_PLAIN) == (d > 0 ? 1.0f : 0.0f));
            REQUIRE(std::abs(change.at(x, y, WEDGE_LEVEL_STYLED) - transferred(to, double { soft })) < 1e-5);
            REQUIRE(change.at(x, y, WEDGE_LEVEL_MOVED) == doctest::Approx(std::abs(to - d)).epsilon(1e-4));
            REQUIRE(change.at(x, y, WEDGE_LEVEL_NEAREST) == std::abs(distance.at(x, y)));
        });
    });
}

TEST_CASE("softStyle: what levels say, where the style moves something and an edge is near")
{
    onEveryDevice([](const device::Device& device) {
        LevelFrame frame(device);
        PassBench pass(frame, "softStyle");
        std::mt19937 random(3);
        const std::size_t size = frame.layout.size;
        const std::vector<float> value = someNumbers(random, 2 * size, 0, 1.05);
        std::vector<float> levels = someNumbers(random, WEDGE_LEVEL_PLANES * size, 0, 1);
        for (std::size_t i = 0; i < size; i += 4)
            levels[WEDGE_LEVEL_MOVED * size + i] = 0;
        const std::vector<std::uint32_t> ids = someCounts(random, size, 3);
        const float penumbra = 0.5f, soft = 0.01f, pixelSize = 0.5f, largest = 0.8f, weight = 0.25f;
        std::vector<float> normal(3 * size, 0.0f); // up, to the lamp; in every seventh pixel down
        for (std::size_t i = 0; i < size; ++i)
            normal[size + i] = i % 7 == 0 ? -1.0f : 1.0f;
        const Planes<float> normals = planesOf(frame.layout, normal);
        pass.plane("normal", normal);
        pass.plane("value", value);
        pass.plane("change", levels);
        pass.plane("objectId", ids);
        pass.plane("pixelSize", std::vector<float>(size, pixelSize));
        pass.plane("seen", std::vector<float>(6 * size, 0.5f));
        const std::array<float, 3> left { 0.0f, 0.25f, 0.75f };
        for (const auto& [name, number] :
            { std::pair("penumbra", penumbra), { "softness", soft }, { "largest", largest }, { "weight", weight },
                { "red", left[0] }, { "green", left[1] }, { "blue", left[2] } })
            pass.value(name, number);
        pass.run();
        const Planes<float> seen = pass.pixels<float>("seen"), change = planesOf(frame.layout, levels);
        const Planes<float> v = planesOf(frame.layout, value);
        const Planes<std::uint32_t> object = planesOf(frame.layout, ids);
        everyPixel(frame.layout, [&](int x, int y) {
            for (std::size_t c = 0; c < 6; ++c) {
                const double is = v.at(x, y, c / 3), base = std::clamp((is - 0.5) / 0.5 + 0.5, 0.0, 1.0);
                const auto level = [&](std::size_t plane) { return double { change.at(x, y, plane) }; };
                const double moved = std::min((level(WEDGE_LEVEL_MOVED) + 0.005) / 0.5, 1.0);
                const double near = std::clamp(2 - 2 * level(WEDGE_LEVEL_NEAREST) / 0.8, 0.0, 1.0);
                const double plain = level(WEDGE_LEVEL_PLAIN);
                const double step = level(WEDGE_LEVEL_STYLED) - plain - moved * (base - plain);
                const double lit = std::clamp(base + near * step, 0.0, 1.0);
                const double k = left[c % 3], more = weight * (k + (1 - k) * lit - is);
                REQUIRE(seen.at(x, y, c)
                    == doctest::Approx(0.5 + (object.at(x, y) != 0 && normals.at(x, y, 1) > 0 ? more : 0.0))
                           .epsilon(1e-4));
            }
        });
    });
}

TEST_CASE("addDiffuseChange, addSpecularChange: each colour of a change, times what the light would bring")
{
    onEveryDevice([](const device::Device& device) {
        LevelFrame frame(device);
        const std::size_t size = frame.layout.size;
        for (const bool lobes : { false, true }) {
            CAPTURE(lobes);
            PassBench pass(frame, lobes ? "addSpecularChange" : "addDiffuseChange");
            PassBench known(frame, lobes ? "addSpecular" : "addDiffuse");
            std::mt19937 random(4);
            const std::vector<float> more = someNumbers(random, 6 * size);
            std::vector<float> position = someNumbers(random, 3 * size),
                               normal = someNumbers(random, 3 * size, -0.3, 0.3);
            for (std::size_t i = 0; i < size; ++i)
                normal[size + i] = 0.9f;
            const std::vector<std::uint32_t> ids = someCounts(random, size, 3);
            const std::vector<float> reflectance = someNumbers(random, 3 * size, 0.1, 0.9);
            for (PassBench* each : { &pass, &known }) {
                each->plane("position", position);
                each->plane("normal", normal);
                each->plane("objectId", ids);
                each->plane(lobes ? "specular" : "diffuse", reflectance);
                if (lobes)
                    each->plane("gloss",
                        std::vector<std::uint32_t>(size, shared::packGloss(shared::makeGloss(9.0f, WEDGE_PHONG))));
            }
            pass.plane("more", more);
            pass.plane("change", std::vector<float>(3 * size, 0.5f));
            known.plane("value", std::vector<float>(2 * size, 1.0f));
            pass.run();
            known.run();
            const Planes<float> change = pass.pixels<float>("change"), all = known.pixels<float>("direct");
            const Planes<float> seen = planesOf(frame.layout, more);
            double most = 0;
            everyPixel(frame.layout, [&](int x, int y) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const double expected = 0.5 + double { seen.at(x, y, (lobes ? 3u : 0u) + c) } * all.at(x, y, c);
                    REQUIRE(change.at(x, y, c) == doctest::Approx(expected).epsilon(1e-4));
                    most = std::max(most, std::abs(expected - 0.5));
                }
            });
            CHECK(most > 0.05);
        }
    });
}
