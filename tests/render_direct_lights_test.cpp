// Which lights have a term of direct light of their own, and the light of those that share one.
#include "host/render/direct_lights.h"
#include "tests/lamp_room.h"

#include <functional>
#include <string>

using namespace wedge;
using namespace wedge::test;

namespace {

SceneBuilder room()
{
    SceneBuilder b = lampRoom();
    addGlow(b, { 8, 7, 5 });
    return b;
}
constexpr std::uint32_t glowing = 2;

/// Panels among a scene's own terms.
std::size_t panelsOf(const SceneBuilder& b)
{
    return render::directLights(b.scene).own.size() - b.scene.areaLights.size();
}

render::Settings settingsOf(const render::Settings& method)
{
    render::Settings settings = sized(method, 24, 18);
    settings.bounces = 0;
    return settings;
}

Moments sumOf(Moments a, const Moments& b)
{
    for (std::size_t i = 0; i < a.size(); ++i) {
        a.mean[i] += b.mean[i];
        a.variance[i] += b.variance[i];
    }
    return a;
}

/// Light i of many, of one of four kinds; all of about the same power.
void addLight(SceneBuilder& b, int i)
{
    const float angle = 2.4f * static_cast<float>(i), away = 0.25f * std::sqrt(static_cast<float>(i));
    const glm::vec3 centre { away * std::cos(angle), 1.0f + 0.02f * static_cast<float>(i), away * std::sin(angle) };
    const bool gaussian = i % 2 == 1;
    scene::AreaLight& light = b.light(centre, { 0.1f, 0, 0.02f }, { -0.02f, 0.05f, 0.12f },
        gaussian ? scene::LightProfile::Gaussian : scene::LightProfile::Uniform, gaussian ? 9.0f : 4.0f);
    light.twoSided = i % 4 >= 2;
    light.visible = false;
    const bool up = i % 8 == 0; // a fourth of those of one side, whose light is not seen
    if ((glm::cross(light.halfU, light.halfV).y > 0) != up)
        std::swap(light.halfU, light.halfV);
}

SceneBuilder roomOfLights(int first, int last)
{
    SceneBuilder b = room();
    for (int i = first; i < last; ++i)
        addLight(b, i);
    return b;
}

} // namespace

TEST_CASE("a mesh of one parallelogram is as good as a quad, whichever way it is cut in two")
{
    SceneBuilder b = room();
    const std::size_t before = b.scene.geometry.materialIds.size();
    CHECK(render::directLights(b.scene).own.empty());
    CHECK_FALSE(render::directLights(b.scene).share);
    SUBCASE("a, b, c and a, c, d") { b.quad(lampCentre, lampU, lampV, glowing); }
    SUBCASE("a, b, d and b, c, d")
    {
        b.triangle(lampCentre - lampU - lampV, lampCentre + lampU - lampV, lampCentre - lampU + lampV, glowing);
        b.triangle(lampCentre + lampU - lampV, lampCentre + lampU + lampV, lampCentre - lampU + lampV, glowing);
    }
    const render::DirectLights found = render::directLights(b.scene);
    CHECK_FALSE(found.share);
    REQUIRE(found.own.size() == 1);
    CHECK(found.panelTriangles == std::vector<std::size_t> { before, before + 1 });
    const scene::AreaLight& light = found.own[0].quad;
    CHECK(glm::length(light.centre - lampCentre) < 1e-6f);
    CHECK(glm::length(glm::cross(light.halfU, light.halfV))
        == doctest::Approx(glm::length(glm::cross(lampU, lampV))).epsilon(1e-6));
    CHECK(light.radiance == glm::vec3(8, 7, 5));
    CHECK(light.profile == scene::LightProfile::Uniform);
    CHECK(light.twoSided);
    CHECK_FALSE(light.visible);
    CHECK(found.own[0].lift > 0);
    CHECK(found.own[0].lift < 1e-4f);
}

TEST_CASE("faces that are there twice are one panel, cut differently or not")
{
    SceneBuilder b = room();
    b.quad(lampCentre, lampU, lampV, glowing);
    SUBCASE("the other way round") { b.quad(lampCentre, lampV, lampU, glowing); }
    SUBCASE("cut along the other diagonal") { b.quad(lampCentre, lampV, -lampU, glowing); }
    const render::DirectLights found = render::directLights(b.scene);
    CHECK(found.own.size() == 1);
    CHECK(found.panelTriangles.size() == 4);
    CHECK_FALSE(found.share);
}

