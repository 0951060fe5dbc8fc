// Frames whose whole light is looked up by normals: against that of the map's parts.
#include "tests/image_means.h"
#include "tests/shadow_frames.h"

#include <doctest/doctest.h>

#include <atomic>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

/// By how much a frame's light is off that of the map's parts, of the mean.
double offBy(const device::Device& device, const scene::Scene& scene)
{
    render::Renderer renderer(scene, device, renderOptions());
    const std::vector<float> map = renderPixels(renderer, with(Shadows::Ratio)),
                             cache = renderPixels(renderer, with(Shadows::Ratio, 30, WholeLight::Cache));
    CHECK(notFinite(cache) == 0);
    CHECK_FALSE(sameBits(map, cache));
    return rmse(cache, map) / meanOf(map, 1).value;
}

/// As far away as many times, and as large in the image.
scene::Scene farther(scene::Scene scene, float times)
{
    scene::Camera& c = scene.camera;
    c.eye = c.lookAt + times * (c.eye - c.lookAt);
    c.verticalFov = glm::degrees(2 * std::atan(std::tan(glm::radians(c.verticalFov) / 2) / times));
    return scene;
}

} // namespace

TEST_CASE("matt surfaces have the light of the map's parts but for what lies between texels")
{
    onEveryDevice([](const device::Device& device) { CHECK(offBy(device, things(spotted())) < 0.002); });
}

TEST_CASE("lobes are as far off as their views differ from the middle one")
{
    onEveryDevice([](const device::Device& device) {
        using scene::SpecularModel;
        struct Lobe {
            SpecularModel model;
            float exponent;
        };
        for (const Lobe& lobe : { Lobe { SpecularModel::Phong, 20 }, Lobe { SpecularModel::BlinnPhong, 40 },
                 Lobe { SpecularModel::Ggx, 1 } }) {
            CAPTURE(lobe.exponent);
            const scene::Scene scene = things(spotted(), 0.4f, lobe.exponent, lobe.model);
            const double nearby = offBy(device, scene), distant = offBy(device, farther(scene, 60));
            CAPTURE(nearby);
            CAPTURE(distant);
            CHECK(distant < 0.01);
            CHECK(nearby > 4 * distant);
            CHECK(nearby < 1);
        }
    });
}

TEST_CASE("crops have the bits of the whole, of all ways and scales, whatever lay in the memory")
{
    onEveryDevice([](const device::Device& device) {
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        const scene::Scene scene = things(spotted(), 0.3f, 1, scene::SpecularModel::Ggx);
        render::Renderer renderer(scene, device, renderOptions()), other(scene, device, poisoned);
        const image::Window crop { 7, 5, 31, 22 };
        for (const Shadows shadows : { Shadows::Subtractive, Shadows::Ratio })
            for (const int blockSide : { 1, 4 }) {
                CAPTURE(blockSide);
                render::Settings s = with(shadows, 30, WholeLight::Cache);
                s.environment.shadows.blockSide = blockSide;
                renderPixels(renderer, s);
                const std::vector<float> whole = pixels(renderer, "beauty", crop);
                s.crop = crop;
                other.render(s);
                const std::vector<float> part = pixels(other, "beauty", crop);
                CHECK(notFinite(part) == 0);
                CHECK(sameBits(whole, part));
            }
    });
}

TEST_CASE("tables are made anew where the camera turns")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = things(spotted(), 0.3f);
        const render::Settings s = with(Shadows::Ratio, 30, WholeLight::Cache);
        scene::Scene aside = scene;
        aside.camera.lookAt.x += 0.5f;
        render::Renderer renderer(scene, device, renderOptions()), fresh(aside, device, renderOptions());
        const std::vector<float> before = renderPixels(renderer, s);
        renderer.changeScene({}, [&](scene::Scene& changed) { changed.camera = aside.camera; });
        const std::vector<float> after = renderPixels(renderer, s);
        CHECK(sameBits(after, renderPixels(fresh, s)));
        CHECK_FALSE(sameBits(after, before));
    });
}

TEST_CASE("where nothing is hidden all ways have the bits of what was looked up")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(openGloss(spotted(), scene::SpecularModel::Phong, 60), device, renderOptions());
        const std::vector<float> ratio = renderPixels(renderer, with(Shadows::Ratio, 30, WholeLight::Cache));
        CHECK(sameBits(ratio, renderPixels(renderer, with(Shadows::Subtractive, 7, WholeLight::Cache))));
    });
}

TEST_CASE("a frame that is stopped while it fills tables has finite light")
{
    onEveryDevice([](const device::Device& device) {
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        render::Renderer renderer(things(spotted(), 0.3f), device, poisoned);
        for (const double share : { 0.0, 0.2, 0.5, 0.9 }) {
            std::atomic<bool> stop = false;
            render::Control control;
            control.cancel = &stop;
            control.progress = [&](double done) { stop = stop || done >= share; };
            renderer.render(with(Shadows::Ratio, 100, WholeLight::Cache), control);
            CHECK(notFinite(pixels(renderer, "beauty", { 0, 0, width, height })) == 0);
        }
    });
}
