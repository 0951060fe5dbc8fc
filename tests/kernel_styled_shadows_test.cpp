// styled_shadows.cl, kernel by kernel, against the host in double.
#include "bvh/host_traverse.h"
#include "kernels/shared/styled_shadows.h"
#include "tests/pass_bench.h"

#include <cmath>
#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 93, height = 71;
constexpr float inflation = 0.05f, softness = 0.1f, abstraction = 0.06f;
const glm::dvec3 sunward(-0.36, 0.8, -0.48), irradiance(1, 2, 3);

/// The small scene, glossy, under one sun whose shadows have a style.
scene::Scene underSun(float alpha = abstraction)
{
    scene::Scene scene = smallScene();
    scene.areaLights.clear();
    scene.materials[0].specular = { 0.1f, 0.2f, 0.3f };
    scene.materials[0].exponent = 12;
    scene::ShadowStyle style;
    style.inflation = inflation;
    style.softness = softness;
    style.abstraction = alpha;
    style.brightness = { 0.1f, 0.2f, 0.3f };
    scene.directionalLights.push_back({ -glm::vec3(sunward), glm::vec3(irradiance), "sun", { style } });
    return scene;
}

/// The frame's passes up to the edges of its shadow, run one after the other.
struct Traced {
    explicit Traced(const device::Device& device, float alpha = abstraction)
        : frame(device, underSun(alpha), sized(render::monteCarlo(1), width, height))
        , primary(frame, "primary")
        , matte(frame, "shadowMatte")
    {
        primary.run();
        for (const char* name : { "position", "normal", "origin" })
            matte.plane(name, primary.read<float>(name));
        for (const char* name : { "geometric", "objectId", "gloss" })
            matte.plane(name, primary.read<std::uint32_t>(name));
        matte.plane("matte", std::vector<float>(frame.layout.size, WEDGE_MATTE_UNKNOWN));
        matte.run();
    }
    /// What a pass reads of surfaces, and of the light if it reads that.
    void give(PassBench& pass) const
    {
        for (const char* name : { "position", "normal", "pixelSize" })
            if (pass.has(name))
                pass.plane(name, primary.read<float>(name));
        if (pass.has("objectId"))
            pass.plane("objectId", primary.read<std::uint32_t>("objectId"));
        if (pass.has("matte"))
            pass.plane("matte", matte.read<float>("matte"));
    }

    DeclaredFrame frame;
    PassBench primary, matte;
};

/// What of a scene the tests look at: planes of pixels.
struct Seen {
    explicit Seen(const Traced& traced)
        : position(traced.primary.pixels<float>("position"))
        , normal(traced.primary.pixels<float>("normal"))
        , size(traced.primary.pixels<float>("pixelSize"))
        , matte(traced.matte.pixels<float>("matte"))
        , object(traced.primary.pixels<std::uint32_t>("objectId"))
    {
    }
    Planes<float> position, normal, size, matte;
    Planes<std::uint32_t> object;
};

struct Piece {
    glm::dvec3 middle, normal;
    double length;
};

bool onOneSurface(const Seen& s, glm::ivec2 a, glm::ivec2 b)
{
    const glm::dvec3 n = s.normal.vector(a.x, a.y), m = s.normal.vector(b.x, b.y);
    const glm::dvec3 d = s.position.vector(b.x, b.y) - s.position.vector(a.x, a.y);
    const double off = std::max(s.size.at(a.x, a.y), s.size.at(b.x, b.y));
    return s.object.at(a.x, a.y) == s.object.at(b.x, b.y) && glm::dot(n, m) > std::numbers::sqrt2 / 2
        && std::abs(glm::dot(n, d)) <= off && std::abs(glm::dot(m, d)) <= off;
}