TEST_CASE("what is part of more, uneven, moving or weak shares a term")
{
    SceneBuilder b = room();
    SUBCASE("a box") { b.box(lampCentre - 0.2f, lampCentre + 0.2f, glowing); }
    SUBCASE("a triangle at its side")
    {
        b.quad(lampCentre, lampU, lampV, glowing);
        b.triangle(lampCentre + lampU + lampV, lampCentre + 2.0f * lampU, lampCentre + lampU - lampV, glowing);
    }
    SUBCASE("no parallelogram")
    {
        b.triangle(lampCentre, lampCentre + lampU, lampCentre + lampU + lampV, glowing);
        b.triangle(lampCentre, lampCentre + lampU + lampV, lampCentre + 0.99f * lampV, glowing);
    }
    SUBCASE("two of its corners differ in height")
    {
        b.triangle(lampCentre, lampCentre + lampU, lampCentre + lampU + lampV, glowing);
        b.triangle(lampCentre, lampCentre + lampU + lampV, lampCentre + lampV + glm::vec3(0, 0.01f, 0), glowing);
    }
    SUBCASE("textured")
    {
        scene::Texture& t = b.scene.textures.emplace_back();
        t.width = t.height = 1;
        t.rgba = { 0xff808080u };
        b.scene.materials[glowing].emissionTexture = 0;
        b.quad(lampCentre, lampU, lampV, glowing);
    }
    SUBCASE("moving")
    {
        b.quad(lampCentre, lampU, lampV, glowing);
        b.scene.geometry.positionsAtClose = b.scene.geometry.positions;
        b.scene.geometry.normalsAtClose = b.scene.geometry.normals;
        b.scene.geometry.positionsAtClose.back() += 0.1f;
    }
    const render::DirectLights found = render::directLights(b.scene);
    CHECK(found.own.empty());
    CHECK(found.panelTriangles.empty());
    CHECK(found.share);
    CHECK(found.shareEmitters());
}

TEST_CASE("a panel needs a sixteenth of the power of all that emits")
{
    for (const int others : { 14, 16 }) {
        CAPTURE(others);
        SceneBuilder b = room();
        b.quad(lampCentre, lampU, lampV, glowing);
        for (int i = 0; i < others; ++i)
            b.triangle(lampCentre - 2.0f * lampU, lampCentre - 4.0f * lampU,
                lampCentre - 2.0f * lampU + (4.0f + 1e-3f * static_cast<float>(i)) * lampV, glowing);
        CHECK(panelsOf(b) == (others == 14 ? 1 : 0));
        CHECK(render::directLights(b.scene).share);
    }
}

TEST_CASE("the sixteen strongest lights have terms of their own, in the scene's order; the rest is one term")
{
    SceneBuilder b = room();
    for (int i = 0; i < 20; ++i)
        b.light(lampCentre, lampU, lampV, scene::LightProfile::Uniform, i == 3 || i >= 16 ? 1.0f : 10.0f);
    b.quad(lampCentre, lampU, lampV, glowing); // 7 a side
    const render::DirectLights found = render::directLights(b.scene);
    REQUIRE(found.own.size() == 16);
    CHECK(found.own[3].quad.radiance.x == 10.0f);
    CHECK(found.own[15].lift > 0);
    CHECK(found.sharedQuads == std::vector<std::uint32_t> { 3, 16, 17, 18, 19 });
    CHECK(found.panelTriangles.size() == 2);
    CHECK(found.share);
    const render::EmitterList list = render::PreparedScene(b.scene).lights().shared;
    REQUIRE(list.list.size() == 5);
    CHECK(list.list[4].upTo == 1.0f);
    for (const shared::Emitter& e : list.list)
        CHECK(e.pair == WEDGE_PAIR_QUAD);
    CHECK(list.list[1].triangle == 16);
    CHECK(list.quadPicks[17] == doctest::Approx(0.2));
    CHECK(list.quadPicks[4] == WEDGE_PICK_ELSEWHERE);
    // The mean square of a uniform square of side 2 is 2/3.
    CHECK(list.list[0].extent == doctest::Approx(std::sqrt((0.25 * 0.25 + 0.3 * 0.3) / 3)));
    CHECK(list.picks[found.panelTriangles[0]] == WEDGE_PICK_ELSEWHERE);
}

