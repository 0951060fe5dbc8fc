// The scenes in data/, the generated ones, and the external ones where WEDGE_DATA has them.

#include <algorithm>
#include <cmath>
#include <optional>

#include <doctest/doctest.h>

#include "data/generator/light_level.h"
#include "data/generator/scene_writer.h"
#include "scene_sound.h"

using namespace scene_test;
using wedge::scene::loadScene;
using wedge::scene::Scene;

namespace {

/// Writes a generated scene, reads it, and checks its size and that everything arrives as it was made.
Scene checkGenerated(const wedge::generator::GeneratedScene& made, std::size_t published)
{
    const TemporaryFolder folder;
    wedge::generator::writeScene(made, folder.path("out"));
    Scene s = loadScene(folder.path("out/" + made.name + ".toml"));
    CAPTURE(made.name);
    CHECK(s.warnings.empty());
    checkSound(s);
    const double count = static_cast<double>(s.geometry.indices.size()) / 3.0;
    CHECK(count == static_cast<double>(made.mesh.triangles()));
    CHECK(std::abs(count - static_cast<double>(published)) <= 0.02 * static_cast<double>(published));
    REQUIRE(s.areaLights.size() == 1);
    CHECK(s.areaLights[0].cut == 2.0f);
    CHECK(s.areaLights[0].profile == made.light.profile);
    CHECK(glm::length(s.areaLights[0].radiance - made.light.radiance) < 1e-4f * glm::length(made.light.radiance));
    CHECK(s.settings.width == 640);
    CHECK(s.settings.height == 480);
    REQUIRE(s.materials.size() == made.materials.size());
    for (const auto& wanted : made.materials) {
        const auto named = [&](const wedge::scene::Material& m) { return m.name == wanted.name; };
        const auto got = std::find_if(s.materials.begin(), s.materials.end(), named);
        REQUIRE(got != s.materials.end());
        CHECK(glm::length(got->diffuse - wanted.diffuse) < 1e-5f);
        CHECK(glm::length(got->specular - wanted.specular) < 1e-5f);
        CHECK(got->exponent == wanted.exponent);
        CHECK(got->specularModel == wedge::scene::SpecularModel::BlinnPhong);
    }
    return s;
}

/// The box's walls come first and look into it; the light looks down from just below the ceiling; all is in view.
void checkCornell(const Scene& s)
{
    const wedge::scene::Bounds bounds = wedge::scene::sceneBounds(s);
    const glm::vec3 middle = 0.5f * (bounds.lo + bounds.hi);
    for (std::size_t t = 0; t < 10; ++t) {
        const glm::vec3 a = corner(s.geometry, t, 0);
        CHECK(glm::dot(glm::cross(corner(s.geometry, t, 1) - a, corner(s.geometry, t, 2) - a), middle - a) > 0.0f);
    }
    CHECK(bounds.lo.y > -0.05f); // what stands on the floor does not reach far through it
    const auto& light = s.areaLights.at(0);
    CHECK(light.profile == wedge::scene::LightProfile::Uniform);
    CHECK(glm::normalize(glm::cross(light.halfU, light.halfV)) == glm::vec3(0, -1, 0));
    const float gap = bounds.hi.y - light.centre.y;
    CHECK(gap > 0.02f);
    CHECK(gap < 0.05f);
    CHECK(s.background == glm::vec3(0.0f));
    const float half = std::tan(glm::radians(0.5f * s.camera.verticalFov)) * (s.camera.eye.z - bounds.hi.z);
    CHECK(s.camera.eye.y - half < 0.0f);
    CHECK(s.camera.eye.y + half > bounds.hi.y);
    CHECK(half * 640.0f / 480.0f > bounds.hi.x);
}

} // namespace

