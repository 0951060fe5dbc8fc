// Frames of which only knobs of shadows' styles change: the passes that run, and the bits of a frame by itself.
#include "host/render/filter_call.h"
#include "tests/render_support.h"

#include <doctest/doctest.h>

#include <functional>
#include <set>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 75, height = 58;

/// What the styles' keys reach.
constexpr float mostInflation = 0.3f, mostSoftness = 0.25f, mostAbstraction = 0.1f;

scene::ShadowStyle style(float weight, float inflation, float softness, float abstraction, const glm::vec3& brightness)
{
    scene::ShadowStyle out;
    out.weight = weight;
    out.inflation = inflation;
    out.softness = softness;
    out.abstraction = abstraction;
    out.brightness = brightness;
    scene::ShadowStyle key = out;
    key.inflation = mostInflation;
    key.softness = mostSoftness;
    key.abstraction = mostAbstraction;
    out.keys = { key };
    return out;
}

/// The knobs that tests turn: of the sun's first style.
struct Turned {
    float inflation = 0.05f, softness = 0.1f, abstraction = 0.04f;
    glm::vec3 brightness { 0.1f, 0.2f, 0.3f };
};

void turn(scene::Scene& scene, const Turned& t)
{
    scene.directionalLights[0].styles[0] = style(0.75f, t.inflation, t.softness, t.abstraction, t.brightness);
}

/// Two area lights, a sun of two styles, a lamp with one, and a lamp without; glossy things.
scene::Scene sceneOf(const Turned& t)
{
    scene::Scene scene = glossyScene();
    scene.pointLights = { { { 1, 3, 2 }, { 4, 3, 2 }, "lamp", { style(1, -0.02f, 0.1f, 0, glm::vec3(0)) } },
        { { -1, 3, 1 }, { 2, 2, 2 }, "plain" } };
    const scene::ShadowStyle second = style(0.25f, 0.1f, 0, 0.05f, glm::vec3(0.2f));
    scene.directionalLights = { { { 0.36f, -0.8f, 0.48f }, { 2, 1, 3 }, "sun", { second, second } } };
    turn(scene, t);
    return scene;
}

render::Settings settings(render::Settings s, std::uint32_t frame = 0)
{
    s = sized(s, width, height);
    s.bounces = 1;
    s.frame = frame;
    s.sameNumbers = true;
    return s;
}

/// Names of the passes of the renderer's last frame, launches on the host left out.
std::set<std::string> passesOf(const render::FrameStatistics& frame)
{
    std::set<std::string> out;
    for (const device::PassRecord& pass : frame.passes)
        if (pass.launches > 0 && pass.kind != device::PassKind::Transfer)
            out.insert(pass.name);
    return out;
}

std::vector<float> beauty(render::Renderer& renderer) { return pixels(renderer, "beauty", { 0, 0, width, height }); }

void change(render::Renderer& renderer, const Turned& t)
{
    renderer.changeScene({ .onlyKnobs = true }, [&](scene::Scene& scene) { turn(scene, t); });
}

/// Renders a frame whose knobs have changed: it is another one than before, and has the bits of a frame of that scene
/// by itself.
render::FrameStatistics againAsAlone(render::Renderer& renderer, const std::vector<float>& before,
    const scene::Scene& scene, const render::Settings& s, bool layers)
{
    render::FrameStatistics frame = renderer.render(s, {}, layers);
    render::Options poisoned = renderOptions();
    poisoned.poison = true;
    render::Renderer alone(scene, renderer.device(), poisoned);
    alone.render(s, {}, layers);
    CHECK(sameBits(beauty(renderer), beauty(alone)));
    CHECK_FALSE(sameBits(beauty(renderer), before));
    return frame;
}

} // namespace

TEST_CASE("where knobs change, passes that go by them run again, and bits are those of a frame by itself")
{
    onEveryDevice([](const device::Device& device) {
        for (const render::Settings& of : { render::monteCarlo(4), render::axisAligned(16) }) {
            for (const bool layers : { false, true }) {
                CAPTURE(render::methodName(of));
                CAPTURE(layers);
                render::Renderer renderer(sceneOf({}), device, renderOptions());
                const render::FrameStatistics first = renderer.render(settings(of), {}, layers);
                CHECK(renderer.framesCompiled() == 1);
                std::uint32_t number = 0;
                const auto ran = [&](const Turned& t) {
                    const std::vector<float> before = beauty(renderer);
                    change(renderer, t);
                    const render::FrameStatistics frame =
                        againAsAlone(renderer, before, sceneOf(t), settings(of, ++number), layers);
                    CHECK(frame.frame == number);
                    CHECK(frame.passes.size() < first.passes.size());
                    CHECK(frame.sppMean == first.sppMean);
                    return passesOf(frame);
                };
                using Names = std::set<std::string>;
                Names shades { "composite", "styles of shadows" };
                if (of.method == render::Method::AxisAligned)
                    shades.insert("fallback");
                Names blurs = shades;
                blurs.insert({ "areas of shadows", "blur of shadows' edges" });
                CHECK(ran({ .inflation = 0.1f }) == shades);
                CHECK(ran({ .inflation = -0.1f, .softness = 0.2f }) == shades);
                CHECK(ran({ .brightness = { 0, 0.5f, 1 } }) == shades);
                CHECK(ran({ .softness = 0, .abstraction = 0.08f }) == blurs);
                CHECK(ran({ .abstraction = 0.08f }) == shades);
                CHECK(renderer.framesCompiled() == 1);
            }
        }
    });
}

