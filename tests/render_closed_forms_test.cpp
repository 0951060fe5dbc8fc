// Whole frames against closed forms, and plain Monte Carlo against an estimate of its own.
#include "bvh/host_traverse.h"
#include "kernels/shared/bsdf.h"
#include "tests/render_oracles.h"
#include "tests/render_path_support.h"
#include "tests/render_support.h"

#include <algorithm>
#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 64, height = 48;

scene::Scene penumbra(scene::LightProfile profile)
{
    const char* data = std::getenv("WEDGE_TEST_DATA");
    scene::Scene scene = scene::loadScene((data != nullptr ? std::string(data) : "data") + "/scenes/penumbra.toml");
    scene.areaLights.at(0).profile = profile;
    return scene;
}

/// Visibility across the edge of the half plane x <= 0 midway between light and receiver: the share of the light
/// beyond -x.
double edgeVisibility(const scene::AreaLight& light, double x)
{
    const double half = light.halfU.x; // metres; the slope is 1
    if (light.profile == scene::LightProfile::Uniform)
        return std::clamp(0.5 + 0.5 * x / half, 0.0, 1.0); // a ramp of width 2 L s
    const double sigma = half / light.cut, mass = std::erf(light.cut / std::sqrt(2.0));
    return std::clamp(0.5 + 0.5 * std::erf(x / (sigma * std::sqrt(2.0))) / mass, 0.0, 1.0);
}

/// Radiance that a diffuse floor of that reflectance reflects, by a fine grid over the light.
double edgeRadiance(const scene::AreaLight& light, glm::dvec3 at, double reflectance)
{
    constexpr int steps = 200, across = 32;
    const double cell = 2 * static_cast<double>(light.halfU.x) / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < across; ++k) {
            const double a = 2 * (i + 0.5) / steps - 1, b = 2 * (k + 0.5) / across - 1;
            const glm::dvec3 point = pointOf(light, a, b);
            const double beyond = std::clamp((at.x + point.x) / cell + 0.5, 0.0, 1.0); // of the grid's cell
            sum +=
                beyond * profileAt(light, a, b) * geometry({ 0, 1, 0 }, point - at, lightNormal(light), light.twoSided);
        }
    return light.radiance.x * reflectance / std::numbers::pi * sum * lightArea(light) / (steps * across);
}

struct EdgeErrors {
    double rms = 0, worst = 0, columnBias = 0;
};

/// Error relative to the largest radiance; columnBias: the largest mean error of a column of pixels. expected: filled
/// if empty.
EdgeErrors edgeErrors(render::Renderer& renderer, const render::Settings& settings, std::vector<double>& expected)
{
    renderer.render(settings, {}, true);
    const image::Window all { 0, 0, width, height };
    const std::vector<float> beauty = pixels(renderer, "beauty", all);
    const std::vector<float> position = pixels(renderer, "position", all);
    for (std::size_t i = expected.size(); i < beauty.size() / 3; ++i) {
        const glm::dvec3 at(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
        expected.push_back(edgeRadiance(renderer.scene().areaLights[0], at, 0.8));
    }
    const double peak = *std::ranges::max_element(expected);
    EdgeErrors out;
    for (int x = 0; x < width; ++x) {
        double column = 0;
        for (int y = 0; y < height; ++y) {
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            const double e = (beauty[3 * i] - expected[i]) / peak;
            out.rms += e * e / (width * height);
            out.worst = std::max(out.worst, std::fabs(e));
            column += e / height;
        }
        out.columnBias = std::max(out.columnBias, std::fabs(column));
    }
    out.rms = std::sqrt(out.rms);
    return out;
}

void checkEdge(const EdgeErrors& e, const std::string& what, double rms, double worst, double bias)
{
    MESSAGE(what << ": RMS " << e.rms << ", worst " << e.worst << ", largest mean of a column " << e.columnBias);
    CHECK(e.rms < rms);
    CHECK(e.worst < worst);
    CHECK(e.columnBias < bias);
}

} // namespace

