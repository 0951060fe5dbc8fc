// Styles' knobs by how far away what hides the light is, kernel by kernel, against the host in double.
#include "effects/styled_shadows/style_knobs.h"
#include "tests/shadow_bench.h"

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

scene::Scene byOccluder()
{
    scene::Scene scene = underSun();
    scene::ShadowStyle& style = scene.directionalLights.front().styles.front();
    style.inflation = { 0.02f, 0.03f, 0.01f };
    style.softness = { 0.2f, 0.01f, -0.06f };
    style.abstraction = { -0.02f, 0.1f, 0.0f };
    style.brightness = { glm::vec3(0.1f, 0.2f, 0.3f), glm::vec3(0.2f, 0.0f, -0.4f), glm::vec3(0.5f, 0.0f, 0.1f) };
    return scene;
}

double knobAt(const shared::StyleKnob& k, double d)
{
    return std::clamp(
        double { k.base } + d * (double { k.linear } + d * double { k.square }), double { k.least }, double { k.most });
}

/// How far away what hides the light is, around its shadow: of the edges that count, and as far as `largest` and more
/// from all of them the pixel's own.
double awayAt(const std::vector<Piece>& pieces, const Seen& s, glm::ivec2 pixel, double largest, bool published)
{
    const glm::dvec3 at = s.position.vector(pixel.x, pixel.y), n = s.normal.vector(pixel.x, pixel.y);
    const double own = s.occluder.at(pixel.x, pixel.y);
    const auto faces = [&](const Piece& piece) { return glm::dot(piece.normal, n) > std::numbers::sqrt2 / 2; };
    double nearest = 1e30;
    for (const Piece& piece : pieces)
        nearest = faces(piece) ? std::min(nearest, glm::length(piece.middle - at)) : nearest;
    if (!published && nearest >= 2 * largest)
        return own;
    double sum = 0, weights = 0;
    for (const Piece& piece : pieces) {
        const double r = glm::length(piece.middle - at);
        const bool counts = faces(piece) && (published || r <= 3 * std::min(nearest, largest));
        const double w = counts ? piece.length * std::pow(r, -8) : 0;
        sum += w * piece.away;
        weights += w;
    }
    if (weights == 0)
        return own; // no edge faces as it does
    const double t = published || s.matte.at(pixel.x, pixel.y) > 0.5f ? 0 : std::clamp(nearest / largest - 1, 0.0, 1.0);
    return glm::mix(sum / weights, own, t * t * (3 - 2 * t));
}

/// Between the scene's least and largest, for all pixels.
std::vector<float> someDepths(std::size_t count)
{
    std::mt19937 random(7);
    return someNumbers(random, count, 0, 2);
}

} // namespace

TEST_CASE("shadowMatte: metres to what is met first on the way to the light")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device, byOccluder()), plain(device);
        const Seen s(traced);
        CHECK_FALSE(plain.matte.has("occluder"));
        CHECK(plain.matte.read<float>("matte") == traced.matte.read<float>("matte"));
        const auto origin = traced.matte.pixels<float>("origin");
        const scene::Geometry& g = traced.frame.scene().geometry;
        const bvh::Bvh hierarchy = bvh::build({ g.positions, g.indices });
        unsigned hidden = 0, differ = 0;
        everyPixel(traced.frame.layout, [&](int x, int y) {
            const double d = s.occluder.at(x, y);
            if (s.matte.at(x, y) != WEDGE_MATTE_SHADOW) {
                REQUIRE(d == 0);
                return;
            }
            const shared::Hit hit =
                bvh::closestHit(hierarchy, { toVec3(origin.vector(x, y)), 0, toVec3(100.0 * sunward), 1 });
            const double expected = 100 * glm::length(sunward) * double { hit.t };
            differ += std::abs(d - expected) <= 1e-4 * (1 + expected) ? 0 : 1;
            ++hidden;
        });
        CHECK(hidden > 300);
        CHECK(differ <= 3); // rays through edges
        // No more than is told apart.
        traced.matte.value("farthest", 0.5f);
        traced.matte.run();
        const std::vector<float> bounded = traced.matte.read<float>("occluder");
        CHECK(*std::ranges::max_element(bounded) == 0.5f);
    });
}

