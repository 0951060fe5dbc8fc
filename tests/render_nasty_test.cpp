// Scenes that a renderer may stumble over: every value that comes out is a number.
#include "tests/render_support.h"

#include <algorithm>
#include <atomic>
#include <functional>

using namespace wedge;
using namespace wedge::test;

namespace {

struct NastyScene {
    std::string name;
    scene::Scene scene;
};

scene::Scene change(const std::function<void(scene::Scene&)>& what)
{
    scene::Scene scene = smallScene();
    what(scene);
    return scene;
}

std::vector<NastyScene> nastyScenes()
{
    std::vector<NastyScene> out;
    SceneBuilder empty;
    out.push_back({ "nothing at all", empty.scene });
    empty.light({ 0, 2, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, scene::LightProfile::Gaussian, 5).visible = true;
    out.push_back({ "a light alone", empty.scene });
    out.push_back({ "no light", change([](scene::Scene& s) { s.areaLights.clear(); }) });
    out.push_back({ "all pixels miss", change([](scene::Scene& s) { s.camera.lookAt = { 0, 9, 4.1f }; }) });
    out.push_back({ "camera on a wall", change([](scene::Scene& s) {
                       s.camera.eye = { -0.7f, 0.5f, 0 };
                       s.camera.lookAt = { -2, 0.4f, 0 };
                   }) });
    out.push_back({ "camera inside a box", change([](scene::Scene& s) { s.camera.eye = { -1, 0.5f, -0.2f }; }) });
    out.push_back({ "camera on the floor", change([](scene::Scene& s) { s.camera.eye = { 0, 0, 3 }; }) });
    out.push_back({ "light in the plane of the floor", change([](scene::Scene& s) { s.areaLights[0].centre.y = 0; }) });
    out.push_back({ "light in the floor, facing up", change([](scene::Scene& s) {
                       s.areaLights[0].centre.y = 0;
                       std::swap(s.areaLights[0].halfU, s.areaLights[0].halfV);
                   }) });
    out.push_back({ "light through the floor", change([](scene::Scene& s) {
                       s.areaLights[0].centre.y = 0;
                       s.areaLights[0].halfU = { 0, 0.5f, 0 };
                       s.areaLights[0].twoSided = true;
                   }) });
    out.push_back({ "light at the camera", change([](scene::Scene& s) {
                       s.areaLights[0].centre = s.camera.eye;
                       s.areaLights[0].visible = true;
                   }) });
    out.push_back({ "light touching a box", change([](scene::Scene& s) {
                       s.areaLights[0].centre = { -0.95f, 0.9f, -0.15f };
                   }) });
    out.push_back({ "light below everything", change([](scene::Scene& s) { s.areaLights[0].centre.y = -3; }) });
    out.push_back({ "tiny and huge lights", change([](scene::Scene& s) {
                       s.areaLights[0].halfU *= 1e-5f;
                       s.areaLights[0].halfV *= 1e-5f;
                       s.areaLights[1].halfU *= 1e3f;
                       s.areaLights[1].halfV *= 1e3f;
                   }) });
    out.push_back({ "sharp gloss and none", change([](scene::Scene& s) {
                       s.materials.push_back(s.materials[0]);
                       s.materials[0].specular = s.materials[1].specular = glm::vec3(0.5f);
                       s.materials[0].exponent = 1e6f;
                       s.materials[1].exponent = 0;
                       s.materials[1].specularModel = scene::SpecularModel::Phong;
                       std::fill(s.geometry.materialIds.begin() + 2, s.geometry.materialIds.begin() + 9, 1u);
                   }) });
    SceneBuilder degenerate;
    degenerate.scene = smallScene();
    degenerate.triangle({ 0, 1, 0 }, { 0, 1, 0 }, { 0, 1, 0 });
    degenerate.triangle({ -1, 1, 0 }, { 0, 1, 0 }, { 1, 1, 0 });
    degenerate.triangle({ -1, 1.2f, 0 }, { 1, 1.2f, 0 }, { 1, 1.2000001f, 0 });
    degenerate.triangle({ -1e6f, -1, -1e6f }, { 1e6f, -1, -1e6f }, { 0, -1, 1e6f });
    out.push_back({ "triangles without area, and an enormous one", degenerate.scene });
    return out;
}

void checkFinite(render::Renderer& renderer, const render::Settings& settings)
{
    renderer.render(settings, {}, true);
    const image::Window all { 0, 0, settings.width, settings.height };
    for (const std::string name : { "beauty", "direct", "directNoisy", "position", "normal", "albedo", "emission" }) {
        CAPTURE(name);
        const std::vector<float> values = pixels(renderer, name, all);
        CHECK(notFinite(values) == 0);
        if (name == "beauty")
            CHECK(std::ranges::all_of(values, [](float v) { return v >= 0; }));
    }
    for (const std::string& term : termsOf(renderer))
        CHECK(notFinite(widthsOf(renderer, term)) == 0);
}

} // namespace

TEST_CASE("no scene makes NaN, infinity or negative light, with any method")
{
    onEveryDevice([](const device::Device& device) {
        for (const NastyScene& nasty : nastyScenes()) {
            CAPTURE(nasty.name);
            render::Renderer renderer(nasty.scene, device, renderOptions());
            for (const std::pair<int, int>& size : { std::pair(1, 1), { 33, 25 } })
                for (const render::Settings& settings :
                    { render::monteCarlo(3), render::axisAligned(16), render::asPublished() }) {
                    CAPTURE(size.first);
                    CAPTURE(methodName(settings.method));
                    checkFinite(renderer, sized(settings, size.first, size.second));
                }
        }
    });
}

TEST_CASE("a tile of pixels whose demand is infinite wants no more than a wave has room for")
{
    // Squares of such radiances overflow, and means do not: of pixels that edges cut in two the variance is infinite.
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.background = glm::vec3(3e19f);
        render::Renderer renderer(scene, device, renderOptions());
        for (const bool progressive : { false, true }) {
            render::Settings settings = sized(render::axisAligned(16), 8, 8);
            settings.antialias = true;
            settings.bounces = 0;
            std::uint64_t samples = 0;
            if (progressive) {
                settings.progressive = true;
                settings.spp = 64;
                samples = renderer.renderProgressively(settings, {}, {}).primaryRays;
            } else {
                samples = renderer.render(settings).primaryRays;
            }
            CAPTURE(samples);
            CHECK(samples > 8 * 8 * 8);
            CHECK(samples < 8 * 8 * 1024);
        }
    });
}

