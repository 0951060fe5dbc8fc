// Mirrors and glass: pictures that a camera sees from elsewhere, furnaces, slabs, and what paths find through them.
#include "effects/environment/environment.h"
#include "host/render/environment_table.h"
#include "kernels/shared/mirror.h"
#include "tests/glass_support.h"
#include "tests/image_means.h"

#include <doctest/doctest.h>

#include <atomic>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Frames of every kind, of as many samples. camera: whether it has a lens and something moves.
struct Kind {
    bool filtered, lens, antialias, progressive;
};
constexpr Kind kinds[] = { { false, false, false, false }, { true, false, false, false }, { false, false, true, false },
    { true, false, true, false }, { false, true, false, false }, { true, true, false, false },
    { false, false, false, true }, { true, true, false, true } };

render::Settings settingsOf(const Kind& kind, int spp, int width = 24, int height = 18)
{
    render::Settings s = sized(kind.filtered ? render::axisAligned(spp) : render::monteCarlo(spp), width, height);
    s.antialias = kind.antialias;
    s.progressive = kind.progressive;
    return s;
}

/// The scene with a lens, and with a shutter while which an object far away moves, or as it is.
scene::Scene withLens(scene::Scene scene, bool lens)
{
    if (lens) {
        scene.camera.apertureRadius = 0.02f;
        scene.geometry.positionsAtClose = scene.geometry.positions;
        scene.geometry.normalsAtClose = scene.geometry.normals;
        for (std::size_t i = scene.geometry.positions.size() - 9; i < scene.geometry.positions.size(); i += 3)
            scene.geometry.positionsAtClose[i] += 0.1f;
        scene.shutterClose = 1;
    }
    return scene;
}

/// Things at x < 1 in front of the plane x = 1, of many colours and an emitter, under a point light.
SceneBuilder things()
{
    SceneBuilder b;
    scene::Material shiny;
    shiny.diffuse = { 0.4f, 0.5f, 0.3f };
    shiny.specular = glm::vec3(0.3f);
    shiny.exponent = 30;
    b.quad({ -1, 0, 0 }, { 0, 0, 3 }, { 1.9f, 0, 0 });
    b.newObject();
    b.box({ -0.8f, 0, -0.5f }, { -0.2f, 0.7f, 0 }, addMaterial(b, shiny));
    b.newObject();
    b.sphere({ 0.1f, 0.4f, 0.6f }, 0.4f, 12);
    b.newObject();
    b.scene.background = { 0.1f, 0.2f, 0.3f };
    return b;
}

/// Two cameras that see the same: before the plane x = 1 with a mirror in it, and mirrored behind it, without. The
/// images are mirrored left to right.
struct Mirrored {
    scene::Scene seen, direct;
    std::uint32_t mirror; ///< its object
};

/// half: extent of the mirror, metres
Mirrored mirrored(SceneBuilder plain, glm::vec3 colour, float half = 30)
{
    SceneBuilder with = plain;
    const glm::vec3 eye(-1.2f, 0.8f, 1.9f), to(1, 0.6f, 0.6f);
    with.newObject();
    with.quad(to, { 0, 0, half }, { 0, half, 0 }, addMaterial(with, mirror(colour)));
    const auto object = static_cast<std::uint32_t>(with.scene.geometry.objectNames.size());
    const float fov = half > 1 ? 30.0f : 1.5f; // the small one fills the image
    with.camera(eye, to, { 0, 1, 0 }, fov);
    const auto across = [](glm::vec3 p) { return glm::vec3(2 - p.x, p.y, p.z); };
    plain.camera(across(eye), across(to), { 0, 1, 0 }, fov);
    return { with.scene, plain.scene, object };
}

/// 1 of the numbers of the frame's pixels that show the object, else 0.
std::vector<int> showing(render::Renderer& renderer, std::uint32_t object)
{
    const render::PlaneLayout& layout = renderer.frame().layout;
    const std::vector<std::uint32_t> ids = renderer.frame().counts("objectId").downloadAll(renderer.queue());
    std::vector<int> out;
    everyPixel(layout, [&](int x, int y) {
        const bool shows =
            ids[shared::pixelIndex(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), layout.stride)]
            == object;
        out.insert(out.end(), 3, shows ? 1 : 0);
    });
    return out;
}

