// Light from beyond the scene against closed forms, by every method and kind of frame.
#include "host/render/environment_table.h"
#include "host/render/layers.h"
#include "host/render/progressive.h"
#include "tests/environment_support.h"
#include "tests/image_means.h"

#include <doctest/doctest.h>

using namespace wedge;
using namespace wedge::test;

namespace {

render::Settings settings(bool filtered, int spp = 32)
{
    return sized(filtered ? render::axisAligned(spp) : render::monteCarlo(spp), 24, 24);
}

constexpr render::LightSampling samplings[] = { render::LightSampling::Both, render::LightSampling::Lights,
    render::LightSampling::Directions };

} // namespace

TEST_CASE("a floor under an even environment reflects its reflectance of it in every kind of frame")
{
    // E = pi L.
    onEveryDevice([](const device::Device& device) {
        for (const bool lens : { false, true }) {
            SceneBuilder b = openFloor();
            b.scene.camera.apertureRadius = lens ? 0.02f : 0.0f;
            render::Renderer renderer(b.scene, device, renderOptions());
            for (const bool filtered : { false, true })
                for (const bool progressive : { false, true }) {
                    CAPTURE(lens);
                    CAPTURE(filtered);
                    CAPTURE(progressive);
                    render::Settings s = settings(filtered);
                    s.progressive = progressive;
                    s.bounces = 1; // a floor alone does not light itself
                    // Filters make neighbours alike: the image's mean has more noise than they seem to have.
                    checkMean(renderPixels(renderer, s), sky * reflectance, filtered ? 0.01 : 1e-4);
                }
        }
    });
}

TEST_CASE("where nothing absorbs, all is as bright as the environment")
{
    // The furnace: paths that leave the scene, after any number of bounces, and what the camera sees behind it.
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials[0].diffuse = glm::vec3(1.0f);
        b.box({ -0.6f, 0.1f, -0.3f }, { -0.1f, 0.8f, 0.4f });
        b.box({ 0.1f, 0.1f, -0.3f }, { 0.5f, 0.4f, 0.3f });
        b.camera({ 0, 1.5f, 4.5f }, { 0, 0.4f, 0 });
        for (const bool lens : { false, true }) {
            b.scene.camera.apertureRadius = lens ? 0.02f : 0.0f;
            render::Renderer renderer(b.scene, device, renderOptions());
            for (const bool filtered : { false, true }) {
                CAPTURE(lens);
                CAPTURE(filtered);
                render::Settings s = settings(filtered, 64);
                s.bounces = 64;
                checkMean(renderPixels(renderer, s), sky, filtered ? 0.01 : 1e-3);
            }
        }
    });
}

TEST_CASE("a wall takes its form factor of an even environment, by each technique")
{
    // Of an endless wall of height h at distance d: (1 - d / sqrt(d^2 + h^2)) / 2.
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials.push_back(b.scene.materials[0]);
        b.scene.materials[1].diffuse = glm::vec3(0.0f);
        const float distance = 0.5f, height = 0.8f;
        b.quad({ -distance, 0.5f * height, 0 }, { 0, 0.5f * height, 0 }, { 0, 0, 1000 }, 1);
        b.camera({ 0, 2, 0 }, { 0, 0, 0 }, { 0, 0, -1 }, 0.05f);
        render::setEnvironment(b.scene, even(sky, 16, 8));
        render::Renderer renderer(b.scene, device, renderOptions());
        const float open = 1.0f - 0.5f * (1.0f - distance / std::hypot(distance, height));
        for (const render::LightSampling sampling : samplings) {
            CAPTURE(static_cast<int>(sampling));
            render::Settings s = settings(false, 64);
            s.lightSampling = sampling;
            checkMean(renderPixels(renderer, s), open * sky * reflectance, 2e-4);
        }
    });
}

TEST_CASE("half of the sky is hidden by half a space")
{
    // An endless wall that the receiver all but touches.
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials.push_back(b.scene.materials[0]);
        b.scene.materials[1].diffuse = glm::vec3(0.0f);
        b.quad({ -1e-3f, 500, 0 }, { 0, 500, 0 }, { 0, 0, 1000 }, 1);
        b.camera({ 0.0005f, 2, 0 }, { 0.0005f, 0, 0 }, { 0, 0, -1 }, 0.001f);
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const bool filtered : { false, true })
            checkMean(renderPixels(renderer, settings(filtered, 64)), 0.5f * sky * reflectance, 0.01);
    });
}