/// Of the cell whose first corner is that pixel, by the table of marching squares.
std::vector<Piece> piecesOf(const Seen& s, int x, int y)
{
    const glm::ivec2 corners[] = { { x, y }, { x + 1, y }, { x + 1, y + 1 }, { x, y + 1 } };
    int code = 0;
    glm::dvec3 sum(0);
    for (int k = 0; k < 4; ++k) {
        const glm::ivec2 at = corners[k], next = corners[(k + 1) % 4];
        const float v = s.matte.at(at.x, at.y);
        if (v < 0 || !onOneSurface(s, at, next))
            return {};
        code |= v > 0.5f ? 1 << k : 0;
        sum += s.normal.vector(at.x, at.y);
    }
    // Bits: lit corners. Sides that pieces join, -1: none.
    const int table[16][4] = { { -1, -1, -1, -1 }, { 3, 0, -1, -1 }, { 0, 1, -1, -1 }, { 3, 1, -1, -1 },
        { 1, 2, -1, -1 }, { 3, 0, 1, 2 }, { 0, 2, -1, -1 }, { 3, 2, -1, -1 }, { 2, 3, -1, -1 }, { 2, 0, -1, -1 },
        { 0, 1, 2, 3 }, { 1, 2, -1, -1 }, { 1, 3, -1, -1 }, { 0, 1, -1, -1 }, { 0, 3, -1, -1 }, { -1, -1, -1, -1 } };
    const auto middle = [&](int side) {
        const glm::ivec2 a = corners[side], b = corners[(side + 1) % 4];
        return 0.5 * (s.position.vector(a.x, a.y) + s.position.vector(b.x, b.y));
    };
    std::vector<Piece> out;
    for (int k = 0; k < 4 && table[code][k] >= 0; k += 2) {
        const glm::dvec3 a = middle(table[code][k]), b = middle(table[code][k + 1]);
        out.push_back({ 0.5 * (a + b), glm::normalize(sum), glm::length(b - a) });
    }
    return out;
}

/// All, tile by tile.
std::vector<std::vector<Piece>> piecesOfTiles(const Seen& s)
{
    constexpr int side = WEDGE_EDGE_TILE;
    std::vector<std::vector<Piece>> out;
    for (int y0 = 0; y0 < height - 1; y0 += side)
        for (int x0 = 0; x0 < width - 1; x0 += side) {
            out.emplace_back();
            for (int y = y0; y < std::min(y0 + side, height - 1); ++y)
                for (int x = x0; x < std::min(x0 + side, width - 1); ++x)
                    for (const Piece& piece : piecesOf(s, x, y))
                        out.back().push_back(piece);
        }
    return out;
}

/// As the device has them.
std::vector<float> listOf(const std::vector<Piece>& pieces, std::size_t room)
{
    std::vector<float> out;
    out.reserve(room);
    for (const Piece& p : pieces)
        for (const double v : { p.middle.x, p.middle.y, p.middle.z, p.normal.x, p.normal.y, p.normal.z, p.length, 0.0 })
            out.push_back(static_cast<float>(v));
    out.resize(room);
    return out;
}

std::vector<Piece> joinedPieces(const std::vector<std::vector<Piece>>& tiles)
{
    std::vector<Piece> out;
    for (const std::vector<Piece>& tile : tiles)
        out.insert(out.end(), tile.begin(), tile.end());
    return out;
}

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

TEST_CASE("shadowMatte: what the light reaches, what it does not, and what faces away")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        const Seen s(traced);
        const auto origin = traced.matte.pixels<float>("origin");
        const auto rays = traced.matte.pixels<std::uint32_t>("rays");
        const scene::Geometry& g = traced.frame.scene().geometry;
        const bvh::Bvh hierarchy = bvh::build({ g.positions, g.indices });
        unsigned kinds[3] = {}, differ = 0;
        everyPixel(traced.frame.layout, [&](int x, int y) {
            const float v = s.matte.at(x, y);
            const double cosine = glm::dot(s.normal.vector(x, y), sunward);
            if (s.object.at(x, y) == 0 || cosine <= 0) {
                REQUIRE(v == WEDGE_MATTE_UNKNOWN);
                REQUIRE(rays.at(x, y) == 0);
                ++kinds[2];
                return;
            }
            REQUIRE(rays.at(x, y) == 1);
            const bool hidden = bvh::anyHit(hierarchy, { toVec3(origin.vector(x, y)), 0, toVec3(100.0 * sunward), 1 });
            REQUIRE((v == WEDGE_MATTE_LIT || v == WEDGE_MATTE_SHADOW));
            differ += (v == WEDGE_MATTE_SHADOW) == hidden ? 0 : 1;
            ++kinds[hidden ? 0 : 1];
        });
        for (const unsigned kind : kinds)
            CHECK(kind > 300);
        CHECK(differ <= 3); // rays through edges
    });
}

