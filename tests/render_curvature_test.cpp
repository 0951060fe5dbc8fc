// Frames whose environment light is filtered by curvature: means, widths, and what they are compared with.
#include "tests/environment_support.h"
#include "tests/image_means.h"

#include <doctest/doctest.h>

using namespace wedge;
using namespace wedge::test;

namespace {

/// The environment's widths, the mean of both axes, metres.
Planes<float> widthsOf(render::Renderer& renderer, const render::Settings& settings)
{
    renderPixels(renderer, settings, true);
    return planesOf(renderer.frame().layout, test::widthsOf(renderer, termsOf(renderer).at(0)));
}

} // namespace

TEST_CASE("as published: an even environment over an open floor comes out as it is")
{
    // E = pi L, at 16 samples a pixel, whatever counts of other terms would be.
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        render::Renderer renderer(b.scene, device, renderOptions());
        const render::Settings s = sized(render::asPublished(), 24, 24);
        checkMean(renderPixels(renderer, s), sky * reflectance, 0.01);
        const render::FrameStatistics frame = renderer.render(s);
        CHECK(frame.sppMean == doctest::Approx(16));
        // Of each sample a ray to what was chosen by brightness, and one reflected: there is no pass after the first.
        CHECK(frame.shadowRays + frame.indirectRays >= 16 * frame.shadedPixels);
        CHECK(frame.shadowRays + frame.indirectRays <= 2 * 16 * frame.shadedPixels);
    });
}

TEST_CASE("as published: antialiased pixels take four primary samples and four of the environment of each")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials[0].specular = glm::vec3(0.2f);
        b.scene.materials[0].exponent = 30.0f;
        b.newObject();
        b.box({ -0.5f, 0, -0.5f }, { 0.5f, 0.6f, 0.0f });
        render::setEnvironment(b.scene, spotted());
        render::Renderer renderer(b.scene, device, renderOptions());
        render::Settings published = sized(render::asPublished(), 40, 24),
                         plain = sized(render::monteCarlo(64), 40, 24);
        published.antialias = plain.antialias = true;
        const render::FrameStatistics frame = renderer.render(published);
        CHECK(frame.primarySpp == 4);
        CHECK(frame.sppMean == 16);
        const double expected = meanOverSeeds(renderer, plain, 8), found = meanOverSeeds(renderer, published, 8);
        MESSAGE("mean over plain Monte Carlo's: ", found / expected);
        CHECK(found == doctest::Approx(expected).epsilon(0.01));
        // What else lights the scene, or blurs it, has chapter 5's counts, and so has all of the frame.
        published.bounces = 1;
        CHECK(renderer.render(published).primarySpp >= 16);
        published.bounces = 0;
        b.scene.camera.apertureRadius = 0.02f;
        render::Renderer lens(b.scene, device, renderOptions());
        CHECK(lens.render(published).primarySpp >= 16);
    });
}

TEST_CASE("as published: filters keep the mean but for what widths take from samples")
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
        render::Renderer renderer(b.scene, device, renderOptions());
        const render::Settings plain = sized(render::monteCarlo(64), 48, 48),
                               published = sized(render::asPublished(), 48, 48);
        const double expected = meanOverSeeds(renderer, plain, 8), found = meanOverSeeds(renderer, published, 8);
        MESSAGE("mean over plain Monte Carlo's: ", found / expected);
        CHECK(found == doctest::Approx(expected).epsilon(0.01));
    });
}

TEST_CASE("corrected constants: means are kept, and errors are less than as published and without filters")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.newObject();
        b.sphere({ 0, 0.4f, 0 }, 0.4f, 32);
        b.camera({ 0, 1.2f, 2.6f }, { 0, 0.3f, 0 });
        render::setEnvironment(b.scene, spotted());
        render::Renderer renderer(b.scene, device, renderOptions());
        render::Settings corrected = sized(render::axisAligned(16), 64, 64);
        corrected.environment.widths = render::EnvironmentWidths::Corrected;
        const render::Settings plain = sized(render::monteCarlo(16), 64, 64),
                               published = sized(render::asPublished(), 64, 64);
        render::Settings reference = sized(render::monteCarlo(2048), 64, 64);
        reference.seed = 99;
        const std::vector<float> expected = renderPixels(renderer, reference);
        const auto errorOf = [&](const render::Settings& s) { return rmse(renderPixels(renderer, s), expected); };
        const double ours = errorOf(corrected);
        MESSAGE("RMSE: ", ours, ", as published: ", errorOf(published), ", without filter: ", errorOf(plain));
        CHECK(ours < 0.8 * errorOf(published));
        CHECK(ours < 0.6 * errorOf(plain));
        CHECK(
            meanOverSeeds(renderer, corrected, 8) == doctest::Approx(meanOverSeeds(renderer, plain, 8)).epsilon(0.005));
    });
}

TEST_CASE("as published: before a wall widths follow from its distance")
{
    // An endless wall at distance d is r = d / (sin theta cos phi) away: r / cos theta is 2 d or more.
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.newObject();
        b.quad({ -1, 500, 0 }, { 0, 500, 0 }, { 0, 0, 1000 });
        render::Renderer renderer(b.scene, device, renderOptions());
        const Planes<float> widths = widthsOf(renderer, sized(render::asPublished(), 24, 24));
        double sum = 0;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                const double distance = 1 + 2 * std::tan(std::acos(-1.0) / 9) * ((x + 0.5) / 12 - 1);
                // (r / cos theta) / (2 (B_f + B_e)); B_e of an even map is 0.
                const double ratio = widths.at(x, y) / distance;
                REQUIRE(ratio >= 0.999);
                sum += ratio / (24 * 24);
            }
        CHECK(sum < 1.3); // the least of some sixteen
    });
}

TEST_CASE("as published: what is seen of a cylinder is filtered along it and not across")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.scene.materials[0].diffuse = reflectance;
        // Smooth normals: a sphere that is pulled out along y.
        b.sphere({ 0, 0, 0 }, 0.5f, 64);
        for (std::size_t i = 1; i < b.scene.geometry.positions.size(); i += 3) {
            b.scene.geometry.positions[i] *= 1000.0f;
            b.scene.geometry.normals[i] /= 1000.0f;
        }
        for (std::size_t i = 0; i < b.scene.geometry.normals.size(); i += 3) {
            float* n = b.scene.geometry.normals.data() + i;
            const float length = std::hypot(n[0], n[1], n[2]);
            for (int k = 0; k < 3; ++k)
                n[k] /= std::max(length, 1e-20f);
        }
        b.camera({ 0, 0, 3 }, { 0, 0, 0 }, { 0, 1, 0 }, 10);
        render::setEnvironment(b.scene, even(sky));
        render::Renderer renderer(b.scene, device, renderOptions());
        render::Settings published = sized(render::asPublished(), 33, 33);
        const double size = 2.5 * 2 * std::tan(5 * std::acos(-1.0) / 180) / 33;
        // Across it 1 / (2 kappa), kappa = 2 / m, by (6.19) half of that; along it as far as filters reach.
        for (const auto widths : { render::EnvironmentWidths::Curvature, render::EnvironmentWidths::LightTransport }) {
            published.environment.widths = widths;
            const double across = widths == render::EnvironmentWidths::Curvature ? 0.25 : 0.125;
            CHECK(widthsOf(renderer, published).at(16, 16)
                == doctest::Approx(0.5 * (across + 1000 * size)).epsilon(0.003));
        }
    });
}
