// Pictures with cut-outs against those of the same geometry without, veils, and emitters with holes.
#include "host/render/emitters.h"
#include "tests/lamp_room.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 24, height = 18;

/// A texture whose left texel is a hole.
scene::Texture halfMask() { return { "", 2, 1, { 0xff000000u, 0xffffffffu }, false }; }

/// A material with the mask; masked: with a mask at all.
std::uint32_t addMasked(SceneBuilder& b, scene::Material material, bool masked = true)
{
    material.opacityTexture = masked ? 0 : -1;
    return addMaterial(b, material);
}

/// Gives the last quad of a builder one texture coordinate: the middle of a texel of halfMask().
void moveTexture(SceneBuilder& b, bool hole)
{
    std::vector<float>& t = b.scene.geometry.texcoords;
    std::fill(t.end() - 12, t.end(), hole ? 0.25f : 0.75f);
}

/// A board of 4 x 4 fields over a floor, every other one a hole: with cut-outs, or with fields left out. moving: it
/// glides while the shutter is open.
scene::Scene checkered(bool cutouts, bool emitter, bool moving)
{
    SceneBuilder b = lampRoom();
    b.scene.textures = { halfMask() };
    scene::Material plain;
    plain.diffuse = { 0.3f, 0.6f, 0.2f };
    const std::uint32_t board = addMasked(b, plain, cutouts);
    const std::size_t before = b.scene.geometry.positions.size();
    for (int i = 0; i < 16; ++i) {
        const int column = i % 4, row = i / 4;
        const bool hole = (column + row) % 2 == 1;
        if (hole && !cutouts)
            continue;
        const auto x = static_cast<float>(column), z = static_cast<float>(row);
        b.quad({ -0.45f + 0.3f * x, 0.8f, -0.45f + 0.3f * z }, { 0, 0, 0.15f }, { 0.15f, 0, 0 }, board);
        moveTexture(b, hole);
    }
    b.newObject();
    if (emitter) {
        b.quad(lampCentre, lampU, lampV, addGlow(b, { 8, 7, 5 }));
        b.triangle({ -1, 1.5f, 0 }, { -1, 1.7f, 0 }, { -1, 1.5f, 0.3f }, addGlow(b, { 3, 7, 9 }));
    } else {
        b.light({ 0.2f, 2, 0.1f }, { 0.3f, 0, 0 }, { 0, 0, 0.3f }, scene::LightProfile::Gaussian, 20);
        b.scene.pointLights.push_back({ { 1, 1.8f, 0.5f }, glm::vec3(0.7f) });
    }
    b.scene.background = { 0.1f, 0.2f, 0.3f };
    scene::Geometry& g = b.scene.geometry;
    if (moving) {
        g.positionsAtClose = g.positions;
        g.normalsAtClose = g.normals;
        const std::size_t end = before + std::size_t { cutouts ? 16u : 8u } * 18;
        for (std::size_t i = before; i < end; i += 3)
            g.positionsAtClose[i] += 0.25f;
        b.scene.shutterClose = 1;
        b.scene.camera.apertureRadius = 0.03f;
        b.scene.camera.focusDistance = 2.5f;
    }
    return b.scene;
}

std::vector<float> picture(
    const scene::Scene& scene, const device::Device& device, render::Settings settings, render::Traversal traversal)
{
    render::Options options = renderOptions();
    options.traversal = traversal;
    render::Renderer renderer(scene, device, options);
    settings = sized(settings, width, height);
    settings.bounces = 2;
    return renderPixels(renderer, settings);
}

} // namespace

TEST_CASE("a board with cut-out fields gives the bits of a board without these fields")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool moving : { false, true })
            for (const bool emitter : { false, true }) {
                CAPTURE(moving);
                CAPTURE(emitter);
                const scene::Scene cut = checkered(true, emitter, moving), left = checkered(false, emitter, moving);
                for (const render::Settings& settings : { render::monteCarlo(16), render::axisAligned() }) {
                    const std::vector<float> a = picture(cut, device, settings, render::Traversal::Wide);
                    CHECK(a == picture(left, device, settings, render::Traversal::Wide));
                    if (moving == emitter)
                        CHECK(a == picture(cut, device, settings, render::Traversal::Scalar));
                    CHECK(*std::ranges::max_element(a) > 0.1f);
                }
            }
    });
}