TEST_CASE("far from the origin panels are told apart, and what is not surely a parallelogram is none")
{
    SceneBuilder b = room();
    const glm::vec3 far { 20000, 0, 20000 };
    b.quad(far + lampCentre, lampU, lampV, glowing);
    b.quad(far + lampCentre + 2.5f * lampU, lampU, lampV, glowing);
    CHECK(panelsOf(b) == 0); // rounding is a hundredth of a side
    CHECK(render::directLights(b.scene).share);
    SceneBuilder near = room();
    near.quad(lampCentre, lampU, lampV, glowing);
    near.quad(lampCentre + 2.5f * lampU, lampU, lampV, glowing);
    CHECK(panelsOf(near) == 2);
}

TEST_CASE("lights that are switched off take no term beyond the sixteenth")
{
    SceneBuilder b = room();
    for (int i = 0; i < 18; ++i)
        b.light(lampCentre, lampU, lampV, scene::LightProfile::Uniform, i < 2 ? 1.0f : 0.0f);
    const render::DirectLights found = render::directLights(b.scene);
    CHECK(found.own.size() == 16);
    CHECK(found.sharedQuads.empty());
    CHECK_FALSE(found.share);
}

TEST_CASE("what no number chooses is looked for in all directions")
{
    SceneBuilder b = room();
    SUBCASE("a quad that is too weak for its probability")
    {
        for (int i = 0; i < 17; ++i)
            b.light(lampCentre, lampU, lampV, scene::LightProfile::Uniform, i == 16 ? 1e-9f : 1.0f);
        b.sphere({ 0.5f, 0.3f, 0.4f }, 0.12f, 6, glowing);
        const render::EmitterList list = render::PreparedScene(b.scene).lights().shared;
        CHECK(list.quadPicks[16] == 0.0f);
        CHECK(list.quadPicks[15] == WEDGE_PICK_ELSEWHERE);
        CHECK(std::isinf(list.directedWithin));
    }
    SUBCASE("a triangle that has an area only later")
    {
        b.quad(lampCentre, lampU, lampV, glowing);
        CHECK(panelsOf(b) == 1);
        b.triangle(lampCentre, lampCentre, lampCentre, glowing);
        b.scene.geometry.positionsAtClose = b.scene.geometry.positions;
        b.scene.geometry.normalsAtClose = b.scene.geometry.normals;
        CHECK(panelsOf(b) == 1);
        b.scene.geometry.positionsAtClose.back() += 0.5f;
        CHECK(panelsOf(b) == 0);
        CHECK(std::isinf(render::emitterList(b.scene).directedWithin));
    }
}

TEST_CASE("a panel that reflects does not light itself: matt and glossy, tilted, by any method")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool gloss : { false, true }) {
            SceneBuilder b = room();
            scene::Material& m = b.scene.materials[glowing];
            m.diffuse = gloss ? glm::vec3(0) : glm::vec3(0.8f);
            m.specular = gloss ? glm::vec3(0.5f) : glm::vec3(0);
            m.exponent = 50;
            b.quad({ 0.31f, 0.97f, 0.53f }, { 0.4f, 0.13f, 0.07f }, { 0.11f, -0.2f, 0.4f }, glowing);
            REQUIRE(panelsOf(b) == 1);
            for (const std::string kind : { "mc", "directions", "aaf", "antialiased" }) {
                CAPTURE(gloss);
                CAPTURE(kind);
                const bool filtered = kind == "aaf" || kind == "antialiased";
                render::Settings settings = settingsOf(filtered ? render::axisAligned(28) : render::monteCarlo(28));
                settings.antialias = kind == "antialiased";
                if (kind == "directions")
                    settings.lightSampling = render::LightSampling::Directions;
                render::Renderer renderer(b.scene, device, renderOptions());
                const std::vector<float> seen = renderPixels(renderer, settings);
                std::size_t shining = 0;
                for (std::size_t i = 0; i < seen.size(); i += 3) {
                    CHECK(seen[i] <= 8.001f);
                    shining += seen[i] > 7.999f ? 1 : 0;
                }
                CHECK(shining > 20);
            }
        }
    });
}

