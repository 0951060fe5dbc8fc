// Suns that are taken out of a map: which, their energy, and what they light.
#include "effects/environment/environment.h"
#include "effects/environment/suns.h"
#include "tests/image_means.h"
#include "tests/render_support.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

const double pi = std::acos(-1.0);

render::EnvironmentPicture grey(int width, int height, float radiance = 1)
{
    render::EnvironmentPicture p;
    p.width = width;
    p.height = height;
    p.radiance.assign(static_cast<std::size_t>(3 * width) * static_cast<std::size_t>(height), radiance);
    return p;
}

std::size_t at(const render::EnvironmentPicture& p, int x, int y)
{
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) + static_cast<std::size_t>(x));
}

void set(render::EnvironmentPicture& p, int x, int y, glm::vec3 radiance)
{
    for (int c = 0; c < 3; ++c)
        p.radiance[at(p, x, y) + static_cast<std::size_t>(c)] = radiance[c];
}

/// The integral of a channel as the lookup shows it, by midpoints of 8 x 8 parts of each texel.
double energy(const render::EnvironmentPicture& p, const std::vector<float>& radiance, int channel)
{
    constexpr int parts = 8;
    double sum = 0;
    for (int i = 0; i < parts * p.height; ++i) {
        const double v = (i + 0.5) / parts - 0.5, sine = std::sin(pi * (v + 0.5) / p.height);
        const int y = static_cast<int>(std::floor(v)), y0 = std::max(y, 0), y1 = std::min(y + 1, p.height - 1);
        const double ty = v - std::floor(v);
        for (int k = 0; k < parts * p.width; ++k) {
            const double u = (k + 0.5) / parts - 0.5;
            const int x = static_cast<int>(std::floor(u)), x0 = (x + p.width) % p.width, x1 = (x + 1) % p.width;
            const double tx = u - std::floor(u);
            const auto of = [&](int cx, int cy) { return radiance[at(p, cx, cy) + static_cast<std::size_t>(channel)]; };
            sum += sine
                * ((1 - ty) * ((1 - tx) * of(x0, y0) + tx * of(x1, y0))
                    + ty * ((1 - tx) * of(x0, y1) + tx * of(x1, y1)));
        }
    }
    return sum * 2 * pi / p.width * pi / p.height / (parts * parts);
}

/// Of a rectangle seen from in front of its middle, by midpoints.
double solidAngle(const render::Sun& sun)
{
    constexpr int parts = 200;
    const double u = glm::length(sun.halfU), v = glm::length(sun.halfV);
    double sum = 0;
    for (int i = 0; i < parts; ++i)
        for (int k = 0; k < parts; ++k) {
            const double x = u * (2 * (i + 0.5) / parts - 1), y = v * (2 * (k + 0.5) / parts - 1);
            sum += std::pow(1 + x * x + y * y, -1.5);
        }
    return sum * 4 * u * v / (parts * parts);
}

/// A sky with a sun of a few texels and colours.
render::EnvironmentPicture sunny(int width = 256, int height = 128)
{
    render::EnvironmentPicture p = grey(width, height, 0.5f);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
            set(p, 80 + x, 28 + y, glm::vec3(900, 800, 500) * (x == 1 && y == 1 ? 2.0f : 1.0f));
    return p;
}

/// A floor with a board above it that shades a part.
SceneBuilder shadedFloor(float half = 2.0f)
{
    SceneBuilder b;
    b.quad({ 0, 0, 0 }, { 0, 0, half }, { half, 0, 0 });
    b.newObject();
    b.box({ -0.3f, 0.2f, -0.3f }, { 0.3f, 0.4f, 0.3f });
    b.camera({ 0, 2.5f, 2.5f }, { 0, 0, 0 });
    return b;
}

/// The scene under the picture, with or without its suns apart.
scene::Scene under(SceneBuilder b, render::EnvironmentPicture picture, bool apart)
{
    if (apart)
        render::separateSuns(picture);
    for (const scene::AreaLight& light : render::sunLights(picture, scene::sceneBounds(b.scene)))
        b.scene.areaLights.push_back(light);
    render::setEnvironment(b.scene, std::make_shared<render::EnvironmentPicture>(std::move(picture)));
    return b.scene;
}

} // namespace

