// Scene files: settings, cameras and lights that are out of range, in themselves or in single precision.

#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "scene_support.h"

using namespace scene_test;
using wedge::scene::Scene;

TEST_CASE("counts and mu of a scene file have the renderer's ranges")
{
    for (const std::string key : { "spp", "max_spp" }) {
        for (const std::string value : { "0", "-1", "1048577", "99999999999" })
            CHECK(contains(error(fmt::format("[integrator]\n{} = {}\n", key, value)),
                fmt::format("{} of integrator is out of range: {}: use 1 to 1048576", key, value)));
        CHECK(error("[integrator]\n" + key + " = 1\n") == "");
        CHECK(error("[integrator]\n" + key + " = 1048576\n") == "");
    }
    for (const std::string value : { "0.0099", "1000.5", "-2" }) {
        const std::string text = error("[integrator]\nmu = " + value + "\n");
        CAPTURE(text);
        CHECK(contains(text, "s.toml:2:6: mu of integrator is out of range: "));
        CHECK(contains(text, ": use 0.01 to 1000"));
    }
    CHECK(*load("[integrator]\nmu = 0.01\n").settings.mu == 0.01f);
    CHECK(*load("[integrator]\nmu = 1000\n").settings.mu == 1000.0f);
    CHECK(contains(
        error("[integrator]\nspp = 20\nmax_spp = 10\n"), "s.toml:3:11: max_spp of integrator is below spp: 10 and 20"));
    CHECK(error("[integrator]\nspp = 20\nmax_spp = 20\n") == "");
}

TEST_CASE("cameras that see nothing")
{
    CHECK(contains(error("[camera]\neye = [1, 2, 3]\nlook_at = [1, 2, 3]\n"),
        "scene file s.toml:1:1: camera looks nowhere, eye and look_at are equal in single precision: [1, 2, 3]: move "
        "one of the two"));
    CHECK(contains(error("[camera]\neye = [0, 1, 0]\nlook_at = [0, 0, 0]\n"), "camera's up is zero or along its view"));
    CHECK(contains(error("[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\nup = [0, 0, 0]\n"), "camera's up is zero"));
    for (const char* fov : { "0", "180", "-3", "179.9999999999", "1e-4" })
        CHECK(contains(error(std::string("[camera]\neye=[0,0,1]\nlook_at=[0,0,0]\nfov=") + fov), "field of view"));
    CHECK(contains(error("[camera]\neye = [0, nan, 1]\nlook_at = [0, 0, 0]\n"), "eye of camera is not finite"));
    CHECK(contains(error("[camera]\nlook_at = [0, 0, 0]\n"), "camera lacks a key: eye"));
}

TEST_CASE("cameras that single precision cannot tell apart from broken ones")
{
    const auto camera = [](const std::string& eye, const std::string& lookAt, const std::string& more = "") {
        return error("[camera]\neye = " + eye + "\nlook_at = " + lookAt + "\n" + more);
    };
    CHECK(
        contains(camera("[1e13, 0, 0]", "[0, 0, 0]"), "s.toml:2:7: eye of camera has a coordinate beyond 1e12: 1e+13"));
    CHECK(contains(
        camera("[0, 0, 1]", "[0, 0, -1e25]"), "s.toml:3:11: look_at of camera has a coordinate beyond 1e12: -1e+25"));
    CHECK(
        contains(camera("[0, 0, 1e-20]", "[0, 0, 0]"), "s.toml:1:1: camera's eye and look_at are too near each other"));
    CHECK(
        contains(camera("[1000, 0, 1e-4]", "[1000, 0, 0]"), "too near each other: 0.0001 m apart: move them 0.001 m"));
    // What is just inside has a direction and a right hand side in single precision too.
    const std::vector<std::pair<std::string, std::string>> sound = { { "[1e12, 1e12, 1e12]", "[0, 0, 0]" },
        { "[1000, 0, 0.002]", "[1000, 0, 0]" }, { "[0, 0, 2e-18]", "[0, 0, 0]" }, { "[0, 0, 1]", "[0, 0, 0]" } };
    for (const auto& place : sound) {
        const auto& [eye, lookAt] = place;
        for (const char* up : { "[0, 1, 0]", "[0, 1e30, 0]", "[0, 1e-30, 0]" }) {
            CAPTURE(place.first);
            CAPTURE(up);
            const Scene s = load(fmt::format("[camera]\neye = {}\nlook_at = {}\nup = {}\n", eye, lookAt, up));
            const glm::vec3 forward = glm::normalize(s.camera.lookAt - s.camera.eye);
            const glm::vec3 right = glm::normalize(glm::cross(forward, s.camera.up));
            CHECK(glm::length(forward) == doctest::Approx(1.0f));
            CHECK(glm::length(right) == doctest::Approx(1.0f));
        }
    }
    // A small mesh far away gets a camera that is not inside its own rounding.
    for (const char* place : { "[1e11, 0, 0]", "[0, 1e12, -1e12]", "[0, 0, 0]" }) {
        CAPTURE(place);
        const Scene s = load(mesh + "transform = [{ scale = 1e-3 }, { translate = " + place + " }]\n");
        CHECK(glm::length(glm::normalize(s.camera.lookAt - s.camera.eye)) == doctest::Approx(1.0f));
    }
}