TEST_CASE("knobs that go by what throws the shadow change likewise, within what keys reach")
{
    onEveryDevice([](const device::Device& device) {
        const auto sceneBy = [](float linear) {
            scene::Scene scene = sceneOf({});
            scene::ShadowStyle& first = scene.directionalLights[0].styles[0];
            for (scene::ShadowStyle* each : { &first, &first.keys[0] }) {
                each->inflation.linear = each == &first ? linear : 0.2f;
                each->brightness.square = glm::vec3(0.1f);
            }
            return scene;
        };
        const render::Settings s = settings(render::monteCarlo(4));
        render::Renderer renderer(sceneBy(0.05f), device, renderOptions()),
            alone(sceneBy(0.15f), device, renderOptions());
        renderer.render(s);
        const std::vector<float> before = beauty(renderer);
        renderer.changeScene({ .onlyKnobs = true },
            [](scene::Scene& scene) { scene.directionalLights[0].styles[0].inflation.linear = 0.15f; });
        CHECK(passesOf(renderer.render(s)) == std::set<std::string> { "composite", "styles of shadows" });
        alone.render(s);
        CHECK(sameBits(beauty(renderer), beauty(alone)));
        CHECK_FALSE(sameBits(beauty(renderer), before));
    });
}

TEST_CASE("so do those of styles of other casters, and on some receivers")
{
    onEveryDevice([](const device::Device& device) {
        const auto sceneOfStyles = [](float first, float second) {
            scene::Scene scene = sceneOf({});
            std::vector<scene::ShadowStyle>& styles = scene.directionalLights[0].styles;
            styles[0].casters = { scene.geometry.objectNames[1] };
            styles[1].receivers = { scene.geometry.objectNames[0] };
            styles[0].inflation = first;
            styles[1].inflation = second;
            return scene;
        };
        const render::Settings s = settings(render::monteCarlo(4));
        render::Renderer renderer(sceneOfStyles(0.05f, 0.1f), device, renderOptions());
        renderer.render(s);
        const std::vector<float> before = beauty(renderer);
        renderer.changeScene(
            { .onlyKnobs = true }, [](scene::Scene& scene) { scene.directionalLights[0].styles[0].inflation = 0.2f; });
        CHECK(passesOf(renderer.render(s)) == std::set<std::string> { "composite", "styles of shadows" });
        render::Renderer alone(sceneOfStyles(0.2f, 0.1f), device, renderOptions());
        alone.render(s);
        CHECK(sameBits(beauty(renderer), beauty(alone)));
        CHECK_FALSE(sameBits(beauty(renderer), before));
    });
}

TEST_CASE("so do those of soft shadows, but for penumbras, for which frames run whole")
{
    onEveryDevice([](const device::Device& device) {
        const auto sceneOfQuads = [](const Turned& t, float penumbra = 1) {
            scene::Scene scene = sceneOf({});
            for (scene::AreaLight& light : scene.areaLights) {
                light.styles = { style(1, t.inflation, t.softness, t.abstraction, t.brightness) };
                light.styles[0].penumbra = light.styles[0].keys[0].penumbra = penumbra;
            }
            return scene;
        };
        for (const bool layers : { false, true }) {
            CAPTURE(layers);
            render::Renderer renderer(sceneOfQuads({}), device, renderOptions());
            const render::FrameStatistics first = renderer.render(settings(render::axisAligned(16)), {}, layers);
            std::uint32_t number = 0;
            const auto ran = [&](const Turned& t, bool knobs = true, float penumbra = 1) {
                const std::vector<float> before = beauty(renderer);
                renderer.changeScene({ .onlyKnobs = knobs }, [&](scene::Scene& scene) {
                    const scene::Scene turned = sceneOfQuads(t, penumbra);
                    for (std::size_t i = 0; i < scene.areaLights.size(); ++i)
                        scene.areaLights[i].styles = turned.areaLights[i].styles;
                });
                const render::FrameStatistics frame = againAsAlone(
                    renderer, before, sceneOfQuads(t, penumbra), settings(render::axisAligned(16), ++number), layers);
                CHECK((frame.passes.size() < first.passes.size()) == knobs);
                return passesOf(frame);
            };
            using Names = std::set<std::string>;
            const Names shades { "composite", "styles of shadows" };
            CHECK(ran({ .inflation = 0.1f }) == shades);
            CHECK(ran({ .softness = 0.2f, .brightness = { 0, 0.5f, 1 } }) == shades);
            const Names blurs = ran({ .abstraction = 0.08f });
            CHECK(blurs == Names { "areas of shadows", "blur of shadows' edges", "composite", "styles of shadows" });
            CHECK(ran({ .abstraction = 0.08f }, false, 0.5f).contains("primary rays"));
        }
    });
}

