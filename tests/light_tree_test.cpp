// The tree of a map's parts, and what kernels sum over it: by brute force over all places, in double.
#include "effects/shadow_lights/light_tree.h"
#include "kernels/shared/bsdf.h"
#include "kernels/shared/shadow_lights.h"
#include "tests/map_directions.h"
#include "tests/pass_bench.h"

#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 45, height = 31;

struct Part {
    glm::dvec3 irradiance, towards;
    double variance;
    std::size_t count;
};

Part partOf(const std::vector<float>& tree, std::size_t index)
{
    const float* p = tree.data() + index * WEDGE_TREE_FLOATS;
    return { { p[0], p[1], p[2] }, { p[3], p[4], p[5] }, p[6], static_cast<std::size_t>(p[7]) };
}

/// Noise over six decades, a lamp of one texel, a black band, turned.
std::shared_ptr<render::EnvironmentPicture> varied(int columns, int rows)
{
    auto p = even(glm::vec3(0), columns, rows);
    std::mt19937 random(1);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const double bright = y == rows / 3 ? 0.0 : std::pow(10.0, uniform(random, -2, 2));
            set(*p, x, y, bright * glm::dvec3(uniform(random), uniform(random), uniform(random)));
        }
    set(*p, columns / 2, rows / 4, { 8000, 6000, 4000 });
    p->right = { 0.8f, 0, -0.6f };
    p->back = { 0.6f, 0, 0.8f };
    return p;
}

/// Of fine texels: a slope, and a lamp that is wider than they are.
std::shared_ptr<render::EnvironmentPicture> smooth()
{
    auto p = even(glm::vec3(0), 256, 128);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) {
            const double across = (x - 70) / 5.0, down = (y - 40) / 5.0;
            set(*p, x, y, glm::dvec3(0.2 + 0.004 * (128 - y) + 60 * std::exp(-across * across - down * down)));
        }
    return p;
}

scene::Scene under(
    const std::shared_ptr<render::EnvironmentPicture>& map, scene::SpecularModel model, float exponent, float roughness)
{
    scene::Scene scene = smallScene();
    scene.areaLights.clear();
    scene.materials[0].specular = { 0.1f, 0.2f, 0.3f };
    scene.materials[0].specularModel = model;
    scene.materials[0].exponent = exponent;
    scene.materials[0].roughness = roughness;
    render::setEnvironment(scene, map);
    return scene;
}

render::Settings settings()
{
    render::Settings s = sized(render::monteCarlo(4), width, height);
    s.environment.shadows = { render::Shadows::Ratio, 14, render::WholeLight::Map, true };
    return s;
}

/// Errors over the image: root of the mean square, and the mean, over the mean of what is right.
struct Off {
    double rms = 0, mean = 0;
};

Off offOf(const std::vector<double>& found, const std::vector<double>& right)
{
    double squares = 0, difference = 0, sum = 0;
    for (std::size_t i = 0; i < right.size(); ++i) {
        squares += (found[i] - right[i]) * (found[i] - right[i]);
        difference += found[i] - right[i];
        sum += right[i];
    }
    const auto n = static_cast<double>(right.size());
    return { std::sqrt(squares / n) / (sum / n), difference / sum };
}

struct Whole {
    std::vector<double> matt, mattRight, lobes, lobesRight; ///< green
    std::size_t black = 0; ///< pixels that do not reflect, and have nothing
};

