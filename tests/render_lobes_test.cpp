// What lobes see beyond the scene, as fractions of what they would see if nothing were hidden.
#include "tests/environment_support.h"
#include "tests/image_means.h"

#include <doctest/doctest.h>

using namespace wedge;
using namespace wedge::test;

namespace {

/// A sphere of a lobe alone.
scene::Material lobe(scene::SpecularModel model, float exponent)
{
    scene::Material m;
    m.diffuse = glm::vec3(0.0f);
    m.specular = glm::vec3(0.6f, 0.5f, 0.4f);
    m.specularModel = model;
    m.exponent = exponent;
    m.roughness = 0.3f;
    return m;
}

double errorOf(render::Renderer& renderer, const render::Settings& settings, const std::vector<float>& expected)
{
    return rmse(renderPixels(renderer, settings), expected);
}

} // namespace

TEST_CASE("where nothing is hidden, lobes of all kinds have a fraction of their noise")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto& kind : { std::pair(scene::SpecularModel::Phong, 64.0f), { scene::SpecularModel::Phong, 16.0f },
                 { scene::SpecularModel::BlinnPhong, 200.0f } }) {
            const scene::SpecularModel model = kind.first;
            const float exponent = kind.second;
            SceneBuilder b;
            b.scene.materials[0] = lobe(model, exponent);
            b.sphere({ 0, 0, 0 }, 0.5f, 48);
            b.camera({ 0, 0, 3 }, { 0, 0, 0 }, { 0, 1, 0 }, 25);
            render::setEnvironment(b.scene, spotted());
            render::Renderer renderer(b.scene, device, renderOptions());
            render::Settings truth = sized(render::monteCarlo(4096), 32, 32);
            truth.seed = 99;
            const std::vector<float> expected = renderPixels(renderer, truth);
            render::Settings fractions = sized(render::axisAligned(16), 32, 32), light = fractions;
            light.environment.relative = false;
            const double error = errorOf(renderer, fractions, expected), before = errorOf(renderer, light, expected),
                         plain = errorOf(renderer, sized(render::monteCarlo(16), 32, 32), expected);
            CAPTURE(static_cast<int>(model));
            CAPTURE(exponent);
            MESSAGE("RMSE: ", error, ", of light itself: ", before, ", without filter: ", plain);
            CHECK(error < 0.25 * plain);
            CHECK(error < 0.7 * before);
            for (const std::size_t channel : { 0u, 1u, 2u })
                CHECK(meanOf(renderPixels(renderer, fractions), channel).value
                    == doctest::Approx(meanOf(expected, channel).value).epsilon(0.01));
        }
    });
}

TEST_CASE("where much is hidden, and of another colour, errors fall as samples become more")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.scene.materials[0] = lobe(scene::SpecularModel::Phong, 20.0f);
        b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
        b.newObject();
        b.sphere({ 0, 0.5f, 0 }, 0.5f, 24);
        b.newObject();
        b.box({ -1.4f, 0, -0.6f }, { -0.8f, 1.2f, 0.6f });
        b.camera({ 0.5f, 0.9f, 2.6f }, { 0, 0.4f, 0 });
        // Red on one side, blue on the other.
        auto halves = even(glm::vec3(0.1f), 32, 16);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 32; ++x)
                set(*halves, x, y, x < 12 ? glm::vec3(4, 0.5f, 0.1f) : glm::vec3(0.1f, 0.5f, 3));
        render::setEnvironment(b.scene, halves);
        render::Renderer renderer(b.scene, device, renderOptions());
        render::Settings truth = sized(render::monteCarlo(1 << 14), 32, 24);
        truth.seed = 99;
        const std::vector<float> expected = renderPixels(renderer, truth);
        double last = 1e9;
        for (const int spp : { 16, 128, 1024 }) {
            const double error = errorOf(renderer, sized(render::axisAligned(spp), 32, 24), expected),
                         plain = errorOf(renderer, sized(render::monteCarlo(spp), 32, 24), expected);
            MESSAGE(spp, " samples: RMSE ", error, ", without filter: ", plain);
            if (spp <= 128) // of more, what lobes would see is not asked
                CHECK(error < (spp == 16 ? 0.5 : 1.0) * plain);
            CHECK(error < 0.6 * last);
            last = error;
        }
    });
}