TEST_CASE("a restyled frame has the bits of a whole one under filters of the image, in a crop, and in memory apart")
{
    onEveryDevice([](const device::Device& device) {
        render::Settings s = settings(render::axisAligned(16));
        s.filters = { render::filterCall("--add-filter", "bloom"),
            render::filterCall("--add-filter", "gaussian:sigma=1,on=direct") };
        s.crop = { 5, 3, 60, 41 };
        render::Options options = renderOptions();
        options.checkLaunches = true;
        render::Renderer renderer(sceneOf({}), device, options), alone(sceneOf({ .inflation = 0.2f }), device, options);
        const std::size_t whole = renderer.render(s).passes.size();
        change(renderer, { .inflation = 0.2f });
        CHECK(renderer.render(s).passes.size() < whole);
        alone.render(s);
        CHECK(sameBits(pixels(renderer, "beauty", s.crop), pixels(alone, "beauty", s.crop)));
    });
}

TEST_CASE("frames run whole where more than knobs changed, or where the frame before was not whole")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(sceneOf({}), device, renderOptions());
        const render::Settings s = settings(render::monteCarlo(4));
        const std::set<std::string> whole = passesOf(renderer.render(s));
        CHECK(whole.contains("primary rays"));
        CHECK(whole.contains("shadows in a style"));
        const auto runsWhole = [&](const char* what, const std::function<void()>& before, const render::Settings& now) {
            CAPTURE(what);
            renderer.render(s);
            before();
            CHECK(passesOf(renderer.render(now)) == whole);
        };
        const Turned turned { .inflation = 0.2f };
        runsWhole(
            "nothing changed", [] {}, s);
        runsWhole(
            "the camera", [&] { renderer.changeScene({}, [](scene::Scene& scene) { scene.camera.eye.x += 0.1f; }); },
            s);
        runsWhole(
            "a light",
            [&] {
                renderer.changeScene({ .lights = true }, [](scene::Scene& scene) {
                    scene.directionalLights[0].direction = { 0, -1, 0 };
                });
            },
            s);
        render::Settings other = s;
        other.seed = 3;
        runsWhole(
            "the seed", [&] { change(renderer, turned); }, other);
        runsWhole(
            "launches over nothing",
            [&] {
                change(renderer, turned);
                renderer.rehearse(s);
            },
            s);
        runsWhole(
            "a frame that was stopped",
            [&] {
                const std::atomic<bool> stop { true };
                renderer.changeScene({}, [](scene::Scene&) {});
                render::Control control;
                control.cancel = &stop;
                renderer.render(s, control);
                change(renderer, turned);
            },
            s);
        // Frames whose numbers are their own.
        render::Settings own = s;
        own.sameNumbers = false;
        own.frame = 1;
        runsWhole(
            "the frame's number", [&] { change(renderer, turned); }, own);
    });
}

TEST_CASE("frames without keys keep nothing, and those with keys say what memory they take")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene plain = sceneOf({});
        for (scene::ShadowStyle& each : plain.directionalLights[0].styles)
            each.keys.clear();
        plain.pointLights[0].styles[0].keys.clear();
        render::Renderer without(plain, device, renderOptions()), with(sceneOf({}), device, renderOptions());
        const render::Settings s = settings(render::monteCarlo(4));
        const std::uint64_t less = without.render(s).memoryBytes, more = with.render(s).memoryBytes;
        CHECK(less < more);
        // As much as some planes of pixels.
        CHECK(more - less < std::uint64_t { 300 } * with.frame().layout.size);
        change(with, { .inflation = 0.2f });
        CHECK(with.render(s).memoryBytes == more);
    });
}