TEST_CASE("a straight edge's penumbra: error function for a Gaussian light, ramp for a uniform one")
{
    onEveryDevice([](const device::Device& device) {
        for (const scene::LightProfile profile : { scene::LightProfile::Gaussian, scene::LightProfile::Uniform }) {
            const scene::Scene scene = penumbra(profile);
            render::Renderer renderer(scene, device, renderOptions());
            std::vector<double> expected;
            checkEdge(edgeErrors(renderer, sized(render::monteCarlo(256), width, height), expected), "mc", 0.003, 0.02,
                0.001);
            checkEdge(edgeErrors(renderer, sized(render::axisAligned(28), width, height), expected), "aaf", 0.015, 0.07,
                0.05);

            // With the light's centre for the shading, the ratio to the unshadowed image is the visibility itself.
            render::Settings separate = sized(render::monteCarlo(512), width, height);
            separate.shading = render::Shading::Separate;
            renderer.render(separate, {}, true);
            const image::Window all { 0, 0, width, height };
            const std::vector<float> beauty = pixels(renderer, "beauty", all);
            const std::vector<float> position = pixels(renderer, "position", all);
            const scene::AreaLight& light = scene.areaLights[0];
            const double power = render::deviceLight(light).power.x;
            double sum = 0, count = 0;
            for (std::size_t i = 0; i < beauty.size() / 3; ++i) {
                const glm::dvec3 at(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
                const double full = 0.8 / std::numbers::pi * power
                    * geometry({ 0, 1, 0 }, glm::dvec3(light.centre) - at, lightNormal(light), light.twoSided);
                sum += std::pow(beauty[3 * i] / full - edgeVisibility(light, at.x), 2);
                count += 1;
            }
            CHECK(std::sqrt(sum / count) < 0.008);
        }
    });
}

TEST_CASE("an unoccluded uniform quad gives Lambert's formula")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.quad({ 0, 0, 0 }, { 0, 0, 3 }, { 3, 0, 0 });
        b.light({ 0.3f, 1.5f, 0 }, { 0.6f, 0, 0 }, { 0, 0, 0.4f }, scene::LightProfile::Uniform, 7);
        b.camera({ 0, 3, 4 }, { 0, 0, 0 });
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const bool filtered : { false, true }) {
            const render::Settings settings =
                sized(filtered ? render::axisAligned(28) : render::monteCarlo(1024), 60, 44);
            const std::vector<float> beauty = renderPixels(renderer, settings, true);
            const image::Window all { 0, 0, 60, 44 };
            const std::vector<float> position = pixels(renderer, "position", all);
            const std::vector<float> id = pixels(renderer, "depth", all);
            double worst = 0;
            for (std::size_t i = 0; i < id.size(); ++i) {
                if (!std::isfinite(id[i]))
                    continue;
                const glm::dvec3 at(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
                const double expected =
                    7 * 0.7 / std::numbers::pi * lambertIrradiance(b.scene.areaLights[0], at, { 0, 1, 0 });
                worst = std::max(worst, std::fabs(beauty[3 * i + 1] / expected - 1));
            }
            MESSAGE(std::string(filtered ? "aaf" : "mc") << ": largest relative error " << worst);
            // Nothing is in the way, so filtering leaves the quadrature's error alone.
            CHECK(worst < (filtered ? 1e-3 : 0.02));
        }
    });
}