TEST_CASE("a bright texel lights from where the map has it, and is seen there")
{
    // Columns go from behind (+z) by the left, ahead (-z) in the middle, and the right; rows from above.
    struct Place {
        int x, y;
        glm::vec3 towards;
    };
    const double elevation = std::acos(-1.0) * (0.5 - 3.5 / 16);
    const auto up = static_cast<float>(std::sin(elevation)), flat = static_cast<float>(std::cos(elevation));
    const double half = std::acos(-1.0) / 32; // of a column
    const auto along = static_cast<float>(std::cos(half)), aside = static_cast<float>(std::sin(half));
    const Place places[] = { { 16, 3, { flat * aside, up, -flat * along } }, // ahead, just right of it
        { 24, 3, { flat * along, up, flat * aside } }, { 8, 3, { -flat * along, up, -flat * aside } },
        { 0, 3, { -flat * aside, up, flat * along } } };
    onEveryDevice([&](const device::Device& device) {
        for (const Place& place : places) {
            CAPTURE(place.x);
            auto map = even(glm::vec3(0), 32, 16);
            set(*map, place.x, place.y, glm::vec3(1000));
            SceneBuilder b = openFloor();
            // A blocker between the floor's middle and where the light comes from, but for other directions.
            render::setEnvironment(b.scene, map);
            render::Renderer open(b.scene, device, renderOptions());
            const double lit = meanOf(renderPixels(open, settings(false, 64)), 0).value;
            // What the lookup makes of a texel goes on for half of its neighbours: solid angle as of the texel.
            const double solidAngle =
                2 * std::acos(-1.0) / 32 * (std::cos(3 * std::acos(-1.0) / 16) - std::cos(4 * std::acos(-1.0) / 16));
            CHECK(lit == doctest::Approx(1000 * solidAngle * up * reflectance.x / std::acos(-1.0)).epsilon(0.03));
            const glm::vec3 side = glm::normalize(glm::cross(place.towards, glm::vec3(0, 1, 0)));
            b.quad(3.0f * place.towards, 1.5f * side, 1.5f * glm::normalize(glm::cross(place.towards, side)));
            b.camera({ 0, 0.5f, 0 }, { 0, 0, 0 }, { 0, 0, -1 }, 10);
            render::Renderer hidden(b.scene, device, renderOptions());
            CHECK(meanOf(renderPixels(hidden, settings(false, 64)), 0).value == 0);
            // Seen, too.
            SceneBuilder nothing = openFloor();
            render::setEnvironment(nothing.scene, map);
            nothing.camera({ 0, 1, 0 }, glm::vec3(0, 1, 0) + place.towards, { 0, 1, 0 }, 1);
            render::Renderer looking(nothing.scene, device, renderOptions());
            CHECK(meanOf(renderPixels(looking, settings(false)), 0).value > 900);
        }
    });
}

TEST_CASE("directions of the map, of lobes, and both together tell the same")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials[0].specular = glm::vec3(0.3f);
        b.scene.materials[0].exponent = 20.0f;
        b.box({ -0.5f, 0, -0.5f }, { 0.5f, 0.6f, 0.0f });
        b.camera({ 0, 1.2f, 3 }, { 0, 0.2f, 0 });
        render::setEnvironment(b.scene, spotted());
        for (const bool lens : { false, true }) {
            CAPTURE(lens);
            b.scene.camera.apertureRadius = lens ? 0.02f : 0.0f;
            render::Renderer renderer(b.scene, device, renderOptions());
            const auto image = [&](render::LightSampling sampling, int bounces) {
                render::Settings s = settings(false, 512);
                s.lightSampling = sampling;
                s.bounces = bounces;
                return renderPixels(renderer, s);
            };
            for (const int bounces : { 0, 2 }) {
                CAPTURE(bounces);
                const std::vector<float> both = image(render::LightSampling::Both, bounces);
                for (const render::LightSampling one :
                    { render::LightSampling::Lights, render::LightSampling::Directions }) {
                    CAPTURE(static_cast<int>(one));
                    std::vector<float> difference = image(one, bounces);
                    for (std::size_t i = 0; i < both.size(); ++i)
                        difference[i] -= both[i];
                    checkMean(difference, glm::vec3(0.0f));
                }
            }
        }
    });
}

TEST_CASE("an environment that the camera does not see lights all the same; ambient occlusion knows none")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.camera({ 0, 1, 6 }, { 0, 1, 0 });
        auto unseen = even(sky);
        unseen->seen = false;
        render::setEnvironment(b.scene, unseen);
        b.scene.background = { 0.25f, 0.5f, 0.125f };
        render::Renderer renderer(b.scene, device, renderOptions());
        const std::vector<float> image = renderPixels(renderer, settings(false));
        for (int channel = 0; channel < 3; ++channel)
            CHECK(image[static_cast<std::size_t>(channel)] == b.scene.background[channel]); // the upper left corner
        CHECK(image[3 * (23 * 24 + 12)] > 0.2f);
        render::Settings ambient = settings(false);
        ambient.integrator = render::Integrator::AmbientOcclusion;
        CHECK(renderPixels(renderer, ambient)[3 * (23 * 24 + 12)] == doctest::Approx(1).epsilon(1e-5));
        renderPixels(renderer, settings(true), true);
        REQUIRE(termsOf(renderer) == std::vector<std::string> { "Environment" });
        CHECK(std::ranges::max(widthsOf(renderer, "Environment")) > 0);
    });
}

TEST_CASE("a table chooses directions by how far they are brighter than the mean")
{
    const auto p = spotted();
    const render::EnvironmentTable table = render::environmentTable(p.get());
    const std::size_t w = 32, h = 16;
    REQUIRE(table.numbers.size() == shared::environmentTableSize(w, h));
    // Kernels read four numbers of each texel.
    REQUIRE(table.numbers.size() > shared::environmentAverages(w, h)
            + shared::coarseLevelAt(shared::coarseLevels(static_cast<std::uint32_t>(w))));
    CHECK(table.map.width == w);
    const float* rows = table.numbers.data() + 3 * w * h;
    const float* columns = rows + h;
    CHECK(rows[h - 1] == 1);
    for (std::size_t y = 0; y < h; ++y) {
        CHECK(columns[y * w + w - 1] == 1);
        for (std::size_t x = 1; x < w; ++x)
            CHECK(columns[y * w + x] > columns[y * w + x - 1]); // each can be chosen
    }
    const float ofSpot = (rows[4] - rows[3]) * (columns[4 * w + 12] - columns[4 * w + 10]);
    CHECK(ofSpot > 0.6f);
    CHECK(render::environmentTable(nullptr).numbers.empty());
    // Over all directions: 4 pi of an even one.
    const auto grey = even(glm::vec3(0.5f), 7, 5);
    CHECK(render::environmentTable(grey.get()).irradiance == doctest::Approx(2 * std::acos(-1.0)).epsilon(1e-6));
}
