// Shadows of some things on some things: the kernels of casters and receivers, against the host.
#include "effects/styled_shadows/style_knobs.h"
#include "effects/styled_shadows/styled_shadows.h"
#include "tests/shadow_bench.h"

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

/// The small scene with names, of which the ball and the bars throw shadows in a style.
scene::Scene named()
{
    scene::Scene scene = underSun();
    scene.geometry.objectNames = { "floor/", "things/box/", "board/", "things/ball/", "bars/" };
    scene::ShadowStyle& style = scene.directionalLights.front().styles.front();
    style.inflation.linear = 0.1f;
    style.casters = { "things/ball", "bars" };
    style.receivers = { "floor", "things/box" };
    return scene;
}

/// Of the scene's triangles those of casters, or all others.
bvh::Bvh partOf(const scene::Geometry& g, bool casters)
{
    std::vector<std::uint32_t> indices;
    for (std::size_t t = 0; t < g.objectIds.size(); ++t) {
        const bool isCaster = g.objectIds[t] >= 4;
        for (std::size_t k = 0; isCaster == casters && k < 3; ++k)
            indices.push_back(g.indices[3 * t + k]);
    }
    return bvh::build({ g.positions, indices });
}

/// The pass that finds both mattes, with what primary rays met.
PassBench benchOfCasters(DeclaredFrame& frame)
{
    PassBench primary(frame, "primary"), bench(frame, "shadowOfCasters");
    primary.run();
    for (const char* name : { "position", "normal", "origin" })
        bench.plane(name, primary.read<float>(name));
    for (const char* name : { "geometric", "objectId", "gloss" })
        bench.plane(name, primary.read<std::uint32_t>(name));
    return bench;
}

} // namespace

TEST_CASE("shadowOfCasters: what casters hide, and what all other things do, each as if alone")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, named(), settings());
        PassBench bench = benchOfCasters(frame);
        CHECK(bench.own<std::uint32_t>("objects") == 6);
        bench.plane("casters", std::vector<std::uint32_t> { 0, 0, 0, 0, 1, 1 });
        bench.plane("matte", std::vector<float>(frame.layout.size, WEDGE_MATTE_UNKNOWN));
        bench.plane("others", std::vector<float>(frame.layout.size, WEDGE_MATTE_UNKNOWN));
        bench.run();
        const auto origin = bench.pixels<float>("origin"), normal = bench.pixels<float>("normal");
        const auto matte = bench.pixels<float>("matte"), others = bench.pixels<float>("others");
        const auto occluder = bench.pixels<float>("occluder");
        const auto object = bench.pixels<std::uint32_t>("objectId"), rays = bench.pixels<std::uint32_t>("rays");
        const scene::Geometry& g = frame.scene().geometry;
        const bvh::Bvh ofCasters = partOf(g, true), ofOthers = partOf(g, false);
        unsigned kinds[4] = {}, differ = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            if (object.at(x, y) == 0 || glm::dot(normal.vector(x, y), sunward) <= 0) {
                REQUIRE(matte.at(x, y) == WEDGE_MATTE_UNKNOWN);
                REQUIRE(others.at(x, y) == WEDGE_MATTE_UNKNOWN);
                REQUIRE(rays.at(x, y) == 0);
                return;
            }
            REQUIRE(rays.at(x, y) == 1);
            const bvh::Ray ray { toVec3(origin.vector(x, y)), 0, toVec3(100.0 * sunward), 1 };
            const shared::Hit hit = bvh::closestHit(ofCasters, ray);
            const bool casts = bvh::anyHit(ofCasters, ray), hides = bvh::anyHit(ofOthers, ray);
            const double away = casts ? 100 * glm::length(sunward) * double { hit.t } : 0;
            const bool same = (matte.at(x, y) == WEDGE_MATTE_SHADOW) == casts
                && (others.at(x, y) == WEDGE_MATTE_SHADOW) == hides
                && std::abs(occluder.at(x, y) - away) <= 1e-4 * (1 + away);
            differ += same ? 0 : 1;
            ++kinds[(casts ? 1 : 0) + (hides ? 2 : 0)];
        });
        for (const unsigned kind : kinds)
            CHECK(kind > 10);
        CHECK(differ <= 4); // rays through edges
    });
}