std::vector<float> leftToRight(const std::vector<float>& pixels, std::size_t width)
{
    std::vector<float> out(pixels.size());
    for (std::size_t i = 0; i < pixels.size() / 3; ++i) {
        const std::size_t j = i - i % width + width - 1 - i % width;
        std::copy_n(
            pixels.begin() + static_cast<std::ptrdiff_t>(3 * j), 3, out.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return out;
}

} // namespace

TEST_CASE("a flat mirror shows what a camera behind it sees, pixel by pixel, of a point light and what emits")
{
    SceneBuilder b = things();
    b.scene.pointLights.push_back({ { -0.5f, 2, 0.6f }, { 3, 2.5f, 2 } });
    const glm::vec3 colour(0.9f, 0.5f, 0.7f);
    const Mirrored m = mirrored(b, colour);
    onEveryDevice([&](const device::Device& device) {
        for (const render::Traversal traversal : { render::Traversal::Wide, render::Traversal::Scalar })
            for (const bool filtered : { false, true }) {
                render::Options options = renderOptions();
                options.traversal = traversal;
                render::Renderer seen(m.seen, device, options), direct(m.direct, device, options);
                const render::Settings s = sized(filtered ? render::axisAligned(16) : render::monteCarlo(1), 64, 48);
                const std::vector<float> a = renderPixels(seen, s), e = leftToRight(renderPixels(direct, s), 64);
                const std::vector<int> shows = showing(seen, m.mirror);
                REQUIRE(notFinite(a) == 0);
                int off = 0, count = 0;
                for (std::size_t i = 0; i < a.size(); ++i) {
                    const float expected = e[i] * colour[static_cast<int>(i % 3)];
                    off += shows[i] != 0 && std::abs(a[i] - expected) > 1e-3f + 1e-3f * e[i] ? 1 : 0;
                    count += shows[i];
                }
                CHECK(count > 3000);
                CHECK(off < 30); // edges of things by rounding
                CHECK(meanOf(e, 0).value > 0.05);
            }
    });
}

TEST_CASE("a mirror shows visible lights and the sky, with suns that were taken out of it, as the camera sees them")
{
    SceneBuilder b;
    b.triangle({ 0, -9, 0 }, { 0.1f, -9, 0 }, { 0, -9, 0.1f });
    b.light({ -0.5f, 0.15f, -0.3f }, { 0, 0.1f, 0 }, { 0, 0, 0.1f }, scene::LightProfile::Gaussian, 50).visible = true;
    b.light({ -0.5f, 0.6f, 0.3f }, { 0, 0.1f, 0 }, { 0, 0, 0.1f }, scene::LightProfile::Uniform, 5000);
    Mirrored m = mirrored(b, glm::vec3(1));
    render::EnvironmentPicture sky;
    sky.width = 64;
    sky.height = 32;
    for (int y = 0; y < sky.height; ++y)
        for (int x = 0; x < sky.width; ++x)
            for (int c = 0; c < 3; ++c)
                sky.radiance.push_back(0.3f + 0.2f * static_cast<float>((x / 4 + y / 4 + c) % 2));
    sky.shown = sky.radiance;
    const glm::vec3 sun = glm::normalize(glm::vec3(-2.2f, -0.1f, -1.3f));
    const double column = 32 + 64 / (2 * 3.14159265) * std::atan2(sun.x, -sun.z);
    const std::size_t texel = 16 * 64 + static_cast<std::size_t>(column);
    std::fill_n(sky.shown.begin() + static_cast<std::ptrdiff_t>(3 * texel), 3, 400.0f);
    const auto picture = std::make_shared<const render::EnvironmentPicture>(sky);
    render::setEnvironment(m.seen, picture);
    render::setEnvironment(m.direct, picture);
    m.seen.background = m.direct.background = { 0, 0.1f, 0.2f };
    onEveryDevice([&](const device::Device& device) {
        render::Renderer seen(m.seen, device, renderOptions()), direct(m.direct, device, renderOptions());
        for (const bool filtered : { false, true }) {
            const render::Settings s = sized(filtered ? render::axisAligned(16) : render::monteCarlo(1), 64, 48);
            const std::vector<float> a = renderPixels(seen, s), e = leftToRight(renderPixels(direct, s), 64);
            REQUIRE(notFinite(a) == 0);
            CHECK(*std::ranges::max_element(e) > 100);
            int off = 0, bright = 0;
            for (std::size_t i = 0; i < a.size(); ++i) {
                off += std::abs(a[i] - e[i]) > 2e-3f * e[i] ? 1 : 0;
                bright += e[i] > 5 && e[i] < 51 ? 1 : 0;
            }
            CHECK(bright > 100); // the light
            CHECK(off < 15); // its edge by rounding
        }
    });
}

TEST_CASE("a mirror shows what lamps, emitters, sky and paths light as the camera sees it")
{
    for (const int bounces : { 0, 2 }) {
        SceneBuilder b = things();
        b.light({ -0.5f, 2, 0.2f }, { 0.3f, 0, 0 }, { 0, 0, 0.3f }, scene::LightProfile::Uniform, 20);
        b.quad({ -0.9f, 1.1f, 0 }, { 0, 0.1f, 0 }, { 0, 0, 0.2f }, addGlow(b, { 6, 3, 2 }));
        addSky(b.scene, { { 0.8f, 0.5f, 0.2f }, { 0.1f, 0.4f, 1.0f }, { 0.5f, 0.5f, 0.5f } });
        const Mirrored m = mirrored(b, glm::vec3(1), 0.08f);
        onEveryDevice([&](const device::Device& device) {
            render::Renderer first(m.seen, device, renderOptions()), second(m.direct, device, renderOptions());
            for (const bool filtered : { false, true }) {
                render::Settings s = sized(filtered ? render::axisAligned(256) : render::monteCarlo(256), 32, 24);
                s.bounces = bounces;
                const std::vector<float> a = renderPixels(first, s), e = leftToRight(renderPixels(second, s), 32);
                const std::vector<int> shows = showing(first, m.mirror);
                REQUIRE(std::ranges::count(shows, 0) == 0);
                std::vector<float> difference(a.size());
                std::ranges::transform(a, e, difference.begin(), std::minus<>());
                CAPTURE(bounces);
                CAPTURE(filtered);
                REQUIRE(notFinite(a) == 0);
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    const Mean d = meanOf(difference, channel), mean = meanOf(e, channel);
                    CAPTURE(d.value);
                    CAPTURE(d.deviation);
                    CAPTURE(mean.value);
                    CHECK(std::abs(d.value) < 4 * d.deviation + 5e-3 * mean.value);
                    CHECK(d.deviation < 0.01 * mean.value);
                }
            }
        });
    }
}

