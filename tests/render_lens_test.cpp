// Whole frames through lens and shutter, plain Monte Carlo, against closed forms and against frames without.
#include "host/render/distributed_frame.h"
#include "tests/lens_scene.h"
#include "tests/lens_support.h"
#include "tests/render_path_support.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 64, height = 24;

render::Settings plain(int spp) { return sized(render::monteCarlo(spp), width, height); }

/// A half plane that shines, left of the pixel `edge` of an image with the camera in the origin, at a depth.
struct Edge {
    double depth = 2, focus = 2, radius = 0; ///< metres; radius: of the aperture
    double moves = 0; ///< pixels to the right, while the shutter is open
    scene::ApertureProfile aperture = scene::ApertureProfile::Uniform;
    scene::ShutterProfile shutter = scene::ShutterProfile::Box;

    static constexpr double start = 27.3; ///< pixel where it is when the shutter opens

    /// Metres of a pixel's step at distance 1.
    static double step() { return 2 * std::tan(0.5 * 40 * std::numbers::pi / 180) / height; }
    double circle() const { return radius / step() * (1 / depth - 1 / focus); }
    scene::Scene scene() const
    {
        SceneBuilder b;
        b.scene.materials[0].diffuse = glm::vec3(0);
        b.scene.materials[0].emission = glm::vec3(1);
        const double pixel = step() * depth, right = (start - width / 2.0) * pixel;
        b.quad({ right - 10, 0, -depth }, { 10, 0, 0 }, { 0, 10, 0 });
        b.camera({ 0, 0, 0 }, { 0, 0, -1 }, { 0, 1, 0 }, 40);
        b.scene.camera.apertureRadius = static_cast<float>(radius);
        b.scene.camera.focusDistance = static_cast<float>(focus);
        b.scene.camera.apertureProfile = aperture;
        b.scene.shutterProfile = shutter;
        if (moves != 0)
            displace(b.scene, { moves * pixel, 0, 0 });
        return b.scene;
    }
    /// Light that arrives at the middle of pixel x: from all of the lens and of the time for which the edge is to the
    /// right of where the ray meets its plane.
    double expected(int x) const
    {
        const int steps = moves == 0 ? 1 : radius == 0 ? 4000 : 300;
        double sum = 0, weights = 0;
        for (int i = 0; i < steps; ++i) {
            const double t = (i + 0.5) / steps;
            const double weight =
                shutter == scene::ShutterProfile::Gaussian ? std::exp(-0.5 * 16 * (t - 0.5) * (t - 0.5)) : 1;
            const double reach = start + moves * t - (x + 0.5);
            sum += weight * lensShare(aperture, circle(), reach);
            weights += weight;
        }
        return sum / weights;
    }
};

/// Means of the columns of an image of rows that are all alike, over several seeds, against what is expected: the
/// largest deviation in its standard deviations.
struct Columns {
    double worst = 0;
    double error = 0; ///< the largest standard deviation of a column's mean
    int partial = 0; ///< columns that are neither dark nor bright
};
Columns columns(const Edge& edge, const device::Device& device, int spp = 36, int runs = 4)
{
    const scene::Scene scene = edge.scene();
    render::Renderer renderer(scene, device, renderOptions());
    std::vector<double> sum(width), squares(width);
    for (int run = 0; run < runs; ++run) {
        render::Settings settings = plain(spp);
        settings.seed = static_cast<std::uint32_t>(run);
        const std::vector<float> image = renderPixels(renderer, settings);
        REQUIRE(notFinite(image) == 0);
        for (std::size_t i = 0; i < image.size(); i += 3) {
            sum[i / 3 % width] += image[i];
            squares[i / 3 % width] += static_cast<double>(image[i]) * image[i];
        }
    }
    Columns out;
    const double n = runs * height;
    for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        const double mean = sum[i] / n, variance = std::max(0.0, squares[i] / n - mean * mean) / (n - 1);
        const double expected = edge.expected(x);
        // Rare hits may not have come at all: not surer than one sample in all of them.
        const double error = std::sqrt(variance) + 1.0 / (n * spp);
        out.worst = std::max(out.worst, std::fabs(mean - expected) / error);
        out.error = std::max(out.error, error);
        out.partial += expected > 0.01 && expected < 0.99 ? 1 : 0;
    }
    return out;
}

void checkColumns(const Edge& edge, const device::Device& device)
{
    const Columns c = columns(edge, device);
    CAPTURE(edge.circle());
    CAPTURE(edge.moves);
    CHECK(c.worst < 4.5);
    CHECK(c.error < 0.02);
    CHECK(c.partial >= 8);
}

bool hasPass(const render::FrameStatistics& s, const std::string& name)
{
    return std::ranges::any_of(s.passes, [&](const device::PassRecord& pass) { return pass.name == name; });
}

} // namespace