TEST_CASE("listEdges: pieces have the mean of what hides the light at their corners in shadow")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device, byOccluder());
        Seen s(traced);
        std::mt19937 random(1);
        std::vector<float> depths = someNumbers(random, s.occluder.values.size(), 0, 2);
        everyPixel(traced.frame.layout, [&](int x, int y) {
            float& v = s.matte.at(x, y);
            // Some of it right at the edge, which is in shadow.
            v = v >= 0 && y < 30 ? 0.5f * static_cast<float>(random() % 3) : v;
            s.occluder.at(x, y) = depths[s.occluder.index(x, y)];
        });
        const std::vector<std::vector<Piece>> expected = piecesOfTiles(s);
        PassBench list(traced.frame, "listEdges");
        traced.give(list);
        list.plane("matte", s.matte);
        list.plane("occluder", s.occluder);
        std::vector<std::uint32_t> first;
        first.reserve(expected.size());
        std::uint32_t sum = 0;
        for (const std::vector<Piece>& tile : expected) {
            first.push_back(sum);
            sum += static_cast<std::uint32_t>(tile.size());
        }
        list.plane("first", first);
        list.run();
        const std::vector<float> edges = list.read<float>("edges");
        const std::vector<float> all = listOf(joinedPieces(expected), edges.size(), true);
        double worst = 0;
        for (std::size_t i = 0; i < all.size(); ++i)
            worst = std::max(worst, std::abs(double { edges[i] } - all[i]));
        CHECK(sum > 200);
        CHECK(worst < 1e-5);
    });
}

TEST_CASE("shadowDistance: what hides the light, from shadows' edges on and deep in them")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device, byOccluder());
        const Seen s(traced);
        std::vector<Piece> pieces = joinedPieces(piecesOfTiles(s));
        PassBench bench = distancesTo(traced, pieces, true);
        const float largest = 0.15f;
        bench.value("largest", largest);
        const double farthest = double { bench.own<float>("farthest") };
        for (const bool published : { false, true }) {
            CAPTURE(published);
            bench.value("published", published ? 1u : 0u);
            bench.run();
            const auto away = bench.pixels<float>("away");
            unsigned around = 0, own = 0, between = 0, differ = 0;
            everyPixel(traced.frame.layout, [&](int x, int y) {
                const float v = s.matte.at(x, y);
                if (v < 0) {
                    REQUIRE(away.at(x, y) == 0);
                    return;
                }
                const double expected = awayAt(pieces, s, { x, y }, double { largest }, published);
                differ += std::abs(away.at(x, y) - expected) <= 2e-4 * farthest ? 0 : 1;
                around += v > 0.5f && expected > 0 ? 1 : 0;
                own += expected == double { s.occluder.at(x, y) } && v == 0 ? 1 : 0;
                between += v == 0 && expected != double { s.occluder.at(x, y) } ? 1 : 0;
            });
            CHECK(around > 100);
            CHECK(between > 100);
            CHECK((published || own > 20));
            CHECK(differ == 0);
        }
    });
}

TEST_CASE("smoothDistance: each pixel as wide as what hides the light there is away")
{
    onEveryDevice([](const device::Device& device) {
        const float largest = 0.33f;
        Traced traced(device, byOccluder());
        const Seen s(traced);
        PassBench bench(traced.frame, "smoothDistance");
        traced.give(bench);
        const Planes<float> before = planesOf(traced.frame.layout, someDistances(s));
        const Planes<float> away = planesOf(traced.frame.layout, someDepths(before.values.size()));
        bench.plane("distance", before);
        bench.plane("away", away);
        bench.value("largest", largest);
        bench.run();
        const auto deviation = bench.own<shared::StyleKnob>("deviation");
        const auto smoothed = bench.pixels<float>("smoothed");
        const auto frame = bench.own<shared::FrameParams>("frame");
        unsigned differ = 0, changed = 0, still = 0;
        everyPixel(traced.frame.layout, [&](int x, int y) {
            const float own = before.at(x, y);
            const double alpha = knobAt(deviation, away.at(x, y));
            if (own == 0 || std::abs(own) >= largest || alpha == 0) {
                REQUIRE(smoothed.at(x, y) == own);
                still += own != 0 && std::abs(own) < largest ? 1 : 0;
                return;
            }
            const glm::ivec2 span = pixelsAlong(s, frame, { x, y }, alpha);
            differ += std::abs(smoothed.at(x, y) - blurred(s, before, { x, y }, span, alpha)) <= 5e-4 ? 0 : 1;
            changed += std::abs(smoothed.at(x, y) - own) > 0.01 ? 1 : 0;
        });
        CHECK(changed > 500);
        CHECK(still > 100);
        CHECK(differ <= 16); // strides and reaches by a rounding
    });
}