TEST_CASE("a frame's work has each shadow of a light, one of each group of casters")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = named();
        std::vector<scene::ShadowStyle>& styles = scene.directionalLights.front().styles;
        styles.resize(3, styles.front());
        styles.back().casters = { "board" };
        const DeclaredFrame frame(device, scene, settings());
        const auto work = render::styledShadows()->unfiltered(render::monteCarlo(1), frame.scene());
        REQUIRE(work);
        CHECK(work->workUnits == 2);
    });
}

TEST_CASE("addStyle: receivers have the style, others the plain shadow, and all of them what no caster throws")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, named(), settings());
        PassBench bench(frame, "addStyle");
        std::mt19937 random(1);
        const std::size_t size = frame.layout.size;
        std::vector<float> mattes, others;
        std::vector<std::uint32_t> objects;
        mattes.reserve(size);
        others.reserve(size);
        objects.reserve(size);
        for (std::size_t i = 0; i < size; ++i) {
            mattes.push_back(static_cast<float>(random() % 2));
            others.push_back(static_cast<float>(random() % 2));
            objects.push_back(static_cast<std::uint32_t>(random() % 8)); // two of which the scene has not
        }
        bench.plane("distance", someNumbers(random, size, -0.2, 0.3));
        bench.plane("matte", mattes);
        bench.plane("others", others);
        bench.plane("objectId", objects);
        bench.plane("receivers", std::vector<std::uint32_t> { 0, 1, 1, 0, 0, 0 });
        const auto softness = bench.own<shared::StyleKnob>("softness"),
                   edge = bench.own<shared::StyleKnob>("inflation");
        bench.run();
        const auto distance = bench.pixels<float>("distance"), share = bench.pixels<float>("share");
        const auto matte = bench.pixels<float>("matte"), other = bench.pixels<float>("others");
        const auto object = bench.pixels<std::uint32_t>("objectId");
        double worst = 0;
        unsigned styled = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            const double d = double { distance.at(x, y) } - double { edge.base };
            const double t = std::clamp(d / double { softness.base } + 0.5, 0.0, 1.0);
            const glm::dvec3 left(0.1f, 0.2f, 0.3f);
            const bool receives = object.at(x, y) == 1 || object.at(x, y) == 2;
            const glm::dvec3 own =
                receives ? left + (1.0 - left) * t * t * (3 - 2 * t) : glm::dvec3(double { matte.at(x, y) });
            worst = std::max(worst, glm::length(share.vector(x, y) - own * double { other.at(x, y) }));
            styled += receives ? 1 : 0;
        });
        CHECK(worst < 1e-6);
        CHECK(styled > 1000);
    });
}

TEST_CASE("shadowOfCasters: what casts elsewhere hides nothing")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, named(), settings());
        PassBench bench = benchOfCasters(frame);
        const auto mattesOf = [&](std::uint32_t others) {
            const std::vector<float> unknown(frame.layout.size, WEDGE_MATTE_UNKNOWN);
            bench.plane("casters", std::vector<std::uint32_t> { others, others, others, others, 1, 1 });
            bench.plane("matte", unknown);
            bench.plane("others", unknown);
            bench.run();
            return std::pair(bench.read<float>("matte"), bench.read<float>("others"));
        };
        const auto [matte, others] = mattesOf(0);
        const auto [alone, none] = mattesOf(WEDGE_CASTS_ELSEWHERE);
        CHECK(alone == matte);
        CHECK(std::ranges::count(others, WEDGE_MATTE_SHADOW) > 10);
        CHECK(std::ranges::count(none, WEDGE_MATTE_SHADOW) == 0);
    });
}

TEST_CASE("timesShare: what two shadows leave of each colour")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = named();
        std::vector<scene::ShadowStyle>& styles = scene.directionalLights.front().styles;
        styles.resize(2, styles.front());
        styles.back().casters = { "board" };
        DeclaredFrame frame(device, scene, settings());
        PassBench bench(frame, "timesShare");
        std::mt19937 random(1);
        const std::vector<float> one = someNumbers(random, 3 * frame.layout.size),
                                 other = someNumbers(random, 3 * frame.layout.size);
        bench.plane("share", one);
        bench.plane("other", other);
        bench.run();
        const Planes<float> found = bench.pixels<float>("share"), a = planesOf(frame.layout, one),
                            b = planesOf(frame.layout, other);
        everyPixel(frame.layout, [&](int x, int y) {
            for (std::size_t c = 0; c < 3; ++c)
                REQUIRE(found.at(x, y, c) == a.at(x, y, c) * b.at(x, y, c));
        });
    });
}
