// Whole frames whose filters are narrower than their samples ask for: they have to widen, and only there.
#include "tests/lens_support.h"
#include "tests/render_support.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 96, height = 72;

/// narrow: filters are so by far; widens: they are compared with wider ones.
render::Settings settingsOf(bool narrow, bool widens, int bounces, bool antialias)
{
    render::Settings s = sized(narrow ? render::axisAligned(28, 60.0f) : render::axisAligned(28), width, height);
    s.bounces = bounces;
    s.antialias = antialias;
    if (!widens)
        s.widening = 0;
    return s;
}

/// A ground in the wide penumbra of a panel.
scene::Scene penumbra()
{
    SceneBuilder b;
    b.newObject();
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
    b.newObject();
    b.quad({ 0, 1.5f, 0 }, { 0.7f, 0, 0 }, { 0, 0, 0.7f });
    b.light({ 0, 3, 0 }, { 0.5f, 0, 0 }, { 0, 0, 0.5f }, scene::LightProfile::Gaussian, 20).radiance = { 20, 18, 15 };
    b.camera({ 0, 1.2f, 2.8f }, { 0, 0.1f, 0.4f });
    return b.scene;
}

/// Errors without and with widening.
std::pair<double, double> errorsOf(
    const scene::Scene& scene, const device::Device& device, bool narrow, int bounces, bool antialias)
{
    render::Renderer renderer(scene, device, renderOptions());
    render::Settings truth = sized(render::monteCarlo(2048), width, height);
    truth.bounces = bounces;
    truth.antialias = antialias;
    const std::vector<float> reference = renderPixels(renderer, truth);
    const auto error = [&](bool widens) {
        return rmse(renderPixels(renderer, settingsOf(narrow, widens, bounces, antialias)), reference);
    };
    return { error(false), error(true) };
}

} // namespace

TEST_CASE("filters that are narrower than need be widen, and edges of shadows stay")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool antialias : { false, true })
            for (const int bounces : { 0, 1 }) {
                CAPTURE(antialias);
                CAPTURE(bounces);
                const auto blurred = errorsOf(penumbra(), device, true, bounces, antialias);
                const double narrow = blurred.first, widened = blurred.second;
                CAPTURE(narrow);
                CAPTURE(widened);
                CHECK(widened < 0.9 * narrow);
                const auto sharp = errorsOf(smallScene(), device, false, bounces, antialias);
                const double usual = sharp.first, also = sharp.second;
                CAPTURE(usual);
                CAPTURE(also);
                CHECK(also < 1.03 * usual);
            }
    });
}

namespace {

enum class Camera { Pinhole, Antialiased, Lens, Shutter };

/// What is blurred is so over more pixels than terms' filters reach.
scene::Scene sceneOf(Camera camera)
{
    scene::Scene scene = smallScene();
    if (camera == Camera::Lens) {
        scene.camera.apertureRadius = 0.6f;
        scene.camera.focusDistance = 1.2f;
    }
    if (camera == Camera::Shutter)
        displace(scene, { 0.2f, 0, 1.2f });
    return scene;
}

} // namespace

TEST_CASE("a crop whose filters widen has the whole image's pixels")
{
    onEveryDevice([](const device::Device& device) {
        for (const Camera camera : { Camera::Pinhole, Camera::Antialiased, Camera::Lens, Camera::Shutter }) {
            const scene::Scene scene = sceneOf(camera);
            render::Renderer renderer(scene, device, renderOptions());
            for (const int bounces : { 0, 1 }) {
                CAPTURE(static_cast<int>(camera));
                CAPTURE(bounces);
                render::Settings settings = settingsOf(true, true, bounces, camera == Camera::Antialiased);
                // Reaches are to end within the image.
                settings.maxRadius = 8;
                renderer.render(settings);
                const image::Window crop { 42, 31, 57, 44 };
                const std::vector<float> whole = pixels(renderer, "beauty", crop);
                // What another image leaves in the buffers is not to be mistaken for what is around the crop.
                settings.seed = 77;
                renderer.render(settings);
                settings.seed = render::Settings {}.seed;
                settings.crop = crop;
                renderer.render(settings);
                CHECK(pixels(renderer, "beauty", crop) == whole);
            }
        }
    });
}