TEST_CASE("addStyle: edge, width and what is left by what hides the light, within their ranges")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device, byOccluder());
        std::mt19937 random(1);
        const std::size_t size = traced.frame.layout.size;
        const Planes<float> distance = planesOf(traced.frame.layout, someNumbers(random, size, -0.2, 0.3));
        const Planes<float> share = planesOf(traced.frame.layout, someNumbers(random, 3 * size));
        const Planes<float> away = planesOf(traced.frame.layout, someDepths(size));
        PassBench bench(traced.frame, "addStyle");
        bench.plane("distance", distance);
        bench.plane("share", share);
        bench.plane("away", away);
        bench.plane("zeros", std::vector<float> { 0.0f, 0 });
        bench.value("weight", 0.25f);
        bench.run();
        const auto after = bench.pixels<float>("share");
        const auto knob = [&](const char* name) { return bench.own<shared::StyleKnob>(name); };
        double worst = 0;
        unsigned hard = 0, full = 0, none = 0;
        everyPixel(traced.frame.layout, [&](int x, int y) {
            const double away_ = away.at(x, y);
            const double width = knobAt(knob("softness"), away_);
            const double d = double { distance.at(x, y) } - knobAt(knob("inflation"), away_);
            if (std::abs(d) < 1e-6 || (width > 0 && width < 1e-3))
                return; // by a rounding
            const double t = std::clamp(d / std::max(width, 1e-30) + 0.5, 0.0, 1.0);
            const double f = width > 0 ? t * t * (3 - 2 * t) : d > 0 ? 1 : 0;
            const glm::dvec3 left(
                knobAt(knob("red"), away_), knobAt(knob("green"), away_), knobAt(knob("blue"), away_));
            const glm::dvec3 expected = share.vector(x, y) + 0.25 * (left + (1.0 - left) * f);
            worst = std::max(worst, glm::length(after.vector(x, y) - expected));
            hard += width == 0 ? 1 : 0;
            full += left.x == 1 ? 1 : 0;
            none += left.z == 0 ? 1 : 0;
        });
        CHECK(worst < 1e-4);
        CHECK(hard > 100);
        CHECK(full > 100);
        CHECK(none > 100);
    });
}

TEST_CASE("what distances styles tell apart, and how far away things are that hide a light")
{
    scene::Scene scene = byOccluder();
    const std::vector<scene::ShadowStyle>& styles = scene.directionalLights.front().styles;
    // At 2 m: 0.02 + 0.06 + 0.04, and 0.18 of abstraction; softness has most at its turn.
    const double soft = 0.2 + 0.01 * 0.01 / (4 * 0.06);
    CHECK(render::mostDistance(styles, 2) == doctest::Approx(2 * (0.12 + 0.5 * soft + 3 * 0.18)).epsilon(1e-5));
    CHECK(render::mostOf({ -1, 2, -1, -3, 3 }, 1.5f) == 1);
    CHECK(render::mostOf({ 0, 0, -1, -3, 3 }, 10) == 3);
    const scene::Bounds bounds = scene::sceneBounds(scene);
    const glm::dvec3 extent = glm::dvec3(bounds.hi) - glm::dvec3(bounds.lo);
    double way = 1e30;
    for (int axis = 0; axis < 3; ++axis)
        way = std::min(way, extent[axis] / std::abs(sunward[axis]));
    CHECK(render::farthestOccluder(scene, 0) == doctest::Approx(way).epsilon(1e-5));
    // A key tells it of all moments.
    scene::ShadowStyle changing;
    changing.keys = { {}, styles.front() };
    CHECK(render::variesByOccluder(changing));
    changing.keys.pop_back();
    CHECK_FALSE(render::variesByOccluder(changing));
    scene.pointLights.push_back({ bounds.lo + glm::vec3(0.25f) * (bounds.hi - bounds.lo), glm::vec3(1), "", {} });
    CHECK(render::farthestOccluder(scene, 0) == doctest::Approx(0.75 * glm::length(extent)).epsilon(1e-5));
}
