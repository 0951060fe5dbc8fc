// Error against mu and samples, and the mean count.
#include "tests/render_support.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 72, height = 54;

/// RMS error over three seeds.
double errorOf(render::Renderer& renderer, render::Settings settings, const std::vector<float>& reference)
{
    double sum = 0;
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        settings.seed = seed;
        sum += std::pow(rmse(renderPixels(renderer, sized(settings, width, height)), reference), 2);
    }
    return std::sqrt(sum / 3);
}

} // namespace

TEST_CASE("error falls with mu in both settings, and with samples; the filter pays")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = smallScene();
        render::Renderer renderer(scene, device, renderOptions());
        const std::vector<float> reference = renderPixels(renderer, sized(render::monteCarlo(2048), width, height));
        for (const bool published : { true, false }) {
            CAPTURE(published);
            // The published setting shades with the light's centre: its limit is the Monte Carlo image that does so
            // too.
            render::Settings limit = sized(render::monteCarlo(2048), width, height);
            limit.shading = published ? render::Shading::Separate : render::Shading::Inside;
            const std::vector<float> converged = renderPixels(renderer, limit);
            double before = 1e9;
            for (const float mu : { 1.0f, 2.0f, 4.0f }) {
                const render::Settings settings = published ? render::asPublished(mu) : render::axisAligned({}, mu);
                const double error = errorOf(renderer, settings, converged);
                MESSAGE(std::string(published ? "published" : "default") << " mu " << mu << ": RMS error " << error);
                CHECK(error < 0.97 * before);
                before = error;
            }
        }
        double before = 1e9;
        for (const int spp : { 9, 28, 100 }) {
            const double filtered = errorOf(renderer, render::axisAligned(spp), reference);
            const double plain = errorOf(renderer, render::monteCarlo(spp), reference);
            MESSAGE(spp << " samples: RMS error " << filtered << ", plain " << plain);
            CHECK(filtered < 0.9 * before);
            CHECK(filtered < plain);
            before = filtered;
        }
    });
}

TEST_CASE("the mean count of the default setting is the one asked for, within 1 %")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene one = smallScene();
        one.areaLights.resize(1);
        render::Renderer renderer(one, device, renderOptions());
        for (const int spp : { 12, 28, 64, 200 }) {
            const render::FrameStatistics s = renderer.render(sized(render::axisAligned(spp), width, height));
            CAPTURE(spp);
            CHECK(s.sppMean == doctest::Approx(spp).epsilon(0.01));
            CHECK(s.complete);
        }
        const scene::Scene two = smallScene();
        render::Renderer both(two, device, renderOptions());
        CHECK(both.render(sized(render::axisAligned(28), width, height)).sppMean == doctest::Approx(28).epsilon(0.01));
        CHECK(both.render(sized(render::monteCarlo(7), width, height)).sppMean == doctest::Approx(7));
    });
}

TEST_CASE(
    "highlights sharper than any rule: their directions grow in number with the samples, and change with the seed")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.quad({ 0, 0, 0 }, { 4, 0, 0 }, { 0, 0, -4 });
        b.scene.materials[0].specular = glm::vec3(0.5f);
        b.scene.materials[0].exponent = 10000;
        b.light({ 0, 2, -2 }, { 0.6f, 0, 0 }, { 0, 0.4f, 0 }, scene::LightProfile::Gaussian, 20);
        b.camera({ 0, 1, 3 }, { 0, 0.2f, 0 });
        // Nothing is in the way: what seeds differ by is the highlight's.
        render::Renderer renderer(b.scene, device, renderOptions());
        const auto noise = [&](int spp) {
            std::vector<std::vector<float>> images;
            for (const std::uint32_t seed : { 1u, 2u }) {
                render::Settings settings = sized(render::axisAligned(spp), width, height);
                settings.seed = seed;
                images.push_back(renderPixels(renderer, settings));
            }
            return rmse(images[0], images[1]);
        };
        const double few = noise(28), many = noise(448);
        MESSAGE("noise of 28 samples " << few << ", of 448 " << many);
        CHECK(few > 0);
        CHECK(many < 0.2 * few);
    });
}