TEST_CASE("a map's one bright texel is its sun, wherever it is")
{
    for (const glm::ivec2 where : { glm::ivec2(20, 9), glm::ivec2(0, 5), glm::ivec2(63, 20), glm::ivec2(7, 0) }) {
        CAPTURE(where.x);
        CAPTURE(where.y);
        render::EnvironmentPicture p = grey(64, 32);
        p.right = { 0, 0, -1 };
        p.back = { 1, 0, 0 };
        set(p, where.x, where.y, { 30000, 20000, 10000 });
        const std::vector<float> before = p.radiance;
        render::separateSuns(p);
        REQUIRE(p.suns.size() == 1);
        CHECK(p.shown == before);
        for (const float c : p.radiance)
            CHECK(c < 2); // as its surroundings
        const shared::EnvironmentMap map = render::environmentTable(&p).map;
        const shared::Vec3 towards = shared::environmentDirection(
            map, (static_cast<float>(where.x) + 0.5f) / 64.0f, static_cast<float>(std::cos(pi * (where.y + 0.5) / 32)));
        CHECK(glm::dot(p.suns[0].towards, glm::vec3(towards.x, towards.y, towards.z)) > 1 - 1e-5f);
        CHECK(p.suns[0].share > (where.y == 0 ? 0.4 : 0.8)); // texels at a pole are small
        // What the lookup makes of a texel's height has a variance of a sixth of its square.
        const auto moment = [](double x, int power) { return std::pow(x, power) * std::exp(-1.125 * x * x); };
        double squares = 0, sum = 0; // of the Gaussian that ends at 1, one and a half standard deviations away
        for (int step = 0; step < 1000; ++step) {
            const double x = 1e-3 * (step + 0.5);
            squares += moment(x, 2);
            sum += moment(x, 0);
        }
        CHECK(glm::length(p.suns[0].halfU) * std::sqrt(squares / sum)
            == doctest::Approx(std::sqrt(1.0 / 6.0) * pi / 32).epsilon(1e-3));
    }
}

TEST_CASE("a map and the suns that were taken out of it have its energy")
{
    render::EnvironmentPicture maps[] = { sunny(), grey(64, 32), grey(64, 32, 0.1f) };
    set(maps[1], 63, 0, { 9000, 9000, 9000 }); // over the pole and the seam
    set(maps[1], 0, 0, { 20000, 9000, 9000 });
    set(maps[2], 10, 12, { 4000, 5000, 6000 }); // two of them
    set(maps[2], 40, 28, { 9000, 5000, 4000 });
    const std::size_t count[] = { 1, 1, 2 };
    for (int i = 0; i < 3; ++i) {
        CAPTURE(i);
        render::EnvironmentPicture& p = maps[i];
        render::separateSuns(p);
        REQUIRE(p.suns.size() == count[i]);
        for (int channel = 0; channel < 3; ++channel) {
            double both = energy(p, p.radiance, channel);
            for (const render::Sun& sun : p.suns)
                both += sun.radiance[channel] * solidAngle(sun);
            CHECK(both == doctest::Approx(energy(p, p.shown, channel)).epsilon(2e-3));
        }
    }
}

TEST_CASE("what is wide, weak, or one of many is no sun")
{
    const auto suns = [](render::EnvironmentPicture p) {
        const std::vector<float> before = p.radiance;
        render::separateSuns(p);
        if (p.suns.empty()) {
            CHECK(p.radiance == before);
            CHECK(p.shown.empty());
        }
        return p.suns.size();
    };
    CHECK(suns(grey(64, 32)) == 0);
    CHECK(suns(grey(1, 1)) == 0);
    CHECK(suns(grey(64, 32, 0)) == 0);
    render::EnvironmentPicture wide = grey(256, 128, 0.001f);
    for (int y = 40; y < 50; ++y)
        for (int x = 100; x < 112; ++x)
            set(wide, x, y, glm::vec3(100));
    CHECK(suns(wide) == 0);
    render::EnvironmentPicture weak = grey(256, 128);
    set(weak, 100, 50, glm::vec3(200));
    CHECK(suns(weak) == 0);
    render::EnvironmentPicture many = grey(256, 128, 0.001f);
    for (int k = 0; k < 40; ++k)
        set(many, 6 * k, 64, glm::vec3(1000));
    CHECK(suns(many) == 0);
    // At most four, of the same size here.
    render::EnvironmentPicture six = grey(256, 128, 0.001f);
    for (int k = 0; k < 6; ++k)
        set(six, 6 * k, 64, glm::vec3(1000));
    CHECK(suns(six) == 4);
}