TEST_CASE("lights that the floor's horizon cuts, and lights next to it: no pixel is dark that sees a part of one")
{
    onEveryDevice([](const device::Device& device) {
        struct Case {
            const char* name;
            glm::vec3 centre, halfU, halfV;
            scene::LightProfile profile;
        };
        const Case cases[] = {
            { "a panel, 20 % of it above the floor", { 0, -0.3f, -1 }, { 0.5f, 0, 0 }, { 0, 0.5f, 0 },
                scene::LightProfile::Uniform },
            { "the same, Gaussian", { 0, -0.3f, -1 }, { 0.5f, 0, 0 }, { 0, 0.5f, 0 }, scene::LightProfile::Gaussian },
            { "a tip of it", { 0, -0.45f, -1 }, { 0.35f, 0.35f, 0 }, { -0.35f, 0.35f, 0 },
                scene::LightProfile::Gaussian },
            { "a lamp 2 cm above the floor", { 0, 0.02f, 0 }, { 0.5f, 0, 0 }, { 0, 0, 0.5f },
                scene::LightProfile::Gaussian },
        };
        for (const Case& c : cases) {
            const std::string name = c.name;
            CAPTURE(name);
            SceneBuilder b;
            b.quad({ 0, 0, 0 }, { 0, 0, 3 }, { 3, 0, 0 });
            b.light(c.centre, c.halfU, c.halfV, c.profile, 7);
            b.scene.areaLights[0].twoSided = true;
            b.scene.areaLights[0].visible = false;
            b.camera({ 0, 3, 4 }, { 0, 0, 0 });
            render::Renderer renderer(b.scene, device, renderOptions());
            const scene::AreaLight& light = b.scene.areaLights[0];
            const image::Window all { 0, 0, 60, 44 };
            for (const bool filtered : { false, true }) {
                const render::Settings settings =
                    sized(filtered ? render::axisAligned(28) : render::monteCarlo(256), 60, 44);
                const std::vector<float> beauty = renderPixels(renderer, settings, true);
                const std::vector<float> position = pixels(renderer, "position", all);
                const std::vector<float> id = pixels(renderer, "depth", all);
                double worst = 0, squared = 0, total = 0;
                unsigned dark = 0;
                for (std::size_t i = 0; i < id.size(); ++i) {
                    if (!std::isfinite(id[i]))
                        continue;
                    const glm::dvec3 at(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
                    double sum = 0, nearest = 1e30;
                    constexpr int steps = 160;
                    for (int j = 0; j < steps; ++j)
                        for (int k = 0; k < steps; ++k) {
                            const double u = 2 * (j + 0.5) / steps - 1, v = 2 * (k + 0.5) / steps - 1;
                            const glm::dvec3 d = pointOf(light, u, v) - at;
                            sum += profileAt(light, u, v) * geometry({ 0, 1, 0 }, d, lightNormal(light), true);
                            nearest = std::min(nearest, glm::length(d));
                        }
                    if (nearest < 3.0 * 1.0 / steps) // the grid is too coarse to tell
                        continue;
                    const double expected = 7 * 0.7 / std::numbers::pi * sum * lightArea(light) / (steps * steps);
                    const double error = beauty[3 * i + 1] - expected;
                    dark += beauty[3 * i + 1] <= 0.5 * expected && expected > 1e-6 ? 1 : 0;
                    worst = std::max(worst, std::fabs(error) / (expected + 1e-3));
                    squared += error * error;
                    total += expected * expected;
                }
                MESSAGE(name << std::string(filtered ? ", aaf" : ", mc") << ": worst " << worst << ", RMS "
                             << std::sqrt(squared / total));
                CHECK(dark == 0);
                // Nothing is in the way: the filtered frame has the quadrature's error, and that of the grid above.
                if (filtered) {
                    CHECK(worst < 0.02);
                    CHECK(std::sqrt(squared / total) < 3e-3);
                } else {
                    CHECK(std::sqrt(squared / total) < 0.1);
                }
            }
        }
    });
}

TEST_CASE("point and directional lights are exact")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.areaLights.clear();
        scene.materials[0].specular = { 0.2f, 0.3f, 0.4f };
        scene.materials[0].exponent = 12;
        scene.pointLights.push_back({ { 1, 2, 1 }, { 6, 5, 4 } });
        scene.directionalLights.push_back({ glm::normalize(glm::vec3(0.4f, -1, 0.2f)), { 1, 2, 3 } });
        render::Renderer renderer(scene, device, renderOptions());
        const std::vector<float> beauty = renderPixels(renderer, sized(render::monteCarlo(1), 50, 37), true);
        const image::Window all { 0, 0, 50, 37 };
        const auto position = pixels(renderer, "position", all), normal = pixels(renderer, "normal", all);
        const auto origin = pixels(renderer, "origin", all), depth = pixels(renderer, "depth", all);
        unsigned shaded = 0, wrong = 0;
        for (std::size_t i = 0; i < depth.size(); ++i) {
            if (!std::isfinite(depth[i]))
                continue;
            const auto at = [&](const std::vector<float>& v) {
                return shared::vec3(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
            };
            const glm::vec3 n = { at(normal).x, at(normal).y, at(normal).z },
                            o = { at(origin).x, at(origin).y, at(origin).z };
            const glm::vec3 view =
                glm::normalize(scene.camera.eye - glm::vec3(position[3 * i], position[3 * i + 1], position[3 * i + 2]));
            double expected = 0;
            for (const bool point : { true, false }) {
                const glm::vec3 d =
                    point ? scene.pointLights[0].position - o : -100.0f * scene.directionalLights[0].direction;
                const glm::vec3 l = glm::normalize(d);
                const double cosine = glm::dot(n, l);
                if (!(cosine > 0)
                    || bvh::anyHit(renderer.hierarchy(), { at(origin), 0, shared::vec3(d.x, d.y, d.z), 0.9999f }))
                    continue;
                const double lobe = shared::specularLobe(at(normal), shared::vec3(view.x, view.y, view.z),
                    shared::vec3(l.x, l.y, l.z), 12, WEDGE_BLINN_PHONG);
                expected += (0.7 / std::numbers::pi + 0.3 * lobe) * cosine * (point ? 5 / glm::dot(d, d) : 2.0);
            }
            ++shaded;
            wrong += std::fabs(beauty[3 * i + 1] - expected) > 1e-3 * (expected + 0.1) ? 1 : 0;
        }
        CHECK(shaded > 1000);
        CHECK(wrong <= shaded / 300); // rays that graze an edge
    });
}