TEST_CASE("only frames with a lens, a shutter or antialiasing go in waves")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene still = smallScene();
        scene::Scene lens = still, moves = still, camera = still;
        lens.camera.apertureRadius = 0.01f;
        displace(moves, { 0.1f, 0, 0 });
        camera.cameraAtClose = camera.camera;
        camera.cameraAtClose->eye.x += 0.1f;
        render::Settings smooth = plain(2);
        smooth.antialias = true;
        const auto goesInWaves = [&](const scene::Scene& scene, const render::Settings& settings) {
            render::Renderer renderer(scene, device, renderOptions());
            const bool waves = hasPass(renderer.render(settings), "lists");
            CHECK(waves == render::isDistributed(settings, scene));
            CHECK(renderer.frame().distributed == waves);
            return waves;
        };
        CHECK_FALSE(goesInWaves(still, plain(2)));
        CHECK(goesInWaves(lens, plain(2)));
        CHECK(goesInWaves(moves, plain(2)));
        CHECK(goesInWaves(camera, plain(2)));
        CHECK(goesInWaves(still, smooth));
    });
}

TEST_CASE("an edge out of focus has the profile of the aperture, before and behind the plane in focus")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto aperture : { scene::ApertureProfile::Uniform, scene::ApertureProfile::Gaussian })
            for (const double depth : { 1.2, 5.0 }) {
                Edge edge { depth, 2, 0 };
                edge.aperture = aperture;
                edge.radius = 9.0 / std::fabs(Edge { depth, 2, 1 }.circle());
                REQUIRE(std::fabs(std::fabs(edge.circle()) - 9) < 1e-9);
                checkColumns(edge, device);
            }
    });
}

TEST_CASE("a moving edge has the ramp of the shutter, either way")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto shutter : { scene::ShutterProfile::Box, scene::ShutterProfile::Gaussian })
            for (const double moves : { 14.0, -17.5 }) {
                Edge edge;
                edge.shutter = shutter;
                edge.moves = moves;
                checkColumns(edge, device);
            }
    });
}

TEST_CASE("a moving edge out of focus has the convolution of both: lens and time are independent")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto shutter : { scene::ShutterProfile::Box, scene::ShutterProfile::Gaussian }) {
            Edge edge { 1.2, 2, 8.0 / Edge { 1.2, 2, 1 }.circle() };
            edge.aperture = shutter == scene::ShutterProfile::Box ? scene::ApertureProfile::Uniform
                                                                  : scene::ApertureProfile::Gaussian;
            edge.shutter = shutter;
            edge.moves = 18;
            checkColumns(edge, device);
        }
    });
}

TEST_CASE("a slanted edge covers the pixels of an antialiased frame by areas")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.scene.materials[0].diffuse = glm::vec3(0);
        b.scene.materials[0].emission = glm::vec3(1);
        const auto at = [](double x, double y) { // of pixels at depth 2
            return glm::vec3(2 * Edge::step() * (x - width / 2.0), -2 * Edge::step() * (y - height / 2.0), -2);
        };
        const glm::dvec2 corners[3] = { { 9.4, -20.3 }, { 44.1, 31.7 }, { -60.5, 40.2 } };
        b.triangle(at(corners[0].x, corners[0].y), at(corners[1].x, corners[1].y), at(corners[2].x, corners[2].y));
        b.camera({ 0, 0, 0 }, { 0, 0, -1 }, { 0, 1, 0 }, 40);
        render::Renderer renderer(b.scene, device, renderOptions());
        render::Settings settings = plain(36);
        settings.antialias = true;
        const Moments found = moments(renderer, settings, Part::Beauty, 8);
        std::vector<double> expected;
        int partial = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const double area = coverage(corners, x, y);
                expected.insert(expected.end(), 3, area);
                partial += area > 0.01 && area < 0.99 ? 1 : 0;
            }
        checkAgreement(found, exactly(expected), 1e-3);
        CHECK(partial > 30);
        // One ray through the middle is all or nothing.
        settings.antialias = false;
        const std::vector<float> hard = renderPixels(renderer, settings);
        CHECK(std::ranges::all_of(hard, [](float v) { return v == 0 || v == 1; }));
    });
}