TEST_CASE("suns taken out light as the map with them did")
{
    // Seeds apart, so that the means are independent.
    onEveryDevice([](const device::Device& device) {
        for (const bool lens : { false, true })
            for (const int bounces : { 0, 1 }) {
                CAPTURE(lens);
                CAPTURE(bounces);
                SceneBuilder b = shadedFloor();
                b.scene.camera.apertureRadius = lens ? 0.02f : 0.0f;
                const auto mean = [&](bool apart) {
                    const scene::Scene lit = under(b, sunny(), apart);
                    render::Renderer renderer(lit, device, renderOptions());
                    constexpr int seeds = 24;
                    double sum = 0, squares = 0;
                    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
                        render::Settings s = sized(render::monteCarlo(64), 32, 32);
                        s.seed = seed + (apart ? 1000 : 0);
                        s.bounces = bounces;
                        const double m = meanOf(renderPixels(renderer, s), 1).value;
                        sum += m;
                        squares += m * m;
                    }
                    const double value = sum / seeds;
                    return Mean { value, std::sqrt(std::max(0.0, squares / seeds - value * value) / (seeds - 1)) };
                };
                const Mean with = mean(true), without = mean(false);
                CAPTURE(with.value);
                CAPTURE(without.value);
                CAPTURE(without.deviation);
                CHECK(std::abs(with.value - without.value) <= 3 * std::hypot(with.deviation, without.deviation));
            }
    });
}

TEST_CASE("a sun's shadow has the sun's own penumbra, and filters are ahead")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene apart = under(shadedFloor(), sunny(), true), whole = under(shadedFloor(), sunny(), false);
        REQUIRE(apart.areaLights.size() == 1);
        render::Renderer with(apart, device, renderOptions()), without(whole, device, renderOptions());
        render::Settings reference = sized(render::monteCarlo(4096), 64, 64);
        reference.seed = 99;
        const std::vector<float> expected = renderPixels(without, reference);
        const std::vector<float> shaped = renderPixels(with, reference);
        reference.seed = 98;
        const double shape = rmse(shaped, expected),
                     noise = rmse(renderPixels(without, reference), expected) / std::sqrt(2.0);
        const double filtered = rmse(renderPixels(with, sized(render::axisAligned(16), 64, 64)), expected);
        const double together = rmse(renderPixels(without, sized(render::axisAligned(16), 64, 64)), expected);
        const double plain = rmse(renderPixels(with, sized(render::monteCarlo(16), 64, 64)), expected);
        MESSAGE("RMSE of the shape: ", shape, ", of the reference: ", noise, ", filtered: ", filtered,
            ", not apart: ", together, ", plain: ", plain);
        CHECK(std::sqrt(std::max(0.0, shape * shape - noise * noise)) < 0.4 * plain); // at 16 samples, of 4096
        CHECK(filtered < 0.7 * plain);
        CHECK(filtered < 0.7 * together);
    });
}

TEST_CASE("shadows keep their colour and their edges on a floor that is thousands of times as large")
{
    // The sun is yellow, the sky blue: what brings light into the shadow brings its colour.
    render::EnvironmentPicture sky = sunny();
    for (int y = 0; y < sky.height; ++y)
        for (int x = 0; x < sky.width; ++x)
            if (sky.radiance[at(sky, x, y)] < 1)
                set(sky, x, y, glm::vec3(0.2f, 0.4f, 1.0f));
    onEveryDevice([&](const device::Device& device) {
        const scene::Scene scene = under(shadedFloor(4000.0f), sky, true);
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings reference = sized(render::monteCarlo(2048), 64, 64);
        reference.seed = 99;
        const std::vector<float> expected = renderPixels(renderer, reference),
                                 filtered = renderPixels(renderer, sized(render::axisAligned(16), 64, 64)),
                                 plain = renderPixels(renderer, sized(render::monteCarlo(16), 64, 64));
        const float lit = *std::ranges::max_element(expected);
        glm::dvec3 is(0), shouldBe(0);
        for (std::size_t i = 0; i < expected.size(); i += 3)
            if (expected[i] < 0.25f * lit)
                for (std::size_t c = 0; c < 3; ++c) {
                    is[static_cast<int>(c)] += filtered[i + c];
                    shouldBe[static_cast<int>(c)] += expected[i + c];
                }
        REQUIRE(shouldBe.z > 10);
        for (int c = 0; c < 3; ++c) {
            CAPTURE(c);
            CHECK(is[c] == doctest::Approx(shouldBe[c]).epsilon(0.03));
        }
        MESSAGE("RMSE: ", rmse(filtered, expected), ", plain: ", rmse(plain, expected));
        CHECK(rmse(filtered, expected) < 0.5 * rmse(plain, expected));
    });
}
