// Lights that the camera sees: what pixels receive from them is known without sampling, where nothing is before them.
#include "tests/render_support.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 48, height = 32;

/// A bright light, turned, before a black wall.
SceneBuilder lightAlone(scene::LightProfile profile, float size)
{
    SceneBuilder b;
    b.scene.materials[0].diffuse = glm::vec3(0);
    b.newObject();
    b.quad({ 0, 0, -1 }, { 9, 0, 0 }, { 0, 9, 0 });
    b.light(
         { 0.13f, 0.07f, 0 }, size * glm::vec3(0.8f, 0.3f, 0.1f), size * glm::vec3(-0.2f, 0.7f, -0.2f), profile, 1000)
        .visible = true;
    b.scene.areaLights[0].twoSided = true;
    b.camera({ 0.2f, 0.1f, 4 }, { 0, 0, 0 });
    return b;
}

render::Settings frame(render::Settings settings, bool antialias = true)
{
    settings = sized(settings, width, height);
    settings.antialias = antialias;
    return settings;
}

/// The sum of all pixels, the mean of several seeds, and its standard error.
struct Brightness {
    double mean, error;
};

Brightness brightness(render::Renderer& renderer, render::Settings settings, int seeds)
{
    double sum = 0, squares = 0;
    for (int k = 0; k < seeds; ++k) {
        settings.seed = static_cast<std::uint32_t>(k + 1);
        double of = 0;
        for (const float v : renderPixels(renderer, settings))
            of += v;
        sum += of;
        squares += of * of;
    }
    const double mean = sum / seeds;
    return { mean, std::sqrt(std::max(squares / seeds - mean * mean, 0.0) / (seeds - 1)) };
}

} // namespace

TEST_CASE("edges of lights that the camera sees have next to no noise")
{
    onEveryDevice([](const device::Device& device) {
        struct Kind {
            scene::LightProfile profile;
            float size, aperture;
            bool antialias;
            double noise; ///< of that of plain sampling, at most
        };
        using enum scene::LightProfile;
        for (const Kind& kind : { Kind { Uniform, 1, 0, true, 0.02 }, { Uniform, 0.02f, 0, true, 0.02 },
                 { Gaussian, 0.02f, 0, true, 0.15 }, { Uniform, 1, 0.02f, true, 0.05 }, { Uniform, 1, 0.2f, true, 0.1 },
                 { Uniform, 1, 0.2f, false, 0.05 }, { Uniform, 0.02f, 0.2f, false, 0.05 },
                 { Gaussian, 0.05f, 0.2f, false, 0.1 }, { Gaussian, 0.05f, 0.02f, true, 0.1 } }) {
            CAPTURE(kind.size);
            CAPTURE(kind.aperture);
            CAPTURE(kind.antialias);
            SceneBuilder b = lightAlone(kind.profile, kind.size);
            b.scene.camera.apertureRadius = kind.aperture;
            b.scene.camera.focusDistance = 5;
            render::Renderer renderer(b.scene, device, renderOptions());
            render::Settings truth = frame(render::monteCarlo(4096), kind.antialias);
            const std::vector<float> reference = renderPixels(renderer, truth);
            truth.seed = 2;
            const double ofReference = rmse(renderPixels(renderer, truth), reference) / std::sqrt(2.0);
            render::Settings ours = frame(render::axisAligned(16), kind.antialias);
            ours.distributed.blur = false; // nor by the lens' filter
            const double off = rmse(renderPixels(renderer, ours), reference);
            const double plain = rmse(renderPixels(renderer, frame(render::monteCarlo(16), kind.antialias)), reference);
            CAPTURE(off);
            CAPTURE(plain);
            CAPTURE(ofReference);
            CHECK(off < kind.noise * plain + 2 * ofReference);
        }
    });
}