TEST_CASE("countEdges and listEdges: marching squares on surfaces, tile by tile")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        Seen s(traced);
        // Noise, for all cases of the table, and objects that end in the midst of surfaces.
        std::mt19937 random(1);
        everyPixel(traced.frame.layout, [&](int x, int y) {
            float& v = s.matte.at(x, y);
            v = v >= 0 && y < 30 ? static_cast<float>(random() % 2) : v;
            s.object.at(x, y) += s.object.at(x, y) != 0 && x > 50 ? 100 : 0;
        });
        const std::vector<std::vector<Piece>> expected = piecesOfTiles(s);
        PassBench count(traced.frame, "countEdges"), list(traced.frame, "listEdges"), small(traced.frame, "listEdges");
        for (PassBench* bench : { &count, &list, &small }) {
            traced.give(*bench);
            bench->plane("matte", s.matte);
            bench->plane("objectId", s.object);
        }
        count.run();
        const std::vector<std::uint32_t> counts = count.read<std::uint32_t>("counts");
        REQUIRE(counts.size() == expected.size());
        std::vector<std::uint32_t> first;
        first.reserve(counts.size());
        std::uint32_t sum = 0;
        for (std::size_t tile = 0; tile < counts.size(); ++tile) {
            CHECK(counts[tile] == expected[tile].size());
            first.push_back(sum);
            sum += counts[tile];
        }
        CHECK(sum > 200);
        list.plane("first", first);
        list.run();
        const std::vector<float> edges = list.read<float>("edges");
        const std::vector<float> all = listOf(joinedPieces(expected), edges.size());
        double worst = 0;
        for (std::size_t i = 0; i < all.size(); ++i)
            worst = std::max(worst, std::abs(double { edges[i] } - all[i]));
        CHECK(worst < 1e-5);
        // Where there is no room nothing is written.
        small.plane("first", first);
        small.value("capacity", std::uint32_t { 100 });
        small.run();
        const std::vector<float> part = small.read<float>("edges");
        constexpr std::size_t end = 100 * WEDGE_EDGE_FLOATS;
        CHECK(std::equal(part.begin(), part.begin() + end, edges.begin()));
        CHECK(std::all_of(part.begin() + end, part.end(), [](float v) { return v == 0; }));
    });
}

TEST_CASE("boundEdges: boxes around 32 pieces each")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        PassBench bench(traced.frame, "boundEdges");
        std::mt19937 random(1);
        constexpr std::uint32_t count = 5 * WEDGE_EDGE_CHUNK + 7;
        std::vector<float> edges = someNumbers(random, bench.elements("edges"));
        bench.plane("edges", edges);
        bench.plane("listed", std::vector<std::uint32_t> { count, 0 });
        bench.run();
        const std::vector<float> boxes = bench.read<float>("boxes");
        const std::size_t room = boxes.size() / WEDGE_EDGE_BOX;
        for (std::size_t chunk = 0; chunk < 6; ++chunk)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                float lo = 2, hi = -2;
                for (std::size_t k = chunk * WEDGE_EDGE_CHUNK;
                     k < std::min<std::size_t>((chunk + 1) * WEDGE_EDGE_CHUNK, count); ++k) {
                    lo = std::min(lo, edges[WEDGE_EDGE_FLOATS * k + axis]);
                    hi = std::max(hi, edges[WEDGE_EDGE_FLOATS * k + axis]);
                }
                CHECK(boxes[axis * room + chunk] == lo);
                CHECK(boxes[(3 + axis) * room + chunk] == hi);
            }
        CHECK(std::ranges::count_if(boxes, [](float v) { return v != 0; }) == 6 * WEDGE_EDGE_BOX);
    });
}

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

TEST_CASE("countAreas and keepArea: the distance below which as much lies as was in shadow")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        const Seen s(traced);
        PassBench count(traced.frame, "countAreas"), keep(traced.frame, "keepArea");
        traced.give(count);
        std::mt19937 random(1);
        const Planes<float> distance =
            planesOf(traced.frame.layout, someNumbers(random, traced.frame.layout.size, -0.1, 0.17));
        count.plane("distance", distance);
        count.run();
        keep.plane("areas", count.read<float>("areas"));
        keep.run();
        const double zero = keep.read<float>("zeros").at(0), range = count.own<float>("range");
        CHECK(range == doctest::Approx(3 * abstraction));
        double shadow = 0, below = 0, all = 0;
        everyPixel(traced.frame.layout, [&](int x, int y) {
            const double area = std::pow(double { s.size.at(x, y) }, 2), v = s.matte.at(x, y);
            all += v >= 0 ? area : 0;
            shadow += v == 0 ? area : 0;
            below += v >= 0 && distance.at(x, y) <= zero ? area : 0;
        });
        CHECK(shadow > 0.05 * all);
        CHECK(std::abs(zero) < range);
        CHECK(below == doctest::Approx(shadow).epsilon(0.01)); // a class has a few pixels
        // All in shadow, or nothing: the edge stays.
        for (const float v : { WEDGE_MATTE_LIT, WEDGE_MATTE_SHADOW }) {
            count.plane("matte", std::vector<float>(traced.frame.layout.size, v));
            count.run();
            keep.plane("areas", count.read<float>("areas"));
            keep.run();
            CHECK(keep.read<float>("zeros").at(0) == 0);
        }
    });
}