TEST_CASE("mirrors and glass in an even sky cannot be seen, in every kind of frame")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool isGlass : { false, true }) {
            SceneBuilder b;
            const std::uint32_t material = addMaterial(b, isGlass ? glass() : mirror());
            b.sphere({ 0, 0, 0 }, 1, 16, material);
            b.box({ -2, -0.6f, -0.4f }, { -1.2f, 0.5f, 0.5f }, material);
            b.triangle({ 0, -50, 0 }, { 0.1f, -50, 0 }, { 0, -50, 0.1f });
            b.camera({ 0.3f, 0.9f, 4 }, { -0.2f, 0, 0 });
            addSky(b.scene, { even });
            for (const Kind& kind : kinds) {
                CAPTURE(isGlass);
                CAPTURE(kind.filtered);
                CAPTURE(kind.lens);
                CAPTURE(kind.antialias);
                CAPTURE(kind.progressive);
                const scene::Scene scene = withLens(b.scene, kind.lens);
                render::Renderer renderer(scene, device, renderOptions());
                render::Settings s = settingsOf(kind, 64);
                const std::vector<float> played = renderPixels(renderer, s);
                REQUIRE(notFinite(played) == 0);
                CHECK(std::abs(meanOf(played, 0).value - even.x) < 4 * meanOf(played, 0).deviation + 1e-5);
                // Without roulette nothing is gained, and lost where a ray slips past an edge of glass, here and there.
                s.maxSurfaces = 4096;
                const std::vector<float> image = renderPixels(renderer, s);
                for (std::size_t i = 0; i < image.size(); ++i) {
                    REQUIRE(image[i] < even[static_cast<int>(i % 3)] * 1.001f);
                    REQUIRE(image[i] > even[static_cast<int>(i % 3)] * (isGlass ? 0.98f : 0.999f));
                }
            }
        }
    });
}