TEST_CASE("images of lights become right with many samples, whatever was known of few")
{
    // Of a uniform light before a pinhole it is exact, of others nothing is taken for known then.
    onEveryDevice([](const device::Device& device) {
        struct Kind {
            scene::LightProfile profile;
            float size, aperture;
            render::PixelFilter filter;
            bool oneSided, progressive;
        };
        using enum scene::LightProfile;
        constexpr auto box = render::PixelFilter::Box, wide = render::PixelFilter::BlackmanHarris;
        for (const Kind& kind : { Kind { Uniform, 1, 0, box, false, false }, { Gaussian, 0.1f, 0, box, false, false },
                 { Uniform, 1, 0.05f, box, false, false }, { Uniform, 1, 0, wide, false, false },
                 { Uniform, 1, 0.05f, box, true, false }, { Gaussian, 0.1f, 0, box, false, true } }) {
            CAPTURE(static_cast<int>(kind.profile));
            CAPTURE(kind.aperture);
            CAPTURE(kind.oneSided);
            CAPTURE(kind.progressive);
            SceneBuilder b = lightAlone(kind.profile, kind.size);
            b.scene.areaLights[0].twoSided = !kind.oneSided;
            b.scene.camera.apertureRadius = kind.aperture;
            b.scene.camera.focusDistance = 5;
            render::Renderer renderer(b.scene, device, renderOptions());
            render::Settings truth = frame(render::monteCarlo(4096)), ours = frame(render::axisAligned(512));
            truth.pixelFilter = ours.pixelFilter = kind.filter;
            ours.distributed.blur = false;
            ours.progressive = kind.progressive;
            const std::vector<float> reference = renderPixels(renderer, truth);
            render::Settings plain = truth;
            plain.spp = 512;
            plain.seed = 2;
            const double off = rmse(renderPixels(renderer, ours), reference);
            const double ofPlain = rmse(renderPixels(renderer, plain), reference);
            CAPTURE(off);
            CAPTURE(ofPlain);
            // Halves have half the samples each of a sequence: less even than strata of all.
            CHECK(off < (kind.progressive ? 1.4 : 1.0) * ofPlain);
        }
    });
}

TEST_CASE("a light that half of the lens sees from behind is as bright as plain sampling finds it")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = lightAlone(scene::LightProfile::Uniform, 1);
        scene::AreaLight& light = b.scene.areaLights[0];
        light.twoSided = false;
        // All but edge-on: its plane goes through the lens.
        light.centre = { 0.2f, 0.1f, 0 };
        light.halfU = { 0.0025f, 0, 1 };
        light.halfV = { 0, 0.5f, 0 };
        b.scene.camera.apertureRadius = 0.05f;
        b.scene.camera.focusDistance = 5;
        render::Renderer renderer(b.scene, device, renderOptions());
        const Brightness plain = brightness(renderer, frame(render::monteCarlo(1024)), 8);
        const Brightness ours = brightness(renderer, frame(render::axisAligned(16)), 32);
        CAPTURE(plain.mean);
        CAPTURE(plain.error);
        CAPTURE(ours.mean);
        CAPTURE(ours.error);
        REQUIRE(plain.mean > 50);
        CHECK(std::fabs(ours.mean - plain.mean) < 3.5 * std::hypot(plain.error, ours.error));
    });
}

TEST_CASE("lights that something is before, in part, are as bright as plain sampling finds them")
{
    onEveryDevice([](const device::Device& device) {
        // Twigs, thinner than what the rays that try the way are apart; a second light behind the first.
        SceneBuilder b = lightAlone(scene::LightProfile::Uniform, 0.5f);
        b.newObject();
        for (int k = 0; k < 9; ++k) {
            const float x = -0.5f + 0.11f * static_cast<float>(k);
            b.box({ x, -1, 1 }, { x + 0.012f, 1, 1.01f });
        }
        b.light({ 0.4f, 0.4f, -0.5f }, { 0.4f, 0, 0 }, { 0, 0.4f, 0 }, scene::LightProfile::Uniform, 300).visible =
            true;
        for (const float aperture : { 0.0f, 0.1f }) {
            CAPTURE(aperture);
            b.scene.camera.apertureRadius = aperture;
            b.scene.camera.focusDistance = 5;
            render::Renderer renderer(b.scene, device, renderOptions());
            const Brightness plain = brightness(renderer, frame(render::monteCarlo(1024)), 4);
            const Brightness ours = brightness(renderer, frame(render::axisAligned(16)), 32);
            CAPTURE(plain.mean);
            CAPTURE(plain.error);
            CAPTURE(ours.mean);
            CAPTURE(ours.error);
            CHECK(std::fabs(ours.mean - plain.mean) < 3.5 * std::hypot(plain.error, ours.error) + 1e-4 * plain.mean);
        }
    });
}