TEST_CASE("shading normals that face away from the viewer are lit as the round surface's rim is")
{
    onEveryDevice([](const device::Device& device) {
        constexpr float lit = 2; // W/m^2
        const image::Window all { 0, 0, 160, 160 };
        for (const float specular : { 0.0f, 0.4f }) {
            double sum = 0, expectedSum = 0, squared = 0, squaredBlack = 0;
            unsigned away = 0;
            for (int k = 0; k < 8; ++k) {
                SceneBuilder b;
                b.sphere({ 0, 0, 0 }, 1, 12);
                b.camera({ 0, 1, 4 }, { 0, 0, 0 }, { 0, 1, 0 }, 32);
                b.scene.materials[0].diffuse = glm::vec3(0.3f);
                b.scene.materials[0].specular = glm::vec3(specular);
                b.scene.materials[0].exponent = 20;
                const double turn = 2 * std::numbers::pi * k / 8;
                const glm::dvec3 toLight = glm::normalize(glm::dvec3(std::cos(turn), std::sin(turn), -0.3));
                b.scene.directionalLights.push_back({ glm::vec3(-toLight), glm::vec3(lit) });
                render::Renderer renderer(b.scene, device, renderOptions());
                const std::vector<float> beauty =
                    renderPixels(renderer, sized(render::monteCarlo(1), all.x1, all.y1), true);
                const std::vector<float> position = pixels(renderer, "position", all);
                const std::vector<float> normal = pixels(renderer, "normal", all);
                const std::vector<float> depth = pixels(renderer, "depth", all);
                const glm::dvec3 eye(b.scene.camera.eye);
                for (std::size_t i = 0; i < depth.size(); ++i) {
                    const glm::dvec3 at(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
                    const glm::dvec3 v = glm::normalize(eye - at);
                    if (!std::isfinite(depth[i])
                        || glm::dot(glm::dvec3(normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]), v) >= 0)
                        continue;
                    // Where the ray meets the sphere of which the mesh has some points.
                    const double along = glm::dot(eye, v), within = along * along - glm::dot(eye, eye) + 1;
                    const glm::dvec3 n = glm::normalize(eye - (along - std::sqrt(std::max(within, 0.0))) * v);
                    const double facing = std::max(glm::dot(n, toLight), 0.0);
                    const double reflected = reflectance(b.scene.materials[0], n, v, toLight).x;
                    const double expected = facing > 0 ? lit * reflected * facing : 0, got = beauty[3 * i];
                    sum += got;
                    expectedSum += expected;
                    squared += (got - expected) * (got - expected);
                    squaredBlack += expected * expected;
                    ++away;
                }
            }
            MESSAGE("specular " << specular << ": " << away << " pixels, mean " << sum / expectedSum
                                << " of the sphere's, RMS over that of black pixels "
                                << std::sqrt(squared / squaredBlack));
            REQUIRE(away > 200);
            CHECK(sum / expectedSum > 0.75);
            CHECK(sum / expectedSum < 1.25);
            CHECK(std::sqrt(squared / squaredBlack) < 0.25);
        }
    });
}