TEST_CASE("a frame that is stopped shows what mirrors were sampled for, as bright as it is")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.sphere({ 0, 0, 0 }, 1, 16, addMaterial(b, mirror()));
        b.triangle({ 0, -50, 0 }, { 0.1f, -50, 0 }, { 0, -50, 0.1f });
        b.camera({ 0.3f, 0.9f, 4 }, { -0.2f, 0, 0 });
        addSky(b.scene, { even });
        render::Renderer renderer(b.scene, device, renderOptions());
        render::Settings s = sized(render::monteCarlo(256), 24, 18);
        s.maxSurfaces = 4096; // no roulette
        renderer.queue().setTargetMilliseconds(0.01);
        // By the work that is done, and not by looks at it, of which a busy machine has others.
        const auto renderUntil = [&](double share) {
            std::atomic<bool> cancel { false };
            render::Control control;
            control.cancel = &cancel;
            control.progress = [&](double done) { cancel = done >= share; };
            renderer.render(s, control);
        };
        for (const double share : { 0.7, 0.95 }) {
            CAPTURE(share);
            renderUntil(share);
            const std::vector<float> image = pixels(renderer, "beauty", { 0, 0, s.width, s.height });
            const std::vector<int> ofMirror = showing(renderer, 1);
            unsigned shown = 0;
            for (std::size_t i = 0; i < image.size(); ++i) {
                const float whole = even[static_cast<int>(i % 3)];
                REQUIRE((image[i] == 0.0f || std::abs(image[i] - whole) < 1e-3f * whole));
                shown += ofMirror[i] == 1 && image[i] > 0.0f ? 1 : 0;
            }
            CHECK(shown > 0);
        }
    });
}

TEST_CASE("a slab reflects and transmits what Fresnel's series add up to, coloured or not")
{
    onEveryDevice([](const device::Device& device) {
        for (const double angle : { 0.3, 1.0, 1.35 })
            for (const bool coloured : { false, true }) {
                const glm::dvec3 r = coloured ? glm::dvec3(0.9, 0.6, 0.3) : glm::dvec3(1),
                                 t = coloured ? glm::dvec3(0.5, 0.8, 0.95) : glm::dvec3(1);
                SceneBuilder b;
                const std::uint32_t slab = addMaterial(b, glass(1.5f, r, t));
                b.box({ -400, -0.1f, -400 }, { 400, 0.1f, 400 }, slab);
                b.camera(3.0f * glm::vec3(static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle)), 0),
                    { 0, 0, 0 }, { 0, 0, 1 }, 0.2f);
                const glm::dvec3 above(0.8, 0.5, 0.2), below(0.1, 0.4, 1.0);
                std::vector<glm::vec3> rows(64, glm::vec3(above));
                std::fill(rows.begin() + 32, rows.end(), glm::vec3(below));
                addSky(b.scene, rows);
                float cosine = 0;
                const double f = shared::dielectricFresnel(static_cast<float>(std::cos(angle)), 1.5f, &cosine);
                glm::vec3 expected;
                for (int c = 0; c < 3; ++c) {
                    const double rf = r[c] * f, through = t[c] * t[c] * (1 - f) * (1 - f) / (1 - rf * rf);
                    expected[c] = static_cast<float>((rf + through * rf) * above[c] + through * below[c]);
                }
                render::Renderer renderer(b.scene, device, renderOptions());
                for (const bool filtered : { false, true }) {
                    CAPTURE(angle);
                    CAPTURE(coloured);
                    CAPTURE(filtered);
                    const render::Settings s =
                        sized(filtered ? render::axisAligned(256) : render::monteCarlo(256), 24, 24);
                    checkMean(renderPixels(renderer, s), expected, 1e-3);
                }
            }
    });
}