TEST_CASE("in focus and at rest the image is the pinhole's: direct and indirect light, and ambient occlusion")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene sharp = wallInFocus();
        scene::Scene lens = sharp, elsewhere = sharp;
        lens.camera.apertureRadius = 0.15f;
        // A shutter, and something that moves far from all that is seen and lit.
        SceneBuilder far;
        far.scene = sharp;
        far.newObject();
        far.quad({ 0, 0, 400 }, { 1, 0, 0 }, { 0, 1, 0 });
        elsewhere = far.scene;
        scene::Geometry& g = elsewhere.geometry;
        g.positionsAtClose = g.positions;
        g.normalsAtClose = g.normals;
        for (std::size_t i = g.positions.size() - 18; i < g.positions.size(); i += 3)
            g.positionsAtClose[i] += 5;
        for (const bool ambient : { false, true })
            for (const int bounces : { 0, 1 }) {
                if (ambient && bounces == 0)
                    continue;
                CAPTURE(ambient);
                CAPTURE(bounces);
                render::Settings settings = sized(render::monteCarlo(16), 24, 18);
                settings.bounces = ambient ? 0 : bounces;
                settings.integrator = ambient ? render::Integrator::AmbientOcclusion : render::Integrator::Path;
                const auto image = [&](const scene::Scene& scene) {
                    render::Renderer renderer(scene, device, renderOptions());
                    return moments(renderer, settings, Part::Beauty, 6);
                };
                const Moments expected = image(sharp);
                CHECK(expected.average() > 0.05);
                checkAgreement(image(lens), expected);
                checkAgreement(image(elsewhere), expected);
            }
    });
}

TEST_CASE("a moving camera sees what a still one sees of a scene that moves the other way")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene still = smallScene();
        still.areaLights.clear(); // lights stay where they are, but for those from afar
        still.directionalLights.push_back({ glm::normalize(glm::vec3(0.4f, -1, -0.3f)), { 2, 2.5f, 3 } });
        still.materials[0].emission = { 0.1f, 0, 0.05f };
        const glm::vec3 moves(0.25f, -0.1f, 0.15f);
        scene::Scene camera = still, things = still;
        camera.cameraAtClose = camera.camera;
        camera.cameraAtClose->eye += moves;
        camera.cameraAtClose->lookAt += moves;
        displace(things, -moves);
        const auto image = [&](const scene::Scene& scene) {
            render::Renderer renderer(scene, device, renderOptions());
            return moments(renderer, sized(render::monteCarlo(25), 48, 36), Part::Beauty, 6);
        };
        const Moments expected = image(things), found = image(camera);
        checkAgreement(found, expected);
        // It does move.
        CHECK(distance(image(still), expected, 1e-3).each > 5);
    });
}

TEST_CASE("a crop is the same pixels as the whole image, which takes several waves")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.materials[0].specular = { 0.1f, 0.2f, 0.1f };
        scene.materials[0].exponent = 15;
        scene.pointLights.push_back({ { 1, 3, 2 }, { 2, 2, 2 } });
        scene.camera.apertureRadius = 0.05f;
        displace(scene, { 0.1f, 0.05f, 0 });
        constexpr int across = 131, down = 85, spp = 19;
        REQUIRE(across * down * 16 > static_cast<int>(render::WaveSchedule::capacity));
        for (const render::Sampler sampler : { render::Sampler::Sobol, render::Sampler::Stratified }) {
            render::Settings settings = sized(render::monteCarlo(spp), across, down);
            settings.sampler = sampler;
            settings.bounces = 1;
            render::Renderer renderer(scene, device, renderOptions());
            const image::Window window { 37, 30, 94, 61 };
            renderer.render(settings);
            const std::vector<float> whole = pixels(renderer, "beauty", window);
            settings.crop = window;
            renderer.queue().setTargetMilliseconds(0.5);
            renderer.render(settings);
            CHECK(sameBits(pixels(renderer, "beauty", window), whole));
            CHECK(*std::ranges::max_element(whole) > 0.1f);
        }
    });
}

TEST_CASE("counts that follow the demand, without filters, change the noise and not the image, with either sampler")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.camera.apertureRadius = 0.06f;
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings reference = sized(render::monteCarlo(128), 40, 30);
        reference.bounces = 1;
        const Moments expected = moments(renderer, reference, Part::Beauty, 4);
        for (const render::Sampler sampler : { render::Sampler::Sobol, render::Sampler::Stratified }) {
            CAPTURE(static_cast<int>(sampler));
            render::Settings settings = sized(render::axisAligned(24), 40, 30);
            settings.bounces = 1;
            settings.sampler = sampler;
            settings.filtering = render::Filtering::None;
            settings.distributed.blur = false;
            // What the first samples say decides how many follow: a bias of a few percent, where they say little.
            checkAgreement(moments(renderer, settings, Part::Beauty, 12), expected, 0.02);
            // Some pixels have more samples than the strata were made for.
            const std::vector<std::uint32_t> taken =
                renderer.frame().counts("primarySamples").downloadAll(renderer.queue());
            CHECK(*std::ranges::max_element(taken) > 30);
        }
    });
}
