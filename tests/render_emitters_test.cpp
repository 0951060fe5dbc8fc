// Meshes that emit: how they are chosen, and their light against that of quads, of points against directions, and of
// filtered frames against plain ones.
#include "host/render/emitters.h"
#include "tests/lamp_room.h"

#include <functional>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 24, height = 18;

/// With a wall.
SceneBuilder room()
{
    SceneBuilder b = lampRoom();
    b.quad({ 0, 1, -1.5f }, { 2, 0, 0 }, { 0, 1, 0 });
    b.newObject();
    return b;
}

SceneBuilder roomWithMeshLamp()
{
    SceneBuilder b = room();
    b.quad(lampCentre, lampU, lampV, addGlow(b, { 8, 7, 5 }));
    return b;
}

render::Settings settingsOf(const render::Settings& method, int bounces)
{
    render::Settings settings = sized(method, width, height);
    settings.bounces = bounces;
    return settings;
}

render::Settings found(render::LightSampling ways, int spp, int bounces)
{
    render::Settings settings = settingsOf(render::monteCarlo(spp), bounces);
    settings.lightSampling = ways;
    return settings;
}

/// Points, directions and both give the same mean.
void checkWays(const SceneBuilder& b, const device::Device& device, int bounces)
{
    const Moments points = lightOf(b, device, found(render::LightSampling::Lights, 256, bounces));
    CHECK(points.average() > 1e-3);
    checkAgreement(lightOf(b, device, found(render::LightSampling::Both, 256, bounces)), points, 1e-3);
    checkAgreement(lightOf(b, device, found(render::LightSampling::Directions, 1024, bounces)), points, 1e-3);
}

} // namespace

TEST_CASE("emitters are chosen by their power, two triangles of a quad together")
{
    SceneBuilder b = room();
    CHECK(render::emitterList(b.scene).list.empty());
    const std::size_t before = b.scene.geometry.materialIds.size();
    b.quad({ 0, 2, 0 }, { 0.5f, 0, 0 }, { 0, 0, 0.5f }, addGlow(b, glm::vec3(2))); // power 2
    b.newObject();
    b.triangle({ 1, 2, 0 }, { 2, 2, 0 }, { 1, 2, 4 }, addGlow(b, glm::vec3(3))); // 6
    const render::EmitterList found = render::emitterList(b.scene);
    REQUIRE(found.list.size() == 2);
    CHECK(found.power == doctest::Approx(16));
    CHECK(found.list[0].triangle == before);
    CHECK(found.list[0].pair == WEDGE_PAIR_FIRST);
    CHECK(found.list[0].upTo == doctest::Approx(0.25));
    CHECK(found.list[1].triangle == before + 2);
    CHECK(found.list[1].pair == WEDGE_PAIR_NONE);
    CHECK(found.list[1].upTo == 1.0f);
    // The root of the mean square: of a square of side a, a / sqrt 6; of a triangle, of the sides' squares, / 6.
    CHECK(found.list[0].extent == doctest::Approx(1 / std::sqrt(6.0)));
    CHECK(found.list[1].extent == doctest::Approx(std::sqrt((1 + 16 + 17) / 36.0)));
    REQUIRE(found.picks.size() == before + 3);
    for (std::size_t t = 0; t < found.picks.size(); ++t)
        CHECK(found.picks[t] == doctest::Approx(t < before ? 0 : t < before + 2 ? 0.125 : 0.75));
}

TEST_CASE("numbers of a pair fill both of its triangles evenly, whichever diagonal parts them")
{
    for (const std::uint32_t pair : { WEDGE_PAIR_FIRST, WEDGE_PAIR_SECOND }) {
        // The corners a, b, c, d of the unit square.
        const glm::dvec2 corners[4] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
        const int first[2][3] = { { 0, 1, 2 }, { 0, 2, 3 } }, second[2][3] = { { 0, 1, 3 }, { 1, 2, 3 } };
        for (int i = 0; i < 32; ++i)
            for (int k = 0; k < 32; ++k) {
                const float u = (static_cast<float>(i) + 0.3f) / 32, v = (static_cast<float>(k) + 0.6f) / 32;
                std::uint32_t which = 7;
                const shared::Vec2 w = shared::squareToPair(pair, shared::vec2(u, v), &which);
                REQUIRE(which <= 1);
                REQUIRE(w.x >= 0);
                REQUIRE(w.y >= 0);
                REQUIRE(w.x + w.y <= 1.000001f);
                const int* of = pair == WEDGE_PAIR_FIRST ? first[which] : second[which];
                const glm::dvec2 at = (1.0 - w.x - w.y) * corners[of[0]] + double { w.x } * corners[of[1]]
                    + double { w.y } * corners[of[2]];
                REQUIRE(at.x == doctest::Approx(u).epsilon(1e-5));
                REQUIRE(at.y == doctest::Approx(v).epsilon(1e-5));
            }
    }
}