TEST_CASE("a list's guide leads to where each stripe of numbers begins")
{
    SceneBuilder b = room();
    for (int i = 0; i < 40; ++i) { // powers from 1 to 5e5
        const float x = static_cast<float>(i), side = 0.1f * std::pow(1.4f, x);
        b.newObject();
        b.triangle({ x, 3, 0 }, { x, 3, side }, { x + 0.5f, 3, 0 }, glowing);
    }
    const std::vector<shared::Emitter> list = render::emitterList(b.scene).list;
    REQUIRE(list.size() == 40);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const float from = static_cast<float>(i) / 40.0f;
        const std::size_t chosen = list[i].guide;
        CHECK(list[chosen].upTo > from);
        CHECK((chosen == 0 || list[chosen - 1].upTo <= from));
    }
}

TEST_CASE("a mesh lamp is filtered as well as a quad: pinhole, antialiased, through a lens")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder quad = room(), mesh = room();
        scene::AreaLight& light = quad.light(lampCentre, lampU, lampV, scene::LightProfile::Uniform, 1);
        light.radiance = { 8, 7, 5 };
        light.twoSided = true;
        mesh.quad(lampCentre, lampU, lampV, glowing);
        for (const std::string kind : { "pinhole", "antialiased", "lens" }) {
            CAPTURE(kind);
            render::Settings settings = settingsOf(render::axisAligned(28));
            settings.antialias = kind != "pinhole";
            for (SceneBuilder* b : { &quad, &mesh }) {
                b->scene.camera.apertureRadius = kind == "lens" ? 0.02f : 0.0f;
                b->scene.camera.focusDistance = 2.5f;
            }
            const Moments ofMesh = lightOf(mesh, device, settings), ofQuad = lightOf(quad, device, settings);
            CHECK(ofMesh.average() == doctest::Approx(ofQuad.average()).epsilon(0.002));
            CAPTURE(rmsNoise(ofQuad));
            CHECK(rmsNoise(ofMesh) < 1.3 * rmsNoise(ofQuad));
        }
    });
}

TEST_CASE("lights that share a term bring the light that they bring alone, by points, directions and both")
{
    onEveryDevice([](const device::Device& device) {
        render::Settings plain = settingsOf(render::monteCarlo(256));
        const Moments sum =
            sumOf(lightOf(roomOfLights(0, 16), device, plain), lightOf(roomOfLights(16, 32), device, plain));
        const SceneBuilder all = roomOfLights(0, 32);
        REQUIRE(render::directLights(all.scene).sharedQuads.size() == 16);
        using render::LightSampling;
        for (const LightSampling ways : { LightSampling::Lights, LightSampling::Both, LightSampling::Directions }) {
            CAPTURE(static_cast<int>(ways));
            plain.lightSampling = ways;
            plain.spp = ways == LightSampling::Directions ? 4096 : 256;
            checkAgreement(lightOf(all, device, plain), sum, 1e-3);
        }
        render::Settings filtered = settingsOf(render::axisAligned(64));
        CHECK(lightOf(all, device, filtered).average() == doctest::Approx(sum.average()).epsilon(0.01));
        filtered.antialias = true;
        CHECK(lightOf(all, device, filtered).average() > 0);
    });
}

TEST_CASE("a panel and what shares a term beside it bring the light that each brings alone, directly and over bounces")
{
    onEveryDevice([](const device::Device& device) {
        const auto roomOf = [](bool panel, bool ball) {
            SceneBuilder b = room();
            b.scene.materials.push_back(b.scene.materials[0]); // what does not shine still hides
            const std::uint32_t dark = static_cast<std::uint32_t>(b.scene.materials.size() - 1);
            b.scene.materials[dark].diffuse = glm::vec3(0);
            b.quad(lampCentre, lampU, lampV, panel ? glowing : dark);
            b.newObject();
            b.sphere({ 0.5f, 0.3f, 0.4f }, 0.12f, 6, ball ? glowing : dark);
            return b;
        };
        REQUIRE(panelsOf(roomOf(true, true)) == 1);
        using render::LightSampling;
        for (const int bounces : { 0, 1 }) {
            CAPTURE(bounces);
            render::Settings plain = settingsOf(render::monteCarlo(256));
            plain.bounces = bounces;
            const Moments sum =
                sumOf(lightOf(roomOf(true, false), device, plain), lightOf(roomOf(false, true), device, plain));
            for (const LightSampling ways : { LightSampling::Lights, LightSampling::Both, LightSampling::Directions }) {
                CAPTURE(static_cast<int>(ways));
                plain.lightSampling = ways;
                plain.spp = ways == LightSampling::Directions ? 1024 : 256;
                checkAgreement(lightOf(roomOf(true, true), device, plain), sum, 1e-3);
            }
        }
    });
}
