// shadow_distance.cl, kernel by kernel, against the host in double.
#include "tests/shadow_bench.h"

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

/// The power mean of the distances to the pieces that count, metres.
double distanceTo(const std::vector<Piece>& pieces, glm::dvec3 at, glm::dvec3 n, double largest)
{
    const auto faces = [&](const Piece& piece) { return glm::dot(piece.normal, n) > std::numbers::sqrt2 / 2; };
    double nearest = 2 * largest;
    for (const Piece& piece : pieces)
        nearest = faces(piece) ? std::min(nearest, glm::length(piece.middle - at)) : nearest;
    if (nearest == 2 * largest)
        return largest;
    double sum = 0;
    for (const Piece& piece : pieces) {
        const double r = glm::length(piece.middle - at);
        sum += faces(piece) && r <= 3 * std::min(nearest, largest) ? piece.length * std::pow(r, -8) : 0;
    }
    const double constant = std::sqrt(std::numbers::pi) * std::tgamma(3.5) / std::tgamma(4.0);
    return std::min(std::pow(sum / constant, -1.0 / 7), largest);
}

/// Signed distances that stand for those of a shadow: 0 where the matte is unknown.
std::vector<float> someDistances(const Seen& s)
{
    std::vector<float> out(s.matte.values.size(), 0.0f);
    everyPixel(s.matte.layout, [&](int x, int y) {
        const float v = s.matte.at(x, y);
        const auto wave = static_cast<float>(0.2 + 0.15 * std::sin(0.2 * x) * std::cos(0.3 * y));
        out[s.matte.index(x, y)] = v < 0 ? 0.0f : v > 0.5f ? wave : -wave;
    });
    return out;
}

/// Whole pixels that three deviations span along both axes.
glm::ivec2 pixelsAlong(const Seen& s, const shared::FrameParams& frame, glm::ivec2 at, double alpha)
{
    const glm::dvec3 n = s.normal.vector(at.x, at.y), forward = toGlm(frame.forward);
    const double depth = glm::dot(s.position.vector(at.x, at.y) - toGlm(frame.eye), forward), reach = 3 * alpha;
    const double away = glm::dot(n, forward);
    const double least = std::max(depth - reach * std::sqrt(1 - away * away), 0.2 * depth);
    glm::ivec2 out;
    for (const int axis : { 0, 1 }) {
        const glm::dvec3 step = toGlm(axis == 0 ? frame.right : frame.down);
        const double along = glm::dot(n, glm::normalize(step));
        const double side = std::min(1.25 * std::sqrt(std::max(1 - along * along, 0.0)), 1.0);
        out[axis] = static_cast<int>(std::min(reach * side / (glm::length(step) * least), double { width }));
    }
    return out;
}

/// What the blur makes of a pixel.
double blurred(const Seen& s, const Planes<float>& before, glm::ivec2 at, glm::ivec2 span, double alpha)
{
    const glm::dvec3 here = s.position.vector(at.x, at.y), n = s.normal.vector(at.x, at.y);
    glm::ivec2 stride(1);
    for (const int axis : { 0, 1 })
        while (span[axis] > stride[axis] * WEDGE_STYLE_TAPS)
            stride[axis] *= 2;
    const glm::ivec2 taps = span / stride;
    double sum = 0, weights = 0;
    for (int v = -taps.y; v <= taps.y; ++v)
        for (int u = -taps.x; u <= taps.x; ++u) {
            const int x = at.x + u * stride.x, y = at.y + v * stride.y;
            if (x < 0 || y < 0 || x >= width || y >= height || s.object.at(x, y) != s.object.at(at.x, at.y)
                || before.at(x, y) == 0 || glm::dot(n, s.normal.vector(x, y)) <= std::numbers::sqrt2 / 2)
                continue;
            const double r = glm::length(s.position.vector(x, y) - here), side = s.size.at(x, y);
            const double w = r <= 3 * alpha ? side * side * std::exp(-0.5 * r * r / (alpha * alpha)) : 0;
            sum += w * before.at(x, y);
            weights += w;
        }
    return sum / weights;
}

} // namespace

TEST_CASE("shadowDistance: the power mean of distances to edges that count, within 1e-4 of sums in double")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        const Seen s(traced);
        std::vector<Piece> pieces = joinedPieces(piecesOfTiles(s));
        std::mt19937 random(1);
        for (std::size_t i = 0; i < pieces.size(); i += 5)
            pieces[i].normal = unitVector(random); // most of which no surface faces as
        PassBench bound(traced.frame, "boundEdges"), bench(traced.frame, "shadowDistance");
        const std::vector<float> edges = listOf(pieces, bench.elements("edges"));
        const std::vector<std::uint32_t> listed { static_cast<std::uint32_t>(pieces.size()), 0 };
        bound.plane("edges", edges);
        bound.plane("listed", listed);
        bound.run();
        traced.give(bench);
        bench.plane("edges", edges);
        bench.plane("listed", listed);
        bench.plane("boxes", bound.read<float>("boxes"));
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