TEST_CASE("a mesh lamp brings the light of a quad of its size and power, and hardly more noise")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder quad = room();
        scene::AreaLight& light = quad.light(lampCentre, lampU, lampV, scene::LightProfile::Uniform, 1);
        light.radiance = { 8, 7, 5 };
        light.twoSided = true;
        light.visible = true;
        const SceneBuilder mesh = roomWithMeshLamp();
        for (const int bounces : { 0, 1 }) {
            CAPTURE(bounces);
            const render::Settings plain = settingsOf(render::monteCarlo(256), bounces);
            checkAgreement(lightOf(mesh, device, plain), lightOf(quad, device, plain), 1e-3);
        }
        const render::Settings few = settingsOf(render::monteCarlo(16), 0);
        const double ofMesh = rmsNoise(lightOf(mesh, device, few)), ofQuad = rmsNoise(lightOf(quad, device, few));
        CAPTURE(ofMesh);
        CAPTURE(ofQuad);
        CHECK(ofMesh < 1.3 * ofQuad);
    });
}

TEST_CASE("points on emitters, directions and both agree: glossy, textured, small, over bounces")
{
    onEveryDevice([](const device::Device& device) {
        checkWays(roomWithMeshLamp(), device, 0);
        SceneBuilder textured = roomWithMeshLamp();
        scene::Texture& stripes = textured.scene.textures.emplace_back();
        stripes.width = 4;
        stripes.height = 1;
        stripes.rgba = { 0xff0000ffu, 0xff00ff00u, 0xff101010u, 0xffffffffu };
        textured.scene.materials.back().emissionTexture = 0;
        checkWays(textured, device, 0);
        SceneBuilder balls = room();
        balls.sphere({ 0.5f, 0.3f, 0.4f }, 0.12f, 6, addGlow(balls, { 20, 10, 5 }));
        balls.newObject();
        balls.sphere({ -1.0f, 0.9f, -1.2f }, 0.1f, 5, addGlow(balls, { 4, 9, 30 }));
        checkWays(balls, device, 0);
        checkWays(balls, device, 2);
    });
}

TEST_CASE("points on emitters, directions and both agree: in motion, and beside other lights")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder moving = room();
        const std::size_t before = moving.scene.geometry.positions.size();
        moving.sphere({ 0.4f, 0.5f, 0.5f }, 0.15f, 5, addGlow(moving, { 15, 12, 9 }));
        scene::Geometry& g = moving.scene.geometry;
        g.positionsAtClose = g.positions;
        g.normalsAtClose = g.normals;
        for (std::size_t i = before; i < g.positions.size(); i += 3)
            g.positionsAtClose[i] = 1.3f * g.positions[i] + 0.3f; // wider, and to the right
        checkWays(moving, device, 1);
        SceneBuilder mixed = roomWithMeshLamp();
        mixed.light({ -1, 1.8f, 0.5f }, { 0.2f, 0, 0 }, { 0, 0, 0.2f }, scene::LightProfile::Gaussian, 20).twoSided =
            true;
        checkWays(mixed, device, 1);
    });
}

TEST_CASE("faces that are there twice count once, and thin plates hide what is behind them")
{
    onEveryDevice([](const device::Device& device) {
        for (const float apart : { 0.0f, 5e-5f }) {
            CAPTURE(apart);
            SceneBuilder twice = roomWithMeshLamp();
            twice.quad(lampCentre - glm::vec3(0, apart, 0), lampV, lampU,
                static_cast<std::uint32_t>(twice.scene.materials.size() - 1));
            const Moments once = lightOf(roomWithMeshLamp(), device, found(render::LightSampling::Both, 256, 1));
            checkAgreement(lightOf(twice, device, found(render::LightSampling::Both, 256, 1)), once, 2e-3);
            checkAgreement(lightOf(twice, device, found(render::LightSampling::Lights, 256, 1)), once, 2e-3);
        }
    });
}

TEST_CASE("faces that are there twice are one whatever the signs of their zeros")
{
    SceneBuilder b = room();
    const std::uint32_t glow = addGlow(b, glm::vec3(5));
    b.triangle({ 0, 1, 0 }, { 1, 1, 0 }, { 0, 1, 1 }, glow);
    b.triangle({ -0.0f, 1, 0 }, { -0.0f, 1, 1 }, { 1, 1, -0.0f }, glow);
    const render::EmitterList list = render::emitterList(b.scene);
    CHECK(list.list.size() == 1);
    CHECK(list.picks[list.list[0].triangle + 1] == 1);
}

TEST_CASE("what emits and has no area is no light")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = room();
        b.triangle({ 0, 1, 0 }, { 1, 1, 0 }, { 2, 1, 0 }, addGlow(b, glm::vec3(5)));
        CHECK(render::emitterList(b.scene).list.empty());
        for (const render::Settings& method : { render::monteCarlo(16), render::axisAligned(16) })
            CHECK(lightOf(b, device, settingsOf(method, 1), 2).average() == 0);
    });
}

TEST_CASE("filtered light of emitters has the mean of the plain one: pinhole, antialiased, through a lens")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool lens : { false, true })
            for (const bool antialias : { false, true }) {
                CAPTURE(lens);
                CAPTURE(antialias);
                SceneBuilder b = roomWithMeshLamp();
                b.scene.camera.apertureRadius = lens ? 0.02f : 0.0f;
                b.scene.camera.focusDistance = 2.5f;
                render::Settings filtered = settingsOf(render::axisAligned(64), 0),
                                 plain = settingsOf(render::monteCarlo(256), 0);
                filtered.antialias = plain.antialias = antialias;
                const Moments a = lightOf(b, device, filtered), p = lightOf(b, device, plain);
                CHECK(a.average() == doctest::Approx(p.average()).epsilon(0.01));
            }
    });
}