TEST_CASE("addStyle: from what is left in shadow to all, softly or at once")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        std::mt19937 random(1);
        const std::size_t size = traced.frame.layout.size;
        const Planes<float> distance = planesOf(traced.frame.layout, someNumbers(random, size, -0.2, 0.3));
        const Planes<float> share = planesOf(traced.frame.layout, someNumbers(random, 3 * size));
        for (const float width : { 0.1f, 0.0f }) {
            CAPTURE(width);
            PassBench bench(traced.frame, "addStyle");
            bench.plane("distance", distance);
            bench.plane("share", share);
            bench.plane("zeros", std::vector<float> { 0.02f });
            bench.value("softness", width);
            bench.value("weight", 0.25f);
            bench.run();
            const auto after = bench.pixels<float>("share");
            const glm::dvec3 left(0.1f, 0.2f, 0.3f);
            double worst = 0;
            everyPixel(traced.frame.layout, [&](int x, int y) {
                const double d = double { distance.at(x, y) } - double { 0.02f } - double { inflation };
                const double t = std::clamp(d / double { width } + 0.5, 0.0, 1.0);
                const double f = width > 0 ? t * t * (3 - 2 * t) : d > 0 ? 1 : 0;
                const glm::dvec3 expected = share.vector(x, y) + 0.25 * (left + (1.0 - left) * f);
                worst = std::max(worst, glm::length(after.vector(x, y) - expected));
            });
            CHECK(worst < 1e-6);
        }
    });
}

TEST_CASE("styledLight: what the light brings where nothing hides it, times the share that is left")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        const Seen s(traced);
        PassBench bench(traced.frame, "styledLight");
        for (const char* name : { "position", "normal", "origin", "diffuse", "specular" })
            bench.plane(name, traced.primary.read<float>(name));
        for (const char* name : { "geometric", "objectId", "gloss" })
            bench.plane(name, traced.primary.read<std::uint32_t>(name));
        std::vector<float> matte = traced.matte.read<float>("matte");
        for (std::size_t i = 0; i < matte.size(); i += 5) // no ray came to these before the frame was stopped
            matte[i] = WEDGE_MATTE_UNKNOWN;
        bench.plane("matte", matte);
        const auto known = bench.pixels<float>("matte");
        std::mt19937 random(1);
        bench.plane("share", someNumbers(random, 3 * traced.frame.layout.size, 0, 1));
        bench.plane("lit", someNumbers(random, 3 * traced.frame.layout.size));
        const auto before = bench.pixels<float>("lit"), share = bench.pixels<float>("share");
        const auto diffuse = bench.pixels<float>("diffuse"), specular = bench.pixels<float>("specular");
        const glm::dvec3 eye = toGlm(bench.own<shared::FrameParams>("frame").eye);
        bench.run();
        const auto after = bench.pixels<float>("lit");
        const double m = 12; // of Blinn and Phong's lobe, docs/materials.md
        const double scale = (m + 2) * (m + 4) / (8 * std::numbers::pi * (std::exp2(-0.5 * m) + m));
        unsigned lit = 0, away = 0;
        everyPixel(traced.frame.layout, [&](int x, int y) {
            const glm::dvec3 added = after.vector(x, y) - before.vector(x, y), n = s.normal.vector(x, y);
            const double cosine = glm::dot(n, sunward);
            if (s.object.at(x, y) == 0 || cosine <= 0 || known.at(x, y) < 0) {
                REQUIRE(added == glm::dvec3(0));
                ++away;
                return;
            }
            const glm::dvec3 view = glm::normalize(eye - s.position.vector(x, y));
            const double lobe = scale * std::pow(std::max(glm::dot(n, glm::normalize(view + sunward)), 0.0), m);
            const glm::dvec3 reflected = diffuse.vector(x, y) / std::numbers::pi + lobe * specular.vector(x, y);
            const glm::dvec3 expected = share.vector(x, y) * irradiance * cosine * reflected;
            REQUIRE(glm::length(added - expected) <= 1e-4 * (1 + glm::length(expected)));
            ++lit;
        });
        CHECK(lit > 1000);
        CHECK(away > 300);
    });
}