TEST_CASE("generated scenes: the paper's sizes within 2 %, sound, and readable without a warning")
{
    checkGenerated(wedge::generator::makeGrids(), 200);
    checkGenerated(wedge::generator::makeBench(), 309'000);
    checkGenerated(wedge::generator::makeTentacles(), 145'000);
    checkGenerated(wedge::generator::makeSpheres(), 72'000);
}

TEST_CASE("generated Cornell boxes: the paper's sizes within 2 %, a glossy one and a matt one")
{
    const Scene glossy = checkGenerated(wedge::generator::makeCornellGlossy(), 16'700);
    checkCornell(glossy);
    std::size_t shining = 0;
    for (const auto& material : glossy.materials) {
        const glm::vec3 sum = material.diffuse + material.specular;
        CHECK(std::max({ sum.x, sum.y, sum.z }) <= 0.9f);
        if (material.specular == glm::vec3(0.0f))
            continue;
        ++shining;
        CHECK(material.exponent == 12.0f);
    }
    CHECK(shining == 3);
    const Scene figure = checkGenerated(wedge::generator::makeCornellFigure(), 145'000);
    checkCornell(figure);
    for (const auto& material : figure.materials)
        CHECK(material.specular == glm::vec3(0.0f));
}

TEST_CASE("generated scenes are the same in every run")
{
    CHECK(wedge::generator::makeBench().mesh.text() == wedge::generator::makeBench().mesh.text());
    CHECK(wedge::generator::makeTentacles().mesh.text() == wedge::generator::makeTentacles().mesh.text());
    CHECK(wedge::generator::makeCornellFigure().mesh.text() == wedge::generator::makeCornellFigure().mesh.text());
}

TEST_CASE("a generated scene that cannot be written is told")
{
    const TemporaryFolder folder;
    const std::string file = folder.write("file", "");
    CHECK_THROWS_AS(wedge::generator::writeScene(wedge::generator::makeGrids(), file + "/out"), wedge::Error);
}

TEST_CASE("light level: a far light is a point light, a wide uniform one has Lambert's closed form")
{
    wedge::scene::AreaLight far;
    far.centre = { 0, 100, 0 };
    far.halfU = { 0.5f, 0, 0 };
    far.halfV = { 0, 0, 0.5f };
    // The Gaussian's integral: 2 pi sigma^2 erf(cut / sqrt 2)^2, sigma = 0.25.
    const double mass = 2.0 * 3.14159265358979 * 0.0625 * std::pow(std::erf(std::sqrt(2.0)), 2.0);
    CHECK(
        wedge::generator::irradianceOfUnit(far, { 0, 0, 0 }, { 0, 1, 0 }) == doctest::Approx(mass / 1e4).epsilon(1e-3));
    // A parallel square of half side a above its middle at height h: 4 a / sqrt(h^2 + a^2) atan(a / sqrt(h^2 + a^2)).
    wedge::scene::AreaLight wide = far;
    wide.profile = wedge::scene::LightProfile::Uniform;
    wide.centre = { 0, 1, 0 };
    wide.halfU = { 1, 0, 0 };
    wide.halfV = { 0, 0, 1 };
    const double expected = 4.0 / std::sqrt(2.0) * std::atan(1.0 / std::sqrt(2.0));
    CHECK(
        wedge::generator::irradianceOfUnit(wide, { 0, 0, 0 }, { 0, 1, 0 }) == doctest::Approx(expected).epsilon(1e-3));
}

TEST_CASE("the hand-made scenes")
{
    const std::string folder = dataFolder() + "/scenes/";
    const Scene cornell = loadScene(folder + "cornell.toml");
    CHECK(cornell.warnings.empty());
    CHECK(cornell.geometry.indices.size() == 3 * 34);
    CHECK(cornell.areaLights.at(0).profile == wedge::scene::LightProfile::Uniform);
    checkSound(cornell);
    for (std::size_t t = 0; t < 10; ++t) { // the room's faces look into the room
        const glm::vec3 a = corner(cornell.geometry, t, 0);
        const glm::vec3 b = corner(cornell.geometry, t, 1), c = corner(cornell.geometry, t, 2);
        CHECK(glm::dot(glm::cross(b - a, c - a), glm::vec3(0, 1, 0) - a) > 0.0f);
    }

    const Scene materials = loadScene(folder + "materials.toml");
    CHECK(materials.warnings.empty());
    CHECK(materials.textures.size() == 2);
    CHECK(materials.areaLights.size() == 2);
    CHECK(materials.pointLights.size() == 1);
    CHECK(materials.directionalLights.size() == 1);
    checkSound(materials);

    const Scene penumbra = loadScene(folder + "penumbra.toml");
    CHECK(penumbra.warnings.empty());
    checkSound(penumbra);
    const auto& light = penumbra.areaLights.at(0);
    const wedge::scene::Bounds bounds = wedge::scene::sceneBounds(penumbra);
    CHECK(light.centre.y / (light.centre.y - bounds.hi.y) - 1.0f == 1.0f); // the slope its comment states
    CHECK(light.halfU.x / light.cut == 0.25f);
    for (std::size_t i = 0; i < 6; ++i) // the occluder's edge is at x = 0
        CHECK(vectorAt(penumbra.geometry.positions, penumbra.geometry.indices[6 + i]).x <= 0.0f);
}

namespace {

/// The external scene of a file, if WEDGE_DATA has its mesh in `needs`; says so where it has not.
std::optional<Scene> external(const std::string& name, const std::string& needs)
{
    const std::string file = dataFolder() + "/external/" + name + ".toml";
    REQUIRE(std::filesystem::exists(file));
    const char* const data = std::getenv("WEDGE_DATA");
    if (data == nullptr) {
        CHECK(contains(errorOf(file), "environment variable is not set: WEDGE_DATA"));
        MESSAGE("skipped, WEDGE_DATA is not set: " << name);
        return {};
    }
    if (!std::filesystem::exists(data + ("/" + needs))) {
        MESSAGE("skipped, WEDGE_DATA does not hold it: " << name);
        return {};
    }
    CAPTURE(file);
    Scene s = loadScene(file);
    REQUIRE(s.areaLights.size() == 1);
    CHECK(s.settings.width == 640);
    CHECK(s.settings.height == 480);
    return s;
}

} // namespace

TEST_CASE("the external scenes of soft shadows")
{
    for (const std::string name : { "aaf2012_grids", "aaf2012_spheres" }) {
        for (const std::string cut : { "", "_cut2" }) {
            const std::optional<Scene> s = external(name + cut, name);
            if (!s)
                continue;
            CAPTURE(name + cut);
            CHECK(s->warnings.empty());
            CHECK(s->geometry.indices.size() / 3 == (name == "aaf2012_grids" ? 254 : 41446));
            const auto& light = s->areaLights[0];
            CHECK(light.cut == (cut.empty() ? 1.0f : 2.0f));
            CHECK(glm::dot(glm::cross(light.halfU, light.halfV), -light.centre) > 0.0f); // towards the scene
        }
    }
}

TEST_CASE("the external scenes of indirect light: matt, lit from above by a uniform light that looks down")
{
    struct Expected {
        std::string name;
        std::size_t triangles, textures; ///< of Sponza three are masks of cut-outs
        bool flat; ///< has faces without area
    };
    for (const Expected& expected : { Expected { "aaf2013_cornell_bunny", 5110, 0, false },
             Expected { "crytek_sponza", 262'154, 26, true }, Expected { "conference", 331'179, 0, false } }) {
        const std::optional<Scene> s = external(expected.name, expected.name);
        if (!s)
            continue;
        CAPTURE(expected.name);
        CHECK(s->warnings.empty() != expected.flat);
        for (const std::string& warning : s->warnings)
            CHECK(contains(warning, "area"));
        CHECK(s->geometry.indices.size() / 3 == expected.triangles);
        CHECK(s->textures.size() == expected.textures);
        for (const auto& material : s->materials)
            CHECK(material.specular == glm::vec3(0.0f));
        const auto& light = s->areaLights[0];
        CHECK(light.profile == wedge::scene::LightProfile::Uniform);
        CHECK(glm::normalize(glm::cross(light.halfU, light.halfV)) == glm::vec3(0, -1, 0));
        CHECK(4.0f * glm::length(glm::cross(light.halfU, light.halfV)) == 130.0f * 105.0f);
    }
}
