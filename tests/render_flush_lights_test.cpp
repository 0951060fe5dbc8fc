// Lamps exactly in their ceiling, or as near to it as rounding: of a light and a surface in one place the light is
// nearer, however the room is turned, to the camera, in mirrors, to lobes, to paths and to shadow rays.
#include "host/render/cutouts.h"
#include "host/render/flush_lights.h"
#include "tests/glass_support.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 48, height = 36;
constexpr double roomSize = 6;

/// How a room is turned, and moved off the origin.
struct Turn {
    double degrees;
    glm::dvec3 axis, moved;
};
constexpr std::array<Turn, 7> turns { { { 0, { 0, 1, 0 }, { 0, 0, 0 } }, { 31, { 0, 1, 0 }, { 0, -2.5, 0 } },
    { 90, { 1, 0, 0 }, { 1, 2, 3 } }, { 47, { 1, 2, -1 }, { 0, 0, 0 } }, { 123, { -3, 1, 2 }, { -4, 0.3, 7 } },
    { 200, { 0.2, 0.1, 1 }, { 0, 0, 0 } }, { 311, { 1, -1, 1 }, { 0.7, 0.1, -0.2 } } } };

enum class Lamp { Quad, TwoSidedQuad, Panel, Grid };
constexpr std::initializer_list<Lamp> all { Lamp::Quad, Lamp::TwoSidedQuad, Lamp::Panel, Lamp::Grid };

/// A room of six by three by six metres with a lamp `below` its ceiling, a mirror, and a glossy box.
class Room {
public:
    Room(const Turn& turn, Lamp lamp, double below)
        : turn_(glm::rotate(glm::dmat4(1), glm::radians(turn.degrees), glm::normalize(turn.axis)))
        , moved_(turn.moved)
    {
        scene::Material glossy;
        glossy.diffuse = glm::vec3(0.2f);
        glossy.specular = glm::vec3(0.5f);
        glossy.specularModel = scene::SpecularModel::Ggx;
        glossy.roughness = 0.2f;
        const std::uint32_t shining = addMaterial(b, glossy), reflecting = addMaterial(b, mirror(glm::vec3(0.9f)));
        b.newObject();
        quad({ 0, 0, 0 }, { 0, 0, 3 }, { 3, 0, 0 });
        b.newObject();
        quad({ 0, 3, 0 }, { 3, 0, 0 }, { 0, 0, 3 });
        b.newObject();
        quad({ 0, 1.5, -3 }, { 3, 0, 0 }, { 0, 1.5, 0 });
        quad({ 0, 1.5, 3 }, { -3, 0, 0 }, { 0, 1.5, 0 });
        quad({ -3, 1.5, 0 }, { 0, 0, 3 }, { 0, -1.5, 0 });
        quad({ 3, 1.5, 0 }, { 0, 0, 3 }, { 0, 1.5, 0 });
        b.newObject();
        quad({ -1.2, 1.0, -2.5 }, { 0.8, 0, 0 }, { 0, 0.7, 0 }, reflecting);
        b.newObject();
        quad({ 0.9, 0.4, -1.4 }, { 0, 0, 0.9 }, { 0.9, 0.1, 0 }, shining);
        b.newObject();
        const glm::dvec3 centre(0.3, 3 - below, -0.9), u(0.7, 0, 0.1), v(-0.1, 0, 0.5);
        if (lamp == Lamp::Quad || lamp == Lamp::TwoSidedQuad) {
            scene::AreaLight& light = b.light(placed(centre), turned(u), turned(v), scene::LightProfile::Uniform, 9);
            light.visible = true;
            light.twoSided = lamp == Lamp::TwoSidedQuad;
        } else {
            const int n = lamp == Lamp::Panel ? 1 : 4;
            const std::uint32_t glow = addGlow(b, glm::vec3(9));
            for (int i = 0; i < n * n; ++i) {
                const int column = i % n, row = i / n;
                quad(centre + ((2.0 * column + 1) / n - 1) * u + ((2.0 * row + 1) / n - 1) * v, u / (1.0 * n),
                    v / (1.0 * n), glow);
            }
        }
        b.camera(placed({ -0.4, 1.3, 2.7 }), placed({ 0, 1.6, -0.4 }), turned({ 0, 1, 0 }), 70);
    }