TEST_CASE("lights that cannot shine")
{
    const std::string quad = "[[light]]\ntype = 'quad'\nradiance = 1\ncentre = [0, 1, 0]\n";
    CHECK(contains(
        error(quad + "half_u = [1, 0, 0]\nhalf_v = [2, 0, 0]\n"), "s.toml:2:8: area light has next to no area"));
    CHECK(contains(error(quad + "half_u = [0, 0, 0]\nhalf_v = [2, 0, 0]\n"), "area light has next to no area"));
    CHECK(contains(error(quad + "half_u = [1, 0, 0]\n"), "light lacks a key: half_v"));
    const std::string whole = quad + "half_u = [1, 0, 0]\nhalf_v = [0, 0, 1]\n";
    CHECK(contains(error(whole + "cut = 0\n"), "light's cut is out of range: 0"));
    CHECK(contains(error(whole + "cut = 100\n"), "light's cut is out of range: 100"));
    CHECK(contains(error(whole + "profile = 'round'\n"), "profile of light is unknown: 'round'"));
    CHECK(contains(error(whole + "halfU = 1\n"), "did you mean 'half_u'?"));
    CHECK(contains(error("[[light]]\ntype = 'quad'\nradiance = 1\n"), "light has no shape"));
    CHECK(contains(error("[[light]]\ntype = 'sun'\n"), "type of light is unknown: 'sun'"));
    CHECK(contains(error("[[light]]\nradiance = 1\n"), "light lacks a key: type"));
    CHECK(contains(
        error("[[light]]\ntype='directional'\ndirection=[0,0,0]\nirradiance=1\n"), "direction of light is zero"));
    CHECK(warns(load(quad + "half_u = [1, 0, 0]\nhalf_v = [1, 0, 1]\n"), "not at right angles"));
}

TEST_CASE("lights beyond single precision")
{
    const auto quad = [](const std::string& centre, const std::string& u, const std::string& v, const char* radiance) {
        return error("[[light]]\ntype = 'quad'\ncentre = " + centre + "\nhalf_u = [" + u + ", 0, 0]\nhalf_v = [0, 0, "
            + v + "]\nradiance = " + radiance + "\n");
    };
    CHECK(quad("[0, 1e12, 0]", "1", "1", "5") == "");
    CHECK(contains(quad("[0, 2e12, 0]", "1", "1", "5"), "s.toml:3:10: centre of light has a coordinate beyond 1e12"));
    CHECK(contains(quad("[0, 1, 0]", "1e13", "1", "5"), "s.toml:4:10: half_u of light has a coordinate beyond 1e12"));
    CHECK(contains(quad("[0, 1, 0]", "1e10", "1e10", "5"), "s.toml:2:8: area light is too large: 4e+20 m^2"));
    CHECK(contains(quad("[0, 1, 0]", "1e-10", "1e-10", "5"), "s.toml:2:8: area light has next to no area"));
    CHECK(contains(
        quad("[0, 1, 0]", "100", "100", "1e29"), "s.toml:2:8: area light is too strong: radiance 1e+29 on 40000 m^2"));
    CHECK(contains(quad("[0, 1, 0]", "1", "1", "inf"), "s.toml:6:12: radiance of light is not finite"));
    CHECK(quad("[0, 1, 0]", "1e9", "1e9", "5") == "");
    CHECK(quad("[0, 1, 0]", "1e-9", "1e-9", "5") == "");
    CHECK(contains(error("[[light]]\ntype='quad'\ncorner=[0,0,-1e14]\nedge1=[1,0,0]\nedge2=[0,0,1]\nradiance=1\n"),
        "s.toml:3:8: corner of light has a coordinate beyond 1e12: -1e+14"));
    CHECK(contains(error("[[light]]\ntype='point'\nposition=[0,1e15,0]\nintensity=1\n"),
        "s.toml:3:10: position of light has a coordinate beyond 1e12: 1e+15"));
}

TEST_CASE("a bare mesh is told when it is too large for a light of its own")
{
    const TemporaryFolder folder;
    const auto withSide = [&](const std::string& side) {
        return errorOf(folder.write("m.obj", "v 0 0 0\nv " + side + " 0 0\nv 0 0 " + side + "\nf 1 3 2\n"));
    };
    CHECK(contains(withSide("1e10"), "mesh file m.obj: mesh is too large for a light of its own: 1.41421e+10 m"));
    CHECK(withSide("1e9") == "");
    CHECK(withSide("1e-9") == "");
}