TEST_CASE("under a map that is black but for a lamp, and a black one, lobes lose no light")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.scene.materials[0] = lobe(scene::SpecularModel::Phong, 32.0f);
        b.sphere({ 0, 0, 0 }, 0.5f, 48);
        b.newObject();
        b.box({ 0.6f, -0.5f, -0.2f }, { 0.8f, 0.5f, 0.2f });
        b.camera({ 0, 0, 3 }, { 0, 0, 0 }, { 0, 1, 0 }, 30);
        for (const float bright : { 50.0f, 5e-12f, 0.0f }) {
            auto lamp = even(glm::vec3(0.0f), 64, 32);
            for (int x = 20; x < 24; ++x)
                set(*lamp, x, 9, glm::vec3(bright));
            render::setEnvironment(b.scene, lamp);
            render::Renderer renderer(b.scene, device, renderOptions());
            render::Settings truth = sized(render::monteCarlo(2048), 48, 36);
            truth.seed = 99;
            const std::vector<float> expected = renderPixels(renderer, truth),
                                     found = renderPixels(renderer, sized(render::axisAligned(64), 48, 36));
            CAPTURE(bright);
            for (const float value : found)
                REQUIRE(std::isfinite(value));
            const double sum = meanOf(expected, 1).value;
            MESSAGE("mean over plain: ", meanOf(found, 1).value / std::max(sum, 1e-30));
            CHECK(std::fabs(meanOf(found, 1).value - sum) <= 0.03 * sum);
            CHECK((sum > 0) == (bright > 0));
        }
    });
}

TEST_CASE("crops of lobes are the whole frame's, bit by bit")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials[0] = lobe(scene::SpecularModel::Phong, 32.0f);
        b.newObject();
        b.sphere({ 0, 0.5f, 0 }, 0.5f, 24);
        b.camera({ 0.5f, 0.9f, 2.6f }, { 0, 0.4f, 0 });
        render::setEnvironment(b.scene, spotted());
        render::Renderer renderer(b.scene, device, renderOptions());
        render::Settings s = sized(render::axisAligned(16), 64, 48);
        const std::vector<float> whole = renderPixels(renderer, s);
        s.crop = { 21, 13, 50, 31 };
        const std::vector<float> part = renderPixels(renderer, s);
        std::size_t differ = 0;
        for (int y = 13; y < 31; ++y)
            for (int x = 21; x < 50; ++x)
                for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t at = 3 * (static_cast<std::size_t>(y) * 64 + static_cast<std::size_t>(x)) + c;
                    differ += part[at] == whole[at] ? 0 : 1;
                }
        CHECK(differ == 0);
    });
}

TEST_CASE("averages of a map have its mean, whatever its size")
{
    for (const auto& [w, h] : { std::pair(1, 1), { 32, 16 }, { 7, 5 }, { 100, 50 }, { 3, 200 }, { 700, 20 } }) {
        auto p = even(glm::vec3(0), w, h);
        std::mt19937 random(3);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                set(*p, x, y, glm::vec3(uniform(random), uniform(random), 1.0));
        const auto meanOver = [](const float* rgb, int columns, int rows, std::size_t channel) {
            double sum = 0, area = 0;
            for (int y = 0; y < rows; ++y)
                for (int x = 0; x < columns; ++x) {
                    const double sine = std::sin(std::acos(-1.0) * (y + 0.5) / rows);
                    sum += sine
                        * rgb[3
                                * (static_cast<std::size_t>(y) * static_cast<std::size_t>(columns)
                                    + static_cast<std::size_t>(x))
                            + channel];
                    area += sine;
                }
            return sum / area;
        };
        const render::EnvironmentTable table = render::environmentTable(p.get());
        const auto width = static_cast<std::uint32_t>(w), height = static_cast<std::uint32_t>(h);
        const float* averages = table.numbers.data() + shared::environmentAverages(width, height);
        const std::uint32_t levels = shared::coarseLevels(width);
        CHECK((WEDGE_COARSE_COLUMNS << (levels - 1)) >= std::min(width, 512u));
        CHECK(levels == (w > 512 ? 6 : w > 64 ? 4 : w > 16 ? 2 : 1));
        for (std::uint32_t level = 0; level < levels; ++level)
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const int columns = static_cast<int>(WEDGE_COARSE_COLUMNS << level);
                CHECK(meanOver(averages + shared::coarseLevelAt(level), columns, columns / 2, channel)
                    == doctest::Approx(meanOver(p->radiance.data(), w, h, channel)).epsilon(0.03));
            }
    }
}
