// Filters of light from beyond the scene, and their samples: means, and errors against plain Monte Carlo.
#include "tests/environment_support.h"
#include "tests/image_means.h"

#include <doctest/doctest.h>

using namespace wedge;
using namespace wedge::test;

namespace {

/// The image of a size of that many plain samples.
std::vector<float> plainly(render::Renderer& renderer, int spp, int size)
{
    render::Settings s = sized(render::monteCarlo(spp), size, size);
    s.seed = 99;
    return renderPixels(renderer, s);
}

} // namespace

TEST_CASE("filters keep the mean")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials[0].specular = glm::vec3(0.2f);
        b.scene.materials[0].exponent = 30.0f;
        b.newObject();
        b.box({ -0.5f, 0, -0.5f }, { 0.5f, 0.6f, 0.0f });
        b.newObject();
        b.sphere({ 0.3f, 0.3f, 0.8f }, 0.3f);
        b.camera({ 0, 1.2f, 3 }, { 0, 0.2f, 0 });
        render::setEnvironment(b.scene, spotted());
        for (const bool lens : { false, true }) {
            CAPTURE(lens);
            b.scene.camera.apertureRadius = lens ? 0.02f : 0.0f;
            render::Renderer renderer(b.scene, device, renderOptions());
            render::Settings filtered = sized(render::axisAligned(64), 48, 48),
                             plain = sized(render::monteCarlo(64), 48, 48);
            filtered.bounces = plain.bounces = 1;
            CHECK(meanOverSeeds(renderer, filtered, 8)
                == doctest::Approx(meanOverSeeds(renderer, plain, 8)).epsilon(0.005));
        }
    });
}

TEST_CASE("with as many samples, filters are ahead of none over matt and curved glossy surfaces")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.newObject();
        scene::Material glossy = b.scene.materials[0];
        glossy.diffuse = glm::vec3(0.1f);
        glossy.specular = glm::vec3(0.6f);
        glossy.exponent = 64;
        b.scene.materials.push_back(glossy);
        b.sphere({ 0, 0.6f, 0 }, 0.6f, 24, 1);
        b.camera({ 0, 0.9f, 2.6f }, { 0, 0.5f, 0 });
        render::setEnvironment(b.scene, spotted());
        render::Renderer renderer(b.scene, device, renderOptions());
        const std::vector<float> expected = plainly(renderer, 4096, 64);
        const auto error = [&](const render::Settings& s) { return rmse(renderPixels(renderer, s), expected); };
        const double filtered = error(sized(render::axisAligned(16), 64, 64)),
                     plain = error(sized(render::monteCarlo(16), 64, 64));
        MESSAGE("RMSE: ", filtered, ", without filter: ", plain);
        CHECK(filtered < plain);
        // What lobes see is shared by nearby pixels where samples do not speak against it, or as far as one asks for.
        render::Settings fixed = sized(render::axisAligned(16), 64, 64), own = sized(render::axisAligned(16), 64, 64);
        fixed.filtering = render::Filtering::Fixed;
        own.environment.lobeWidening = 0;
        CHECK(filtered < error(own));
        for (const render::Settings& s : { sized(render::axisAligned(16), 64, 64), own, fixed }) {
            renderPixels(renderer, s, true);
            REQUIRE(termsOf(renderer) == std::vector<std::string> { "Environment", "EnvironmentGlossy" });
            const float widest = std::ranges::max(widthsOf(renderer, "EnvironmentGlossy"));
            CHECK((widest > 0) == (s.filtering == render::Filtering::Fixed || s.environment.lobeWidening > 0));
            CHECK(std::ranges::max(widthsOf(renderer, "Environment")) > 0);
        }
    });
}