    SceneBuilder b;

private:
    glm::vec3 turned(glm::dvec3 v) const { return { turn_ * glm::dvec4(v, 0) }; }
    glm::vec3 placed(glm::dvec3 p) const { return glm::vec3(glm::dvec3(turn_ * glm::dvec4(p, 1)) + moved_); }
    void quad(glm::dvec3 centre, glm::dvec3 u, glm::dvec3 v, std::uint32_t material = 0)
    {
        // Corner by corner, each rounded by itself, as files give them.
        const glm::vec3 c[4] = { placed(centre - u - v), placed(centre + u - v), placed(centre + u + v),
            placed(centre - u + v) };
        b.triangle(c[0], c[1], c[2], material);
        b.triangle(c[0], c[2], c[3], material);
    }

    glm::dmat4 turn_;
    glm::dvec3 moved_;
};

/// The part of all pixels whose luminances differ by more than a thirtieth, and by how much the means do.
struct Difference {
    double pixels = 0, mean = 0;
};

Difference difference(const std::vector<float>& a, const std::vector<float>& b)
{
    REQUIRE(a.size() == b.size());
    REQUIRE(notFinite(a) == 0);
    double sumA = 0, sumB = 0, apart = 0;
    for (std::size_t i = 1; i < a.size(); i += 3) {
        sumA += a[i];
        sumB += b[i];
        apart += std::abs(a[i] - b[i]) > (a[i] + b[i]) / 60.0 ? 1 : 0;
    }
    return { apart / (static_cast<double>(a.size()) / 3), std::abs(sumA / sumB - 1) };
}

std::vector<float> imageOf(
    const Room& room, const device::Device& device, const render::Settings& method, const render::Options& options)
{
    render::Renderer renderer(room.b.scene, device, options);
    return renderPixels(renderer, sized(method, width, height));
}

/// Before its ceiling a quad that emits to both sides lights that, too, and hides it from the camera alone: in the
/// ceiling it is as one that emits to the room.
void check(const render::Settings& method, std::size_t firstTurn, std::size_t step, std::initializer_list<Lamp> lamps,
    double pixels, double mean, const render::Options& options = renderOptions())
{
    onEveryDevice([&](const device::Device& device) {
        for (std::size_t i = firstTurn; i < turns.size(); i += step)
            for (const Lamp lamp : lamps) {
                const Lamp alone = lamp == Lamp::TwoSidedQuad ? Lamp::Quad : lamp;
                const std::vector<float> free = imageOf(Room(turns[i], alone, 1e-3), device, method, options);
                const auto kind = static_cast<int>(lamp);
                for (const double below : { 0.0, -1e-6 * roomSize, 1e-6 * roomSize }) {
                    CAPTURE(turns[i].degrees);
                    CAPTURE(kind);
                    CAPTURE(below);
                    const Difference d =
                        difference(imageOf(Room(turns[i], lamp, below), device, method, options), free);
                    CHECK(d.pixels < pixels);
                    CHECK(d.mean < mean);
                }
            }
    });
}

/// How many covers a look-up at barycentrics tries at most, and whether one of them is there, as in kernels.
struct Found {
    std::uint32_t tried;
    bool covered;
};

Found lookUp(const std::vector<std::uint32_t>& table, std::size_t triangle, float u, float v)
{
    shared::Cutout c {};
    std::memcpy(&c, &table[table[triangle]], sizeof(c));
    const std::uint32_t* grid = &table[c.covers];
    const std::uint32_t side = grid[0];
    const auto cellOf = [&](float at, int axis) {
        const float low = std::bit_cast<float>(grid[1 + axis]), scale = std::bit_cast<float>(grid[3 + axis]);
        return std::min(static_cast<std::uint32_t>(std::max((at - low) * scale, 0.0f)), side - 1);
    };
    const std::uint32_t* before = grid + WEDGE_COVER_HEADER + cellOf(v, 1) * side + cellOf(u, 0);
    const std::uint32_t* covers = grid + WEDGE_COVER_HEADER + std::size_t { side } * side + 1;
    for (std::uint32_t i = before[0]; i < before[1]; ++i) {
        float e[WEDGE_COVER_WORDS];
        std::memcpy(e, covers + std::size_t { WEDGE_COVER_WORDS } * i, sizeof(e));
        if (e[0] * u + e[1] * v + e[2] > 0 && e[3] * u + e[4] * v + e[5] > 0 && e[6] * u + e[7] * v + e[8] > 0)
            return { before[1] - before[0], true };
    }
    return { before[1] - before[0], false };
}