TEST_CASE("every combination of the ablations gives an image")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = smallScene();
        render::Renderer renderer(scene, device, renderOptions());
        for (const bool published : { false, true })
            for (const render::Sampling sampling : { render::Sampling::Uniform, render::Sampling::Adaptive })
                for (const render::Filtering filtering :
                    { render::Filtering::None, render::Filtering::Fixed, render::Filtering::Adaptive })
                    for (const render::Shading shading :
                        { render::Shading::Separate, render::Shading::Inside, render::Shading::Ratio }) {
                        render::Settings settings = published ? render::asPublished() : render::axisAligned(12);
                        settings.sampling = sampling;
                        settings.filtering = filtering;
                        settings.shading = shading;
                        if (shading == render::Shading::Inside)
                            settings.counts = render::Counts::Spectrum;
                        checkFinite(renderer, sized(settings, 20, 15));
                    }
    });
}

TEST_CASE("a render that is told to stop at once still leaves an image of numbers")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = smallScene();
        render::Renderer renderer(scene, device, renderOptions());
        const std::atomic<bool> stop { true };
        for (const render::Settings& settings : { render::monteCarlo(300), render::axisAligned(300) }) {
            render::Control control;
            control.cancel = &stop;
            renderer.queue().setTargetMilliseconds(0.05);
            const render::FrameStatistics s = renderer.render(sized(settings, 200, 150), control);
            CHECK_FALSE(s.complete);
            CHECK(notFinite(pixels(renderer, "beauty", { 0, 0, 200, 150 })) == 0);
        }
    });
}