/// What wholeLight makes of a scene's surfaces, and what all directions of the map bring, one by one.
Whole wholeOf(const device::Device& device, const scene::Scene& scene, int times)
{
    DeclaredFrame frame(device, scene, settings());
    PassBench primary(frame, "primary"), whole(frame, "wholeLight");
    primary.run();
    const std::size_t size = frame.layout.size;
    for (const char* name : { "position", "normal", "origin" })
        whole.plane(name, primary.read<float>(name));
    for (const char* name : { "geometric", "objectId", "gloss" })
        whole.plane(name, primary.read<std::uint32_t>(name));
    std::vector<float> reflected(3 * size, 1.0f);
    for (std::size_t i = 0; i < size; i += 3)
        reflected[i] = reflected[size + i] = reflected[2 * size + i] = 0;
    whole.plane("specular", reflected);
    const render::EnvironmentPicture& map = *frame.scene().picture();
    whole.plane("tree", render::lightTree(render::mapPlaces(map)));
    const std::vector<render::MapLight> directions = directionsOf(map, times);
    for (const char* name : { "wholeMatt", "whole" })
        whole.plane(name, std::vector<float>(3 * size, 0.0f));
    whole.run();
    const auto object = whole.pixels<std::uint32_t>("objectId"), gloss = whole.pixels<std::uint32_t>("gloss");
    const auto normal = whole.pixels<float>("normal"), position = whole.pixels<float>("position");
    const auto matt = whole.pixels<float>("wholeMatt"), lobes = whole.pixels<float>("whole");
    const auto reflects = whole.pixels<float>("specular");
    const glm::dvec3 eye = toGlm(primary.own<shared::FrameParams>("frame").eye);
    const bool microfacets = scene.materials[0].specularModel == scene::SpecularModel::Ggx;
    Whole out;
    everyPixel(frame.layout, [&](int x, int y) {
        if (object.at(x, y) == 0) {
            REQUIRE(matt.at(x, y, 1) == 0);
            return;
        }
        const glm::dvec3 n = normal.vector(x, y), view = glm::normalize(eye - position.vector(x, y));
        const shared::Gloss own =
            microfacets ? shared::unpackMicrofacets(gloss.at(x, y)) : shared::unpackGloss(gloss.at(x, y));
        const shared::Lobe lobe = shared::lobeOf(own);
        const bool glosses = reflects.at(x, y, 1) > 0;
        if (!glosses) {
            REQUIRE(lobes.at(x, y, 1) == 0);
            ++out.black;
        }
        if ((x + 3 * y) % 16 != 0)
            return;
        double ofMatt = 0, ofLobe = 0;
        for (const render::MapLight& direction : directions) {
            const glm::dvec3 l = direction.towards;
            const double cosine = glm::dot(n, l);
            if (cosine <= 0)
                continue;
            ofMatt += cosine / std::numbers::pi * direction.irradiance.y;
            if (glosses)
                ofLobe += cosine * direction.irradiance.y
                    * static_cast<double>(shared::lobeValue(lobe, toVec3(n), toVec3(view), toVec3(l)));
        }
        out.matt.push_back(matt.at(x, y, 1));
        out.mattRight.push_back(ofMatt);
        if (glosses) {
            out.lobes.push_back(lobes.at(x, y, 1));
            out.lobesRight.push_back(ofLobe);
        }
    });
    return out;
}

} // namespace

TEST_CASE("each part of a map's tree has the light of its two halves, and the first all of it")
{
    for (const glm::ivec2& size : { glm::ivec2 { 1, 1 }, glm::ivec2 { 33, 17 }, glm::ivec2 { 700, 30 } }) {
        CAPTURE(size.x);
        const render::MapPlaces places = render::mapPlaces(*varied(size.x, size.y));
        const std::vector<float> tree = render::lightTree(places);
        const std::size_t parts = render::treeParts(places.all.size());
        REQUIRE(tree.size() == parts * WEDGE_TREE_FLOATS);
        glm::dvec3 sum(0);
        for (const render::MapPlace& place : places.all)
            sum += place.irradiance;
        const Part first = partOf(tree, 0);
        CHECK(first.count == parts);
        CHECK(glm::length(first.irradiance - sum) <= 1e-5 * glm::length(sum));
        std::size_t leaves = 0;
        for (std::size_t i = 0; i < parts; ++i) {
            const Part part = partOf(tree, i);
            REQUIRE(i + part.count <= parts);
            REQUIRE(std::abs(glm::length(part.towards) - 1) < 1e-5);
            REQUIRE(part.variance >= 0);
            REQUIRE(part.variance <= 1.01);
            if (part.count == 1) {
                ++leaves;
                continue;
            }
            const Part a = partOf(tree, i + 1), b = partOf(tree, i + 1 + a.count);
            REQUIRE(1 + a.count + b.count == part.count);
            REQUIRE(glm::length(part.irradiance - a.irradiance - b.irradiance)
                <= 1e-5 * (1e-6 + glm::length(part.irradiance)));
        }
        CHECK(leaves == places.all.size());
    }
}