/// A ceiling of two triangles, 6 by 6, and in the middle of it, `across` wide, a grid of n x n quads with gaps as wide
/// as they are.
SceneBuilder dottedCeiling(int n, float above = 0, float across = 6)
{
    SceneBuilder b;
    b.quad({ 0, 3, 0 }, { 3, 0, 0 }, { 0, 0, 3 });
    const std::uint32_t glow = addGlow(b, glm::vec3(1));
    const float cell = across / static_cast<float>(n);
    for (int i = 0; i < n * n; ++i) {
        const auto at = [&](int k) { return (static_cast<float>(k) + 0.5f) * cell - across / 2; };
        const int column = i % n, row = i / n;
        b.quad({ at(column), 3 + above, at(row) }, { 0.25f * cell, 0, 0 }, { 0, 0, 0.25f * cell }, glow);
    }
    return b;
}

} // namespace

TEST_CASE("a lamp in its ceiling is as one before it: plain light with two bounces")
{
    render::Settings method = render::monteCarlo(16);
    method.bounces = 2;
    check(method, 0, 1, { Lamp::Quad, Lamp::Panel }, 0.005, 0.003);
    check(method, 3, 3, { Lamp::TwoSidedQuad, Lamp::Grid }, 0.005, 0.003);
}

TEST_CASE("a lamp in its ceiling is as one before it: filtered light with a bounce")
{
    render::Settings method = render::axisAligned(16);
    method.bounces = 1;
    check(method, 1, 5, all, 0.02, 0.003);
}

TEST_CASE("a lamp in its ceiling is as one before it: rays one by one")
{
    render::Options options = renderOptions();
    options.traversal = render::Traversal::Scalar;
    render::Settings method = render::monteCarlo(16);
    method.bounces = 2;
    check(method, 3, 4, { Lamp::Quad, Lamp::Grid }, 0.005, 0.003, options);
}