TEST_CASE("radiance from within glass is less by the squared index, and beyond the critical angle nothing gets out")
{
    onEveryDevice([](const device::Device& device) {
        for (const float index : { 1.33f, 2.0f }) {
            SceneBuilder b;
            b.box({ -1, -1, -1 }, { 1, 1, 1 }, addMaterial(b, glass(index)));
            b.quad({ 0, 0, -0.5f }, { 0.9f, 0, 0 }, { 0, 0.9f, 0 }, addGlow(b, { 5, 5, 5 }));
            b.camera({ 0, 0, 6 }, { 0, 0, 0 }, { 0, 1, 0 }, 1);
            const double f = std::pow((index - 1) / (index + 1), 2);
            render::Renderer outside(b.scene, device, renderOptions());
            // What is reflected back inside meets the emitter again, which is black to light.
            checkMean(renderPixels(outside, sized(render::monteCarlo(256), 16, 16)),
                glm::vec3(static_cast<float>(5 * (1 - f) / (index * index))), 2e-3);
        }
        // From within: the surface above is a mirror where it is seen at more than 41.8 degrees from its normal.
        SceneBuilder b;
        b.box({ -50, -5, -50 }, { 50, 0, 50 }, addMaterial(b, glass(1.5f)));
        b.quad({ 0, -4, 0 }, { 0, 0, 40 }, { 40, 0, 0 }, addGlow(b, { 2, 3, 4 }));
        b.camera({ 0, -1, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, 1);
        addSky(b.scene, { glm::vec3(100) });
        render::Renderer inside(b.scene, device, renderOptions());
        checkMean(renderPixels(inside, sized(render::monteCarlo(16), 16, 16)), { 2, 3, 4 }, 1e-5);
    });
}

TEST_CASE("paths that mirrors lead to lights agree by each technique, and with a closed form")
{
    onEveryDevice([](const device::Device& device) {
        // A small plate below a mirror ball in an even sky: every path of one bounce ends in the sky.
        SceneBuilder b;
        b.quad({ 0, 0, 0 }, { 0, 0, 0.01f }, { 0.01f, 0, 0 });
        b.sphere({ 0, 1.2f, 0 }, 1, 24, addMaterial(b, mirror()));
        b.camera({ 0.7f, 0.1f, 0 }, { 0, 0, 0 }, { 0, 1, 0 }, 0.2f);
        addSky(b.scene, { even });
        render::Renderer plate(b.scene, device, renderOptions());
        for (const bool filtered : { false, true }) {
            render::Settings s = sized(filtered ? render::axisAligned(256) : render::monteCarlo(256), 16, 16);
            s.bounces = 1;
            checkMean(renderPixels(plate, s), even * b.scene.materials[0].diffuse, 5e-3);
        }
        // Lamps, a mirror beside them and glass before them.
        SceneBuilder room = lampRoom();
        room.quad(lampCentre, lampU, lampV, addGlow(room, { 8, 7, 5 }));
        room.light({ -0.6f, 1.5f, 0.4f }, { 0.3f, 0, 0 }, { 0, 0, 0.3f }, scene::LightProfile::Uniform, 8);
        room.newObject();
        room.quad({ -1.2f, 0.8f, 0 }, { 0, 0.8f, 0 }, { 0, 0, 1 }, addMaterial(room, mirror({ 0.9f, 0.8f, 0.7f })));
        room.box({ 0.4f, 0.2f, -0.2f }, { 0.9f, 0.6f, 0.3f }, addMaterial(room, glass()));
        std::vector<Moments> found;
        for (const render::LightSampling sampling :
            { render::LightSampling::Both, render::LightSampling::Lights, render::LightSampling::Directions }) {
            render::Settings s = sized(render::monteCarlo(256), 16, 12);
            s.bounces = 3;
            s.lightSampling = sampling;
            found.push_back(lightOf(room, device, s));
        }
        for (std::size_t technique = 1; technique < 3; ++technique) {
            double difference = 0, variance = 0, sum = 0;
            for (std::size_t i = 0; i < found[0].size(); ++i) {
                difference += found[technique].mean[i] - found[0].mean[i];
                variance += found[technique].variance[i] + found[0].variance[i];
                sum += found[0].mean[i];
            }
            CAPTURE(technique);
            CAPTURE(difference / sum);
            CAPTURE(std::sqrt(variance) / sum);
            CHECK(std::abs(difference) < 4 * std::sqrt(variance));
            CHECK(std::sqrt(variance) < 0.02 * sum);
        }
    });
}

TEST_CASE("mirrors keep their own samples: filters leave their pixels as plain Monte Carlo has them, to the bit")
{
    // One object of a mirror and a matt part, side by side in one plane.
    SceneBuilder b = things();
    b.light({ -0.5f, 2, 0.2f }, { 0.3f, 0, 0 }, { 0, 0, 0.3f }, scene::LightProfile::Uniform, 20);
    b.newObject();
    b.quad({ 0.8f, 0.6f, -0.8f }, { 0, 0, 0.8f }, { 0, 0.6f, 0 }, addMaterial(b, mirror()));
    b.quad({ 0.8f, 0.6f, 0.8f }, { 0, 0, 0.8f }, { 0, 0.6f, 0 });
    b.camera({ -1.6f, 1, 0.6f }, { 0.8f, 0.5f, 0.2f }, { 0, 1, 0 }, 50);
    onEveryDevice([&](const device::Device& device) {
        render::Renderer renderer(b.scene, device, renderOptions());
        render::Settings mc = sized(render::monteCarlo(32), 48, 36), aaf = sized(render::axisAligned(32), 48, 36);
        mc.bounces = aaf.bounces = 1;
        const std::vector<float> plain = renderPixels(renderer, mc, true);
        const std::vector<float> kd = pixels(renderer, "albedo", { 0, 0, 48, 36 });
        const std::vector<float> filtered = renderPixels(renderer, aaf, true);
        const std::vector<int> shows =
            showing(renderer, static_cast<std::uint32_t>(b.scene.geometry.objectNames.size()));
        int mirrors = 0;
        for (std::size_t i = 0; i < kd.size() / 3; ++i) {
            if (shows[3 * i] != 0 && kd[3 * i] + kd[3 * i + 1] + kd[3 * i + 2] == 0) {
                ++mirrors;
                for (std::size_t c = 0; c < 3; ++c)
                    REQUIRE(filtered[3 * i + c] == plain[3 * i + c]);
            }
        }
        CHECK(mirrors > 100);
        CHECK(notFinite(filtered) == 0);
    });
}

TEST_CASE("every kind of frame of a room with mirror and glass has the mean of plain Monte Carlo")
{
    SceneBuilder b = things();
    b.light({ -0.5f, 2, 0.2f }, { 0.3f, 0, 0 }, { 0, 0, 0.3f }, scene::LightProfile::Uniform, 20).visible = true;
    b.quad({ 0.9f, 0.6f, 0 }, { 0, 0, 1.5f }, { 0, 0.6f, 0 }, addMaterial(b, mirror({ 0.9f, 0.9f, 0.8f })));
    b.newObject();
    b.sphere({ -0.4f, 0.35f, 1.1f }, 0.35f, 16, addMaterial(b, glass()));
    b.newObject();
    b.triangle({ 0, -50, 0 }, { 0.1f, -50, 0 }, { 0, -50, 0.1f });
    b.camera({ -1.6f, 1, 2.2f }, { 0.2f, 0.4f, 0.2f }, { 0, 1, 0 }, 45);
    onEveryDevice([&](const device::Device& device) {
        for (const bool lens : { false, true }) {
            const scene::Scene scene = withLens(b.scene, lens);
            render::Renderer renderer(scene, device, renderOptions());
            render::Settings reference = settingsOf({ false, lens, true, false }, 512, 24, 18);
            reference.bounces = 1;
            const std::vector<float> e = renderPixels(renderer, reference);
            for (const Kind& kind : kinds) {
                if (kind.lens != lens)
                    continue;
                render::Settings s = settingsOf(kind, 128, 24, 18);
                s.bounces = 1;
                const std::vector<float> image = renderPixels(renderer, s);
                REQUIRE(notFinite(image) == 0);
                CAPTURE(lens);
                CAPTURE(kind.filtered);
                CAPTURE(kind.antialias);
                CAPTURE(kind.progressive);
                const bool pixelCentres = !kind.antialias && !kind.progressive && !lens;
                for (std::size_t channel = 0; channel < 3; ++channel)
                    CHECK(meanOf(image, channel).value
                        == doctest::Approx(meanOf(e, channel).value).epsilon(pixelCentres ? 0.03 : 0.02));
            }
        }
    });
}