TEST_CASE("plain Monte Carlo is unbiased: no pixel is off by more than chance allows")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.materials[0].specular = glm::vec3(0.2f);
        scene.materials[0].exponent = 8;
        render::Renderer renderer(scene, device, renderOptions());
        constexpr int w = 24, h = 18;
        const image::Window all { 0, 0, w, h };
        constexpr unsigned runs = 48, samples = 7, hostSamples = 1500;
        for (const render::Sampler sampler : { render::Sampler::Sobol, render::Sampler::Stratified }) {
            std::vector<double> mean(w * h), square(w * h);
            for (unsigned run = 0; run < runs; ++run) {
                render::Settings settings = sized(render::monteCarlo(samples), w, h);
                settings.sampler = sampler;
                settings.seed = run;
                renderer.render(settings, {}, true);
                const std::vector<float> direct = pixels(renderer, "direct", all);
                for (std::size_t i = 0; i < mean.size(); ++i) {
                    mean[i] += direct[3 * i] / static_cast<double>(runs);
                    square[i] += static_cast<double>(direct[3 * i]) * direct[3 * i] / runs;
                }
            }
            // The same integrals with independent uniform points on the lights and the host's traversal.
            const auto position = pixels(renderer, "position", all), normal = pixels(renderer, "normal", all);
            const auto origin = pixels(renderer, "origin", all), depth = pixels(renderer, "depth", all);
            std::mt19937 random(99);
            double worst = 0, sum = 0, sumVariance = 0;
            std::vector<double> squares;
            for (std::size_t i = 0; i < mean.size(); ++i) {
                if (!std::isfinite(depth[i]))
                    continue;
                const glm::dvec3 at(position[3 * i], position[3 * i + 1], position[3 * i + 2]),
                    n(normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]);
                const shared::Vec3 o = shared::vec3(origin[3 * i], origin[3 * i + 1], origin[3 * i + 2]);
                const glm::dvec3 view = glm::normalize(glm::dvec3(scene.camera.eye) - at);
                double expected = 0, variance = 0;
                for (const scene::AreaLight& light : scene.areaLights) {
                    double total = 0, totalSquares = 0;
                    for (unsigned k = 0; k < hostSamples; ++k) {
                        const double a = uniform(random, -1, 1), b = uniform(random, -1, 1);
                        const glm::dvec3 point = pointOf(light, a, b), d = point - at;
                        const double g = geometry(n, d, lightNormal(light), light.twoSided);
                        if (!(g > 0))
                            continue;
                        const shared::Vec3 ray = shared::vec3(static_cast<float>(point.x) - o.x,
                            static_cast<float>(point.y) - o.y, static_cast<float>(point.z) - o.z);
                        if (bvh::anyHit(renderer.hierarchy(), { o, 0, ray, WEDGE_SHADOW_RAY_END }))
                            continue;
                        const double c = std::max(0.0, glm::dot(n, glm::normalize(view + glm::normalize(d))));
                        const double lobe = shared::specularNormalization(8, WEDGE_BLINN_PHONG) * std::pow(c, 8);
                        const double f = light.radiance.x * profileAt(light, a, b) * lightArea(light) * g
                            * (0.8 / std::numbers::pi + 0.2 * lobe);
                        total += f;
                        totalSquares += f * f;
                    }
                    expected += total / hostSamples;
                    variance += (totalSquares / hostSamples - std::pow(total / hostSamples, 2)) / hostSamples;
                }
                // Of the runs themselves; and as of independent samples, more than either sampler has, for pixels where
                // light is so rare that the runs may have missed it.
                const double runVariance = std::max(0.0, square[i] - mean[i] * mean[i]) / (runs - 1) + variance;
                const double roughVariance = variance * (1 + static_cast<double>(hostSamples) / (runs * samples));
                const double difference = mean[i] - expected, rounding = 1e-8 * expected * expected + 1e-12;
                worst =
                    std::max(worst, std::fabs(difference) / std::sqrt(std::max(runVariance, roughVariance) + rounding));
                squares.push_back(difference * difference / (runVariance + rounding));
                sum += difference;
                sumVariance += runVariance;
            }
            REQUIRE(squares.size() > 250);
            // Of 432 normal deviates the largest passes 4.9 once in 2000 tests; half of their squares are below 0.455.
            CHECK(worst < 4.9);
            std::ranges::nth_element(squares, squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2));
            CHECK(squares[squares.size() / 2] > 0.3);
            CHECK(squares[squares.size() / 2] < 0.65);
            CHECK(std::fabs(sum) < 4 * std::sqrt(sumVariance));
        }
    });
}

