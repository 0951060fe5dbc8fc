// shadow_distance.cl, kernel by kernel, against the host in double.
#include "tests/shadow_bench.h"

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

TEST_CASE("shadowDistance: the power mean of distances to edges that count, within 1e-4 of sums in double")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        const Seen s(traced);
        std::vector<Piece> pieces = joinedPieces(piecesOfTiles(s));
        std::mt19937 random(1);
        for (std::size_t i = 0; i < pieces.size(); i += 5)
            pieces[i].normal = unitVector(random); // most of which no surface faces as
        PassBench bench = distancesTo(traced, pieces);
        bench.run();
        const double largest = double { bench.own<float>("largest") };
        CHECK(largest == doctest::Approx(2 * (inflation + 0.5 * softness + 3 * abstraction)));
        const auto distance = bench.pixels<float>("distance");
        unsigned near = 0, far = 0, differ = 0;
        everyPixel(traced.frame.layout, [&](int x, int y) {
            const float v = s.matte.at(x, y);
            if (v < 0) {
                REQUIRE(distance.at(x, y) == 0);
                return;
            }
            const double d = distanceTo(pieces, s.position.vector(x, y), s.normal.vector(x, y), largest);
            const double expected = v > 0.5f ? d : -d;
            differ += std::abs(distance.at(x, y) - expected) <= 1e-4 * largest ? 0 : 1;
            near += d < 0.1 * largest ? 1 : 0;
            far += d == largest ? 1 : 0;
        });
        CHECK(near > 100);
        CHECK(far > 100);
        CHECK(differ == 0);
    });
}

TEST_CASE("shadowDistance: where means are of near edges alone they go over into the nearest distance")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        const Seen s(traced);
        const std::vector<Piece> pieces = joinedPieces(piecesOfTiles(s));
        PassBench bench = distancesTo(traced, pieces);
        const float largest = 0.7f, within = 0.08f;
        bench.value("largest", largest);
        bench.value("meanWithin", within);
        bench.run();
        const auto distance = bench.pixels<float>("distance");
        unsigned kinds[3] = {};
        double worst = 0, apart = 0;
        everyPixel(traced.frame.layout, [&](int x, int y) {
            const glm::dvec3 at = s.position.vector(x, y), n = s.normal.vector(x, y);
            double nearest = 2 * double { largest };
            for (const Piece& piece : pieces)
                if (glm::dot(piece.normal, n) > std::numbers::sqrt2 / 2)
                    nearest = std::min(nearest, glm::length(piece.middle - at));
            if (s.matte.at(x, y) < 0)
                return;
            const double mean = distanceTo(pieces, at, n, double { largest }),
                         t = std::clamp(nearest / double { within } - 1, 0.0, 1.0);
            const double expected = mean + (std::min(nearest, double { largest }) - mean) * t;
            worst = std::max(worst, std::abs(std::abs(double { distance.at(x, y) }) - expected));
            apart = std::max(apart, std::abs(mean - expected));
            ++kinds[t <= 0 ? 0 : t < 1 ? 1 : 2];
        });
        CHECK(*std::ranges::min_element(kinds) > 100);
        CHECK(worst < 1e-4 * double { largest });
        CHECK(apart > 0.01);
    });
}

TEST_CASE("shadowDistance: a pixel is as near to an edge where styles tell kilometres apart")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        const Seen s(traced);
        const std::vector<Piece> pieces = joinedPieces(piecesOfTiles(s));
        PassBench bench = distancesTo(traced, pieces);
        for (const float largest : { 3e4f, 9e12f })
            for (const bool published : { false, true }) {
                CAPTURE(largest);
                CAPTURE(published);
                bench.value("largest", largest);
                bench.value("meanWithin", 2 * largest);
                bench.value("published", published ? 1u : 0u);
                bench.run();
                const auto distance = bench.pixels<float>("distance");
                unsigned near = 0, differ = 0;
                everyPixel(traced.frame.layout, [&](int x, int y) {
                    if (s.matte.at(x, y) < 0 || (published && s.normal.vector(x, y).y < 0.999))
                        return;
                    const glm::dvec3 at = s.position.vector(x, y), n = s.normal.vector(x, y);
                    double expected = published ? 0 : distanceTo(pieces, at, n, double { largest });
                    if (published) {
                        double sum = 0, all = 0;
                        for (const Piece& piece : pieces) {
                            const bool faces = glm::dot(piece.normal, n) > std::numbers::sqrt2 / 2;
                            sum += faces ? piece.length * std::pow(glm::length(piece.middle - at), -8) : 0;
                            all += faces ? piece.length : 0;
                        }
                        expected = std::pow(sum / all, -1.0 / 8);
                    }
                    if (expected > 100)
                        return; // no edge faces as it does
                    differ += std::abs(std::abs(distance.at(x, y)) - expected) <= 1e-3 * expected ? 0 : 1;
                    ++near;
                });
                CHECK(near > 1000);
                CHECK(differ == 0);
            }
    });
}

TEST_CASE("smoothDistance: a Gaussian along surfaces, by every pixel or every so manieth")
{
    onEveryDevice([](const device::Device& device) {
        for (const double alpha : { 0.06, 0.4 }) {
            CAPTURE(alpha);
            const double tolerance = alpha < 0.1 ? 1e-4 : 5e-4; // of few taps one more or less at the reach's end
            const float largest = 0.33f;
            Traced traced(device, static_cast<float>(alpha));
            const Seen s(traced);
            PassBench bench(traced.frame, "smoothDistance");
            traced.give(bench);
            const Planes<float> before = planesOf(traced.frame.layout, someDistances(s));
            bench.plane("distance", before);
            bench.value("largest", largest);
            bench.run();
            const auto smoothed = bench.pixels<float>("smoothed");
            const auto frame = bench.own<shared::FrameParams>("frame");
            unsigned differ = 0, changed = 0, wide = 0, kept = 0;
            everyPixel(traced.frame.layout, [&](int x, int y) {
                const float own = before.at(x, y);
                if (own == 0 || std::abs(own) >= largest) {
                    REQUIRE(smoothed.at(x, y) == own);
                    kept += own != 0 ? 1 : 0;
                    return;
                }
                const glm::ivec2 span = pixelsAlong(s, frame, { x, y }, alpha);
                wide += std::max(span.x, span.y) > WEDGE_STYLE_TAPS ? 1 : 0;
                differ += std::abs(smoothed.at(x, y) - blurred(s, before, { x, y }, span, alpha)) <= tolerance ? 0 : 1;
                changed += std::abs(smoothed.at(x, y) - own) > 0.01 ? 1 : 0;
            });
            CHECK(changed > 500);
            CHECK(kept > 100);
            CHECK((alpha < 0.1 || wide > 1000));
            CHECK(differ <= 8); // strides and reaches by a rounding
        }
    });
}