TEST_CASE("a quad that emits to one side is behind the surface that it lies in, to who looks at its back")
{
    const auto seen = [](const device::Device& device, float above, bool twoSided) {
        SceneBuilder b;
        b.quad({ 0, 3, 0 }, { 3, 0, 0 }, { 0, 0, 3 });
        scene::AreaLight& light =
            b.light({ 0, 3 + above, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, scene::LightProfile::Gaussian, 9);
        light.cut = 2;
        light.visible = true;
        light.twoSided = twoSided;
        b.light({ 0, 8, 0 }, { 0.5f, 0, 0 }, { 0, 0, 0.5f }, scene::LightProfile::Uniform, 30);
        b.camera({ 0.1f, 6, 0.2f }, { 0, 3, 0 }, { 0, 0, 1 }, 20);
        render::Renderer renderer(b.scene, device, renderOptions());
        return renderPixels(renderer, sized(render::monteCarlo(16), 24, 18));
    };
    onEveryDevice([&](const device::Device& device) {
        for (const bool twoSided : { false, true }) {
            CAPTURE(twoSided);
            const std::vector<float> apart = seen(device, twoSided ? 1e-3f : -1e-3f, twoSided);
            for (const float above : { 0.0f, 4e-6f, -4e-6f }) {
                CAPTURE(above);
                const Difference d = difference(seen(device, above, twoSided), apart);
                CHECK(d.pixels < 0.01);
                CHECK(d.mean < 0.003);
            }
        }
    });
}

TEST_CASE("a lamp in its ceiling is as one before it: antialiased")
{
    render::Settings method = render::axisAligned(16);
    method.bounces = 1;
    method.antialias = true;
    // Other demands are other counts, and so other noise.
    check(method, 2, 5, { Lamp::Quad, Lamp::Panel }, 0.2, 0.003);
}

TEST_CASE("lamps in a ceiling leave it dark, those that share a term, too")
{
    // 25 lamps that emit to both sides: sixteen have a term of their own.
    const auto brightest = [](const device::Device& device, const Turn& turn, double below, render::Settings method) {
        const glm::dmat4 rotation = glm::rotate(glm::dmat4(1), glm::radians(turn.degrees), glm::normalize(turn.axis));
        const auto turned = [&](glm::dvec3 v) { return glm::vec3(rotation * glm::dvec4(v, 0)); };
        const auto placed = [&](glm::dvec3 p) {
            return glm::vec3(glm::dvec3(rotation * glm::dvec4(p, 1)) + turn.moved);
        };
        SceneBuilder b;
        b.quad(placed({ 0.3, 3, 0 }), turned({ 3, 0, 0 }), turned({ 0, 0, 3 }));
        for (int i = 0; i < 25; ++i) {
            const int column = i % 5, row = i / 5;
            b.light(placed({ column - 2, 3 - below, row - 2 }), turned({ 0.3, 0, 0 }), turned({ 0, 0, 0.2 }),
                 scene::LightProfile::Uniform, 9)
                .twoSided = true;
        }
        b.camera(placed({ 0.1, 1, 0.2 }), placed({ 0, 3, 0 }), turned({ 0, 0, 1 }), 70);
        render::Renderer renderer(b.scene, device, renderOptions());
        const std::vector<float> image = renderPixels(renderer, sized(method, width, height));
        REQUIRE(notFinite(image) == 0);
        return *std::ranges::max_element(image);
    };
    onEveryDevice([&](const device::Device& device) {
        render::Settings antialiased = render::axisAligned(16);
        antialiased.antialias = true;
        for (const render::Settings& method : { render::monteCarlo(16), antialiased })
            for (std::size_t i = 0; i < turns.size(); i += 3) {
                CAPTURE(turns[i].degrees);
                CAPTURE(method.antialias);
                // The last are farther off than rays begin.
                for (const double below : { 0.0, -1e-6 * roomSize, 1e-6 * roomSize, 4e-6 * roomSize }) {
                    CAPTURE(below);
                    CHECK(brightest(device, turns[i], below, method) == 0);
                }
                CHECK(brightest(device, turns[i], 1e-2, method) > 0.1f);
            }
    });
}

TEST_CASE("covers are where lamps are, but for a rim")
{
    const float inside = 0.25f - 1e-3f, outside = 0.25f + 1e-3f;
    for (const int n : { 1, 3, 40 })
        for (const float above : { 0.0f, 5e-6f, -5e-6f }) {
            CAPTURE(n);
            CAPTURE(above);
            const std::vector<std::uint32_t> table = render::cutoutTable(dottedCeiling(n, above).scene);
            REQUIRE_FALSE(table.empty());
            std::mt19937 random(5);
            std::uniform_real_distribution<float> unit(0, 1);
            int covered = 0;
            for (int i = 0; i < 20000; ++i) {
                const float a = unit(random), b = unit(random);
                // The triangles are (0, 0), (1, 0), (1, 1) and (0, 0), (1, 1), (0, 1) of the square.
                const bool second = b > a;
                const float u = second ? a : a - b, v = second ? b - a : b;
                const auto off = [&](float x) {
                    const float of = x * static_cast<float>(n);
                    return std::abs(of - std::floor(of) - 0.5f);
                };
                // Nor along the diagonal of a lamp, where its triangles meet.
                const float far = std::max(off(a), off(b)), x = a * static_cast<float>(n),
                            y = b * static_cast<float>(n);
                const bool diagonal = std::abs((x - std::floor(x)) - (y - std::floor(y))) < 1e-3f;
                if ((far > inside && far < outside) || diagonal)
                    continue;
                const Found found = lookUp(table, second ? 1 : 0, u, v);
                covered += found.covered ? 1 : 0;
                REQUIRE(found.covered == (far < 0.25f));
                REQUIRE(found.tried < 64);
            }
            CHECK(covered > 4000);
        }
}

TEST_CASE("look-ups of a small lamp of many triangles try few of them")
{
    const std::vector<std::uint32_t> table = render::cutoutTable(dottedCeiling(60, 0, 0.3f).scene);
    REQUIRE_FALSE(table.empty());
    std::uint32_t most = 0;
    for (int i = 0; i <= 300; ++i)
        for (int j = 0; j <= i; ++j) {
            const float a = 0.47f + 2e-4f * static_cast<float>(i), b = 0.47f + 2e-4f * static_cast<float>(j);
            most = std::max(most, lookUp(table, 0, a - b, b).tried);
        }
    CHECK(most > 0);
    CHECK(most < 64);
}

TEST_CASE("only what lies in one plane is covered, by what emits, is whole and does not move")
{
    const auto covered = [](const SceneBuilder& b) { return !render::coversOf(b.scene).empty(); };
    CHECK(covered(dottedCeiling(2)));
    CHECK_FALSE(covered(dottedCeiling(2, 1e-3f)));
    CHECK_FALSE(covered(dottedCeiling(2, -1e-3f)));
    SceneBuilder b = dottedCeiling(2);
    b.scene.materials[1].opacity = 0.5f;
    CHECK_FALSE(covered(b));
    b = dottedCeiling(2);
    b.scene.materials[1].emission = glm::vec3(0);
    CHECK_FALSE(covered(b));
    b.scene.materials[1].emission = b.scene.materials[0].emission = glm::vec3(1);
    CHECK_FALSE(covered(b));
    b = dottedCeiling(2);
    b.scene.geometry.positionsAtClose = b.scene.geometry.positions;
    CHECK(covered(b));
    for (float& x : b.scene.geometry.positionsAtClose)
        x += 1;
    CHECK_FALSE(covered(b));
    // A ceiling beside the lamp, and one that stands on its edge.
    SceneBuilder beside;
    beside.quad({ 0, 3, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, addGlow(beside, glm::vec3(1)));
    beside.quad({ 2, 3, 0 }, { 1, 0, 0 }, { 0, 0, 1 });
    beside.quad({ 1, 4, 0 }, { 0, 1, 0 }, { 0, 0, 1 });
    CHECK_FALSE(covered(beside));
}

TEST_CASE("quads are lifted off the surfaces that they lie in, and off no others")
{
    const scene::Geometry geometry = dottedCeiling(1).scene.geometry;
    const auto lift = [&](glm::vec3 centre, glm::vec3 u) {
        scene::AreaLight light;
        light.centre = centre;
        light.halfU = u;
        light.halfV = { 0, 0, 0.5f };
        return render::liftsOf(std::span(&light, 1), geometry)[0];
    };
    const glm::vec3 along(0.5f, 0, 0);
    for (const float above : { 0.0f, 6e-6f, -6e-6f }) {
        CHECK(lift({ 1, 3 + above, 1 }, along) > 2 * std::abs(above));
        CHECK(lift({ 1, 3 + above, 1 }, along) < 1e-4f);
    }
    CHECK(lift({ 1, 2.999f, 1 }, along) == 0);
    CHECK(lift({ 4, 3, 1 }, along) == 0);
    CHECK(lift({ 1, 3, 1 }, { 0, 0.5f, 0 }) == 0);
    CHECK(lift({ 1, 3, 1 }, { 0.5f, 0.01f, 0 }) == 0);
    CHECK(lift({ 3.5f, 3, 1 }, along) == 0); // it touches the ceiling's edge
}

TEST_CASE("far from the origin a lamp a centimetre off a floor lies in none")
{
    SceneBuilder b;
    b.quad({ 2000, 0, 2000 }, { 0, 0, 1e4f }, { 1e4f, 0, 0 });
    const auto liftAt = [&](float height) {
        scene::AreaLight light;
        light.centre = { 2000, height, 2000 };
        light.halfU = { 0.5f, 0, 0 };
        light.halfV = { 0, 0, 0.5f };
        return render::liftsOf(std::span(&light, 1), b.scene.geometry)[0];
    };
    CHECK(liftAt(0) > 0);
    CHECK(liftAt(0) < 1e-3f);
    CHECK(liftAt(0.01f) == 0);
    b.newObject();
    b.quad({ 2000, 0.01f, 2000 }, { 0.5f, 0, 0 }, { 0, 0, 0.5f }, addGlow(b, glm::vec3(1)));
    CHECK(render::coversOf(b.scene).empty());
}