TEST_CASE("a part's middle and variance are of where its light is, not of how large it is")
{
    auto lamp = even(glm::vec3(0), 128, 64);
    set(*lamp, 50, 20, { 3, 3, 3 });
    const std::vector<float> tree = render::lightTree(render::mapPlaces(*lamp));
    const double pi = std::numbers::pi, angle = 2 * pi * (50.5 / 128 - 0.5), down = pi * 20.5 / 64;
    const glm::dvec3 towards(std::sin(down) * std::sin(angle), std::cos(down), -std::sin(down) * std::cos(angle));
    const Part whole = partOf(tree, 0);
    CHECK(glm::dot(whole.towards, towards) > 1 - 1e-6);
    CHECK(whole.variance == doctest::Approx(0.25 * 2 * pi / 128 * pi / 64 * std::sin(down)).epsilon(0.01));
    // From all sides: there is none, and what is left of it is as wide as can be.
    CHECK(partOf(render::lightTree(render::mapPlaces(*even(glm::vec3(1)))), 0).variance > 0.99);
    // Light of the upper half has its middle above, half as far as a single direction.
    auto above = even(glm::vec3(0), 64, 32);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 64; ++x)
            set(*above, x, y, glm::dvec3(1));
    const Part half = partOf(render::lightTree(render::mapPlaces(*above)), 0);
    CHECK(half.towards.y > 0.9999);
    CHECK(half.variance == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("wholeLight: sums over parts of the map are those over all of its places")
{
    struct Case {
        std::shared_ptr<render::EnvironmentPicture> map;
        int times;
        scene::SpecularModel model;
        float exponent, roughness;
    };
    using scene::SpecularModel;
    const auto noise = varied(64, 32), few = spotted(), slope = smooth();
    const Case cases[] = { { noise, 4, SpecularModel::Phong, 40, 0 }, { noise, 4, SpecularModel::Phong, 2, 0 },
        { noise, 4, SpecularModel::BlinnPhong, 90, 0 }, { noise, 4, SpecularModel::Ggx, 1, 0.5f },
        { few, 8, SpecularModel::Phong, 40, 0 }, { few, 8, SpecularModel::Ggx, 1, 0.5f },
        { slope, 1, SpecularModel::Phong, 300, 0 }, { slope, 1, SpecularModel::BlinnPhong, 1000, 0 },
        { slope, 1, SpecularModel::Ggx, 1, 0.3f } };
    onEveryDevice([&](const device::Device& device) {
        for (const Case& c : cases) {
            CAPTURE(c.exponent);
            CAPTURE(c.roughness);
            CAPTURE(c.map->width);
            const Whole whole = wholeOf(device, under(c.map, c.model, c.exponent, c.roughness), c.times);
            REQUIRE(whole.lobes.size() > 30);
            CHECK(whole.black > 100);
            const Off matt = offOf(whole.matt, whole.mattRight), lobes = offOf(whole.lobes, whole.lobesRight);
            CHECK(matt.rms < 0.006);
            CHECK(std::abs(matt.mean) < 0.003);
            CHECK(lobes.rms < 0.02);
            CHECK(std::abs(lobes.mean) < 0.015);
        }
    });
}

TEST_CASE("wholeLight: matt surfaces that face the black half of a map are black")
{
    onEveryDevice([](const device::Device& device) {
        auto below = even(glm::vec3(0), 64, 32);
        for (int y = 16; y < 32; ++y)
            for (int x = 0; x < 64; ++x)
                set(*below, x, y, glm::dvec3(1));
        const scene::Scene scene = under(below, scene::SpecularModel::Phong, 30, 0);
        DeclaredFrame frame(device, scene, settings());
        PassBench primary(frame, "primary"), whole(frame, "wholeLight");
        primary.run();
        const std::size_t size = frame.layout.size;
        for (const char* name : { "position", "origin" })
            whole.plane(name, primary.read<float>(name));
        std::vector<float> up(3 * size, 0.0f);
        std::fill(
            up.begin() + static_cast<std::ptrdiff_t>(size), up.begin() + static_cast<std::ptrdiff_t>(2 * size), 1.0f);
        whole.plane("normal", up);
        for (const char* name : { "geometric", "gloss" })
            whole.plane(name, primary.read<std::uint32_t>(name));
        whole.plane("objectId", std::vector<std::uint32_t>(size, 1));
        whole.plane("specular", std::vector<float>(3 * size, 0.0f));
        whole.plane("tree", render::lightTree(render::mapPlaces(*frame.scene().picture())));
        for (const char* name : { "wholeMatt", "whole" })
            whole.plane(name, std::vector<float>(3 * size, 0.0f));
        whole.run();
        const auto matt = whole.pixels<float>("wholeMatt");
        everyPixel(frame.layout, [&](int x, int y) { REQUIRE(matt.at(x, y, 1) < 0.01f); });
    });
}