TEST_CASE("what rough lobes see beyond the scene is shared by nearby pixels")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials[0].diffuse = glm::vec3(0.0f);
        b.scene.materials[0].specular = glm::vec3(0.6f);
        b.scene.materials[0].exponent = 10;
        b.newObject();
        b.sphere({ 0, 0.6f, 0 }, 0.6f, 24);
        b.camera({ 0, 0.9f, 2.6f }, { 0, 0.5f, 0 });
        render::setEnvironment(b.scene, spotted());
        render::Renderer renderer(b.scene, device, renderOptions());
        const std::vector<float> expected = plainly(renderer, 4096, 64);
        render::Settings shared = sized(render::axisAligned(16), 64, 64);
        shared.environment.relative = false; // of light itself: fractions of it have less noise before that
        render::Settings own = shared;
        own.environment.lobeWidening = 0;
        const double error = rmse(renderPixels(renderer, shared), expected),
                     before = rmse(renderPixels(renderer, own), expected);
        MESSAGE("RMSE: ", error, ", of pixels' own samples: ", before);
        CHECK(error < 0.8 * before);
    });
}

TEST_CASE("samples of what lies beyond the scene go to where they vary and few pixels share them, as many in the mean")
{
    onEveryDevice([](const device::Device& device) {
        // A floor that is far larger than what stands on it.
        SceneBuilder b = openFloor();
        b.sphere({ 0, 0.25f, 0 }, 0.25f, 24);
        b.camera({ 0, 3, 5 }, { 0, 0, 0 });
        render::setEnvironment(b.scene, spotted());
        render::Renderer renderer(b.scene, device, renderOptions());
        const std::vector<float> expected = plainly(renderer, 4096, 96);
        render::Settings adaptive = sized(render::axisAligned(16), 96, 96), uniform = adaptive;
        uniform.sampling = render::Sampling::Uniform;
        const double before = rmse(renderPixels(renderer, uniform), expected),
                     error = rmse(renderPixels(renderer, adaptive), expected);
        MESSAGE("RMSE: ", error, ", with as many samples everywhere: ", before);
        CHECK(error < 0.85 * before);
        const render::FrameStatistics frame = renderer.render(adaptive, {}, true);
        CHECK(frame.sppMean == doctest::Approx(16).epsilon(0.02));
        std::vector<std::uint32_t> taken = pixels(renderer, renderer.frame().counts("samples"), { 0, 0, 96, 96 });
        std::erase(taken, 0u); // where nothing is seen
        const auto [least, most] = std::ranges::minmax(taken);
        CHECK(least >= 4); // what the analysis begins with, and a quarter of the mean
        CHECK(least <= 8);
        CHECK(most > 32);
    });
}

TEST_CASE("curved surfaces: fractions of the unshadowed light are shared with less error than light is")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.scene.materials[0].diffuse = reflectance;
        b.sphere({ 0, 0, 0 }, 0.5f, 48);
        b.camera({ 0, 0, 3 }, { 0, 0, 0 }, { 0, 1, 0 }, 25);
        auto halves = even(glm::vec3(0.05f), 32, 16);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 12; ++x)
                set(*halves, x, y, sky * 3.0f);
        render::setEnvironment(b.scene, halves);
        render::Renderer renderer(b.scene, device, renderOptions());
        const auto image = [&](const render::Settings& s) { return renderPixels(renderer, s); };
        const std::vector<float> expected = plainly(renderer, 2048, 64);
        const auto errorOf = [&](bool relative, bool fitted) {
            render::Settings settings = sized(render::axisAligned(16), 64, 64);
            settings.environment.relative = relative;
            settings.fitted = fitted;
            return rmse(image(settings), expected);
        };
        const double before = errorOf(false, false), means = errorOf(true, false), lines = errorOf(true, true),
                     linesOfLight = errorOf(false, true);
        MESSAGE("RMSE of means of light: ", before, ", of fractions: ", means, ", of lines of fractions: ", lines,
            ", of light: ", linesOfLight);
        CHECK(means < 0.8 * before);
        CHECK(lines < 0.8 * before);
        CHECK(lines < 0.9 * linesOfLight); // which follow a part of what light does along a curve
        // As published nothing is known of it, and that stays so.
        CHECK_FALSE(render::asPublished().environment.relative);
    });
}