TEST_CASE("both families of traversals see the same through veils and the soft edges of masks")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool lens : { false, true }) {
            CAPTURE(lens);
            SceneBuilder b = lampRoom();
            b.scene.textures = { halfMask() };
            scene::Material veil;
            veil.diffuse = { 0.3f, 0.6f, 0.2f };
            veil.opacity = 0.6f;
            b.quad({ 0.1f, 0.9f, 0 }, { 0, 0, 0.6f }, { 0.6f, 0, 0 }, addMaterial(b, veil));
            b.newObject();
            b.quad({ 0, 0.5f, 0.6f }, { 0.7f, 0, 0 }, { 0, 0.3f, 0 }, addMasked(b, veil));
            b.light({ 0.2f, 2, 0.1f }, { 0.3f, 0, 0 }, { 0, 0, 0.3f }, scene::LightProfile::Gaussian, 20);
            b.scene.pointLights.push_back({ { 1, 1.8f, 0.5f }, glm::vec3(0.7f) });
            b.scene.camera.apertureRadius = lens ? 0.03f : 0.0f;
            const render::Settings settings = lens ? render::monteCarlo(16) : render::axisAligned();
            const std::vector<float> wide = picture(b.scene, device, settings, render::Traversal::Wide);
            CHECK(wide == picture(b.scene, device, settings, render::Traversal::Scalar));
            // They are not opaque.
            scene::Scene opaque = b.scene;
            for (scene::Material& m : opaque.materials) {
                m.opacity = 1;
                m.opacityTexture = -1;
            }
            CHECK(wide != picture(opaque, device, settings, render::Traversal::Wide));
        }
    });
}

TEST_CASE("a veil lets through the share of light that it does not stop")
{
    onEveryDevice([](const device::Device& device) {
        const auto floorUnder = [&](float opacity, const render::Settings& method) {
            SceneBuilder b;
            b.quad({ 0, 0, 0 }, { 0, 0, 3 }, { 3, 0, 0 });
            b.newObject();
            scene::Material veil;
            veil.diffuse = glm::vec3(0);
            veil.opacity = opacity;
            b.quad({ 0, 1.5f, 0 }, { 0, 0, 9 }, { 9, 0, 0 }, addMaterial(b, veil));
            b.light({ 0, 2, 0 }, { 0.4f, 0, 0 }, { 0, 0, 0.4f }, scene::LightProfile::Uniform, 20);
            b.camera({ 0, 1.2f, 2 }, { 0, 0, 0 });
            return lightOf(b, device, sized(method, width, height));
        };
        const Moments whole = floorUnder(0.0f, render::monteCarlo(64));
        CHECK(whole.average() > 0.01);
        Moments expected = whole;
        for (std::size_t i = 0; i < whole.size(); ++i) {
            expected.mean[i] *= 0.7;
            expected.variance[i] *= 0.49;
        }
        checkAgreement(floorUnder(0.3f, render::monteCarlo(64)), expected, 1e-3);
        const Moments f = floorUnder(0.3f, render::axisAligned());
        CHECK(f.average() == doctest::Approx(0.7 * whole.average()).epsilon(0.01));
    });
}

TEST_CASE("emitters with holes emit as far as they are opaque, by points and by directions")
{
    const auto lamp = [](float opacity, glm::vec3 emission, bool masked) {
        SceneBuilder b = lampRoom();
        b.scene.textures = { halfMask() };
        b.quad({ 0, 1, -1.5f }, { 2, 0, 0 }, { 0, 1, 0 });
        b.newObject();
        scene::Material glow;
        glow.diffuse = glm::vec3(0);
        glow.emission = emission;
        glow.opacity = opacity;
        b.quad(lampCentre, lampU, lampV, addMasked(b, glow, masked));
        return b;
    };
    // Power is that of what is opaque.
    CHECK(render::emitterList(lamp(0.5f, glm::vec3(2), false).scene).power == doctest::Approx(0.5 * 2 * 0.3 * 2));
    CHECK(render::emitterList(lamp(1, glm::vec3(2), true).scene).power
        == doctest::Approx(0.5 * 2 * 0.3 * 2).epsilon(0.15));
    CHECK(render::emitterList(lamp(0, glm::vec3(2), false).scene).list.empty());
    onEveryDevice([&](const device::Device& device) {
        const auto of = [&](const SceneBuilder& b, render::LightSampling ways, int spp, int bounces) {
            render::Settings settings = sized(render::monteCarlo(spp), width, height);
            settings.bounces = bounces;
            settings.lightSampling = ways;
            return lightOf(b, device, settings);
        };
        const glm::vec3 bright { 8, 7, 5 };
        // Half a lamp of twice the radiance.
        checkAgreement(of(lamp(0.5f, 2.0f * bright, false), render::LightSampling::Both, 256, 0),
            of(lamp(1, bright, false), render::LightSampling::Both, 256, 0), 1e-3);
        for (const bool masked : { false, true }) {
            CAPTURE(masked);
            const SceneBuilder b = lamp(masked ? 1.0f : 0.4f, bright, masked);
            const Moments points = of(b, render::LightSampling::Lights, 256, 1);
            CHECK(points.average() > 1e-3);
            checkAgreement(of(b, render::LightSampling::Both, 256, 1), points, 1e-3);
            checkAgreement(of(b, render::LightSampling::Directions, 1024, 1), points, 1e-3);
        }
    });
}
