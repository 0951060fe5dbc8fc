// Frames whose directions beyond the scene are chosen among pre-computed samples, against frames whose are chosen each
// by the map.
#include "tests/environment_support.h"

#include <doctest/doctest.h>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int size = 24;
constexpr int frames = 32;

/// Boxes on a glossy floor, under a sky with a spot, so that there are penumbras, lobes and light from all sides.
SceneBuilder boxes()
{
    SceneBuilder b = openFloor();
    b.scene.materials[0].specular = glm::vec3(0.3f);
    b.scene.materials[0].exponent = 20.0f;
    b.box({ -0.5f, 0, -0.5f }, { 0.5f, 0.6f, 0.0f });
    b.box({ 0.5f, 0.3f, 0.1f }, { 0.8f, 0.5f, 0.6f });
    b.camera({ 0, 1.2f, 3 }, { 0, 0.2f, 0 });
    render::setEnvironment(b.scene, spotted());
    return b;
}

render::Settings with(render::Settings settings, render::EnvironmentSampling sampling)
{
    settings.environment.sampling = sampling;
    return settings;
}

/// How far the means of frames by pre-computed samples are from those by the map, over pixels.
struct Difference {
    std::size_t pixels = 0; ///< of which some frames differ
    std::size_t far = 0; ///< of those, farther than 3 deviations
    double squares = 0; ///< over deviations, mean
    double rms = 0; ///< of all pixels, a radiance
};

/// Green, of one frame of each kind for each seed.
Difference difference(render::Renderer& renderer, render::Settings settings)
{
    std::vector<double> mean, squares;
    for (settings.seed = 0; settings.seed < frames; ++settings.seed) {
        const std::vector<float> exact = renderPixels(renderer, with(settings, render::EnvironmentSampling::Map));
        const std::vector<float> other =
            renderPixels(renderer, with(settings, render::EnvironmentSampling::Precomputed));
        REQUIRE(notFinite(exact) + notFinite(other) == 0);
        mean.resize(exact.size() / 3);
        squares.resize(mean.size());
        for (std::size_t i = 0; i < mean.size(); ++i) {
            const double off = double { other[3 * i + 1] } - exact[3 * i + 1], added = off - mean[i];
            mean[i] += added / (settings.seed + 1);
            squares[i] += added * (off - mean[i]);
        }
    }
    Difference d;
    for (std::size_t i = 0; i < mean.size(); ++i) {
        const double square = mean[i] * mean[i], variance = squares[i] / (frames - 1) / frames;
        d.rms += square / static_cast<double>(mean.size());
        if (variance > 0) { // not so of the sky, which the camera sees the same
            ++d.pixels;
            d.far += square > 9 * variance ? 1 : 0;
            d.squares += square / variance;
        }
    }
    d.squares /= static_cast<double>(d.pixels);
    d.rms = std::sqrt(d.rms);
    return d;
}

/// Differences of pairs of frames, one pair a seed. Over their deviations, which are estimated from them, their means
/// have Student's distribution with 31 degrees of freedom if nothing is biased: 0.0053 are farther than 3, and the
/// mean square is 1.07 with a deviation of 1.6. Five deviations of pixels' mean are allowed, as if pixels were
/// independent.
void checkUnbiased(render::Renderer& renderer, const render::Settings& settings)
{
    const Difference d = difference(renderer, settings);
    const auto n = static_cast<double>(d.pixels);
    MESSAGE("RMS difference " << d.rms << ", beyond 3 deviations " << d.far << " of " << d.pixels
                              << " pixels, mean square " << d.squares);
    CHECK(n > 0.5 * size * size);
    CHECK(static_cast<double>(d.far) < 0.0053 * n + 5 * std::sqrt(0.0053 * n));
    CHECK(d.squares < 1.07 + 5 * 1.6 / std::sqrt(n));
}

} // namespace

TEST_CASE("no pixel's mean over 4096 samples tells pre-computed samples from those of the map")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = boxes();
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const render::LightSampling techniques : { render::LightSampling::Both, render::LightSampling::Lights })
            for (const int bounces : { 0, 1 }) {
                CAPTURE(static_cast<int>(techniques));
                CAPTURE(bounces);
                render::Settings s = sized(render::monteCarlo(4096 / frames), size, size);
                s.lightSampling = techniques;
                s.bounces = bounces;
                checkUnbiased(renderer, s);
            }
    });
}

TEST_CASE("nor in frames of pixels that have several receivers, or behind mirrors")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = boxes();
        b.scene.materials.push_back(b.scene.materials[0]);
        b.scene.materials[1].specularModel = scene::SpecularModel::Mirror;
        b.scene.materials[1].specular = glm::vec3(0.9f);
        b.quad({ 0, 0.5f, -0.8f }, { 1.5f, 0, 0 }, { 0, 0.5f, 0 }, 1);
        render::Renderer renderer(b.scene, device, renderOptions());
        render::Settings s = sized(render::monteCarlo(16), size, size);
        s.lightSampling = render::LightSampling::Lights;
        for (const bool antialias : { false, true }) {
            CAPTURE(antialias);
            s.antialias = antialias;
            checkUnbiased(renderer, s);
        }
    });
}

TEST_CASE("each frame has samples of its own, and a crop has the whole image's")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = boxes();
        render::Renderer renderer(b.scene, device, renderOptions());
        // As many as there are: a Sobol sequence takes each once in every pixel, so that nothing else is random.
        render::Settings all = with(sized(render::monteCarlo(4096), 8, 6), render::EnvironmentSampling::Precomputed);
        all.lightSampling = render::LightSampling::Lights;
        const std::vector<float> first = renderPixels(renderer, all);
        CHECK(renderPixels(renderer, all) == first);
        all.seed = 1;
        const std::vector<float> seeded = renderPixels(renderer, all);
        CHECK(rmse(seeded, first) > 1e-4);
        all.frame = 1;
        CHECK(rmse(renderPixels(renderer, all), seeded) > 1e-4);
        for (const bool filtered : { false, true }) {
            CAPTURE(filtered);
            render::Settings s = sized(filtered ? render::axisAligned(32) : render::monteCarlo(32), size, size);
            s.environment.sampling = render::EnvironmentSampling::Precomputed;
            renderer.render(s);
            const image::Window crop { 3, 5, 17, 20 };
            const std::vector<float> whole = pixels(renderer, "beauty", crop);
            s.crop = crop;
            renderer.render(s);
            CHECK(pixels(renderer, "beauty", crop) == whole);
        }
    });
}