TEST_CASE("what a glossy floor reflects of bars before a light is sharper than their shadows, and converges")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.quad({ 0, 0, 0 }, { 5, 0, 0 }, { 0, 0, -5 });
        b.scene.materials[0].diffuse = glm::vec3(0.1f);
        b.scene.materials[0].specular = glm::vec3(0.5f);
        b.scene.materials[0].exponent = 1000;
        b.newObject();
        for (int k = -5; k <= 5; ++k)
            b.quad({ 0.16f * static_cast<float>(k), 1.6f, -1.5f }, { 0.05f, 0, 0 }, { 0, 0.8f, 0 });
        b.light({ 0, 1.6f, -2 }, { 0.8f, 0, 0 }, { 0, 0.6f, 0 }, scene::LightProfile::Uniform, 10);
        b.scene.areaLights[0].visible = false;
        b.camera({ 0, 1.5f, 4 }, { 0, 0, 0 });
        for (const bool antialias : { false, true }) {
            CAPTURE(antialias);
            render::Renderer renderer(b.scene, device, renderOptions());
            const auto with = [&](render::Settings settings) {
                settings.antialias = antialias;
                return settings;
            };
            const std::vector<float> reference =
                renderPixels(renderer, sized(with(render::monteCarlo(4096)), width, height));
            const auto error = [&](render::Settings settings) { return errorOf(renderer, with(settings), reference); };
            const double few = error(render::axisAligned(28)), many = error(render::axisAligned(256));
            const double plain = error(render::monteCarlo(28)), plainMany = error(render::monteCarlo(256));
            MESSAGE("28 samples " << few << ", plain " << plain << "; 256 " << many << ", plain " << plainMany);
            CHECK(few < 0.7 * plain);
            CHECK(many < 0.6 * few);
            CHECK(many < 0.9 * plainMany);
        }
    });
}

TEST_CASE("pixels alone in a small penumbra take the samples that they need")
{
    // Grains over a floor, each with a shadow about as large as a pixel: what is around is lit.
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.newObject();
        b.quad({ 0, 0, 0 }, { 0, 0, 5 }, { 5, 0, 0 });
        b.newObject();
        std::mt19937 random(4);
        for (int x = -4; x <= 4; ++x)
            for (int z = -3; z <= 3; ++z) {
                const double px = 0.5 * x + uniform(random, -0.1, 0.1), pz = 0.5 * z + uniform(random, -0.1, 0.1);
                b.quad({ static_cast<float>(px), 0.5f, static_cast<float>(pz) }, { 0, 0, 0.012f }, { 0.012f, 0, 0 });
            }
        b.light({ 0, 3, 0 }, { 0.1f, 0, 0 }, { 0, 0, 0.1f }, scene::LightProfile::Uniform, 500);
        b.camera({ 0, 6, 0.5f }, { 0, 0, 0 });
        render::Renderer renderer(b.scene, device, renderOptions());
        const std::vector<float> reference = renderPixels(renderer, sized(render::monteCarlo(4096), width, height));
        renderPixels(renderer, sized(render::axisAligned(28), width, height), true);
        const render::PlaneLayout layout(width, height);
        const std::vector<std::uint32_t> samples = renderer.frame().counts("samples").downloadAll(renderer.queue());
        double lit = 0, darker = 0;
        int penumbrae = 0, others = 0;
        for (int y = 2; y < height - 2; ++y)
            for (int x = 2; x < width - 2; ++x) {
                const auto at = [&](int px, int py) {
                    return reference[3
                        * (static_cast<std::size_t>(py) * static_cast<std::size_t>(width)
                            + static_cast<std::size_t>(px))];
                };
                const double around = 0.25 * (at(x - 2, y) + at(x + 2, y) + at(x, y - 2) + at(x, y + 2));
                const double seen = at(x, y) / around;
                const double taken = samples[shared::pixelIndex(
                    static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), layout.stride)];
                if (seen > 0.2 && seen < 0.8) {
                    ++penumbrae;
                    darker += taken;
                } else if (seen > 0.99 && seen < 1.01) {
                    ++others;
                    lit += taken;
                }
            }
        MESSAGE(penumbrae << " pixels in penumbrae, samples " << darker / penumbrae << ", where it is lit "
                          << lit / others);
        CHECK(penumbrae > 10);
        CHECK(darker / penumbrae > 100);
        CHECK(lit / others < 28);
    });
}
