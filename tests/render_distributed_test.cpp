// Distributed frames: counts that grow with what is asked for, and frames that keep little.
#include "tests/lens_scene.h"

#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

enum class Moves { Nothing, Camera, Geometry };

/// Through a lens, while the shutter is open.
scene::Scene movingWall(Moves moves)
{
    scene::Scene scene = wallInFocus();
    scene.camera.apertureRadius = 0.1f;
    scene.camera.focusDistance = 2.5f;
    const glm::vec3 shift(0.3f, 0.1f, 0);
    if (moves == Moves::Camera) {
        scene.cameraAtClose = scene.camera;
        scene.cameraAtClose->eye += shift;
        scene.cameraAtClose->lookAt += shift;
    } else if (moves == Moves::Geometry) {
        scene::Geometry& g = scene.geometry;
        g.positionsAtClose = g.positions;
        g.normalsAtClose = g.normals;
        for (std::size_t i = 0; i < g.positions.size(); ++i)
            g.positionsAtClose[i] += shift[static_cast<int>(i % 3)];
    }
    return scene;
}

} // namespace

TEST_CASE("more samples asked for are taken: where the first ones saw little, and under point lights alone")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool pointLights : { false, true }) {
            CAPTURE(pointLights);
            scene::Scene scene = wallInFocus();
            scene.camera.apertureRadius = 0.1f;
            scene.camera.focusDistance = 2.5f;
            (pointLights ? scene.areaLights.clear() : scene.pointLights.clear());
            render::Renderer renderer(scene, device, renderOptions());
            const render::Settings truth = sized(render::monteCarlo(400), 40, 30);
            const std::vector<float> expected = renderPixels(renderer, truth);
            double errors[2] = {}, primary[2] = {};
            for (const int k : { 0, 1 }) {
                render::Settings settings = sized(render::axisAligned(k == 0 ? 16 : 128), 40, 30);
                settings.seed = 5;
                const render::FrameStatistics frame = renderer.render(settings);
                primary[k] = frame.primarySpp;
                const std::vector<float> found = pixels(renderer, renderer.frame().beauty, { 0, 0, 40, 30 });
                for (std::size_t i = 0; i < found.size(); ++i)
                    errors[k] += (found[i] - expected[i]) * (found[i] - expected[i]);
            }
            CHECK(primary[1] > 4 * primary[0]);
            // Of squares.
            CHECK(errors[1] < 0.5 * errors[0]);
        }
    });
}

TEST_CASE("a frame of the image alone, in fewer bits, is the one with all of its layers but for rounding")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto& [moves, filtered] : { std::pair(Moves::Nothing, false), { Moves::Nothing, true },
                 { Moves::Camera, true }, { Moves::Geometry, true } }) {
            CAPTURE(static_cast<int>(moves));
            CAPTURE(filtered);
            const scene::Scene scene = movingWall(moves);
            render::Renderer renderer(scene, device, renderOptions());
            render::Settings settings = sized(filtered ? render::axisAligned(16) : render::monteCarlo(16), 61, 43);
            settings.bounces = 1;
            const image::Window all { 0, 0, 61, 43 };
            const render::FrameStatistics full = renderer.render(settings, {}, true);
            const std::vector<float> layered = pixels(renderer, renderer.frame().beauty, all);
            const render::FrameStatistics lean = renderer.render(settings);
            const std::vector<float> alone = pixels(renderer, renderer.frame().beauty, all);
            CHECK(lean.memoryBytes < full.memoryBytes);
            double squares = 0, sum = 0;
            for (std::size_t i = 0; i < alone.size(); ++i) {
                squares += (alone[i] - layered[i]) * (alone[i] - layered[i]);
                sum += layered[i];
            }
            const double count = static_cast<double>(alone.size());
            // Statistics of 8 bits change a few counts by one; sums are added up in another order.
            CHECK(std::sqrt(squares / count) < (filtered ? 0.01 : 1e-5) * sum / count);
            CHECK(sum / count > 0.05);
        }
    });
}

TEST_CASE("a frame of the image alone takes less than 150 MB at 1024x1024 with an area light and a bounce")
{
    onEveryDevice([](const device::Device& device) {
        for (const Moves moves : { Moves::Nothing, Moves::Camera, Moves::Geometry }) {
            CAPTURE(static_cast<int>(moves));
            scene::Scene scene = movingWall(moves);
            scene.pointLights.clear();
            render::Settings settings = sized(render::axisAligned(16), 1024, 1024);
            settings.bounces = 1;
            const render::Renderer renderer(scene, device, renderOptions());
            CHECK(renderer.plan(settings).total() < 150'000'000);
            CHECK(renderer.plan(settings, true).total() > 300'000'000);
        }
    });
}