TEST_CASE("an edge through an antialiased pixel is as its filter has it")
{
    // What emits ends 0.3 pixels right of the image's middle.
    constexpr int wide = 16, high = 8;
    constexpr double shift = 0.3, distance = 4;
    const double pixel = 2 * distance * std::tan(0.5 * 45 * 3.14159265358979 / 180) / high;
    onEveryDevice([&](const device::Device& device) {
        SceneBuilder b;
        b.scene.materials[0].emission = glm::vec3(1.0f);
        b.newObject();
        b.quad({ static_cast<float>(shift * pixel - 50), 0, 0 }, { 50, 0, 0 }, { 0, 50, 0 });
        b.camera({ 0, 0, static_cast<float>(distance) }, { 0, 0, 0 });
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const auto& each : std::vector<std::pair<render::PixelFilter, std::function<double(double)>>> {
                 { render::PixelFilter::Box, [](double x) { return std::clamp(x + 0.5, 0.0, 1.0); } },
                 { render::PixelFilter::Gaussian, [](double x) {
                      return std::clamp(
                          0.5 + 0.5 * std::erf(x * std::sqrt(2.0)) / std::erf(3 / std::sqrt(2.0)), 0.0, 1.0);
                  } } }) {
            const render::PixelFilter filter = each.first;
            const std::function<double(double)>& cumulative = each.second;
            for (const render::Method method : { render::Method::MonteCarlo, render::Method::AxisAligned }) {
                render::Settings s =
                    sized(method == render::Method::MonteCarlo ? render::monteCarlo(1024) : render::axisAligned(1024),
                        wide, high);
                s.antialias = true;
                s.pixelFilter = filter;
                const std::vector<float> seen = renderPixels(renderer, s);
                for (int x = 0; x < wide; ++x) {
                    const double expected = cumulative(shift - (x + 0.5 - 0.5 * wide));
                    CAPTURE(x);
                    CAPTURE((filter == render::PixelFilter::Box));
                    CHECK(std::fabs(seen[static_cast<std::size_t>(3 * (4 * wide + x))] - expected) < 0.004);
                }
            }
        }
    });
}