TEST_CASE("what is concluded wrongly about lights costs samples and no light")
{
    onEveryDevice([](const device::Device& device) {
        // Kernels that take every light for one that nothing is before.
        const TemporaryFolder folder;
        const std::filesystem::path from = kernelDir().empty() ? WEDGE_KERNELS : kernelDir(), to = folder.path() / "k";
        std::filesystem::copy(from, to, std::filesystem::copy_options::recursive);
        const std::filesystem::path file = to / "waves" / "seen_lights.cl";
        std::stringstream text;
        text << std::ifstream(file).rdbuf();
        std::string source = text.str();
        const std::string doubt = "                return false;\n";
        REQUIRE(source.find(doubt) != std::string::npos);
        source.erase(source.find(doubt), doubt.size());
        std::ofstream(file) << source;

        SceneBuilder b = lightAlone(scene::LightProfile::Uniform, 0.05f);
        b.newObject();
        b.quad({ 0.1f, 0.08f, 1 }, { 0.01f, 0.02f, 0 }, { -0.3f, 0.3f, 0 });
        b.light({ 0.1f, 0, -0.5f }, { 0.2f, 0, 0 }, { 0, 0.2f, 0 }, scene::LightProfile::Uniform, 300).visible = true;
        render::Renderer right(b.scene, device, renderOptions());
        render::Options options = renderOptions();
        options.kernelDir = to.string();
        render::Renderer wrong(b.scene, device, options);
        const Brightness plain = brightness(right, frame(render::monteCarlo(4096)), 8);
        const Brightness ours = brightness(wrong, frame(render::axisAligned(16)), 64);
        CAPTURE(plain.mean);
        CAPTURE(plain.error);
        CAPTURE(ours.mean);
        CAPTURE(ours.error);
        CHECK(std::fabs(ours.mean - plain.mean) < 3.5 * std::hypot(plain.error, ours.error));
        CHECK(ours.error < 0.01 * plain.mean); // or it would show nothing
    });
}

TEST_CASE("lights that are hidden leave no trace in the image")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = lightAlone(scene::LightProfile::Uniform, 0.5f);
        b.quad({ 0, 0, 1 }, { 2, 0, 0 }, { 0, 2, 0 });
        for (const bool visible : { true, false }) {
            b.scene.areaLights[0].visible = visible;
            render::Renderer renderer(b.scene, device, renderOptions());
            for (const float v : renderPixels(renderer, frame(render::axisAligned(16))))
                CHECK(v == 0);
        }
    });
}

TEST_CASE("a light from beside the camera to before it hides no other")
{
    onEveryDevice([](const device::Device& device) {
        // It crosses the plane of the lens, outside of the picture, and its share of pixels is not worked out.
        SceneBuilder b = lightAlone(scene::LightProfile::Uniform, 1);
        b.light({ 3, 0, 4 }, { 0.1f, 0, 0 }, { 0, 0, 3 }, scene::LightProfile::Uniform, 5).visible = true;
        render::Renderer renderer(b.scene, device, renderOptions());
        const std::vector<float> reference = renderPixels(renderer, frame(render::monteCarlo(4096)));
        CHECK(rmse(renderPixels(renderer, frame(render::axisAligned(16))), reference) < 1);
        // And here in the picture.
        b.scene.areaLights[1].centre = { 0.6f, 0.1f, 4 };
        render::Renderer close(b.scene, device, renderOptions());
        const Brightness plain = brightness(close, frame(render::monteCarlo(1024)), 4);
        const Brightness ours = brightness(close, frame(render::axisAligned(16)), 16);
        CHECK(std::fabs(ours.mean - plain.mean) < 3.5 * std::hypot(plain.error, ours.error) + 1e-4 * plain.mean);
    });
}
