// Scene files: the lens, the shutter, and what the keys of cameras and meshes give when it opens and closes.

#include <cmath>

#include <doctest/doctest.h>

#include "scene_support.h"

using namespace scene_test;
using wedge::scene::ApertureProfile;
using wedge::scene::Scene;
using wedge::scene::ShutterProfile;

namespace {

const std::string camera = "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";

std::string shutter(const std::string& open, const std::string& close)
{
    return "[shutter]\nopen = " + open + "\nclose = " + close + "\n";
}

bool near(const glm::vec3& a, const glm::vec3& b) { return glm::length(a - b) < 1e-5f; }

/// Corner 1 of the first triangle, which the mesh file has at (1, 0, 0).
glm::vec3 tip(const Scene& s) { return corner(s.geometry, 0, 1); }
glm::vec3 tipAtClose(const Scene& s)
{
    REQUIRE(wedge::scene::geometryMoves(s));
    return vectorAt(s.geometry.positionsAtClose, s.geometry.indices[1]);
}

} // namespace

TEST_CASE("a lens: none by default, and every key")
{
    const Scene pinhole = load(camera);
    CHECK(pinhole.camera.apertureRadius == 0.0f);
    CHECK(pinhole.camera.focusDistance == 0.0f); // as far as look_at
    CHECK(pinhole.camera.apertureProfile == ApertureProfile::Uniform);
    const Scene lens = load(camera + "aperture = 0.05\nfocus = 3.5\naperture_profile = 'gaussian'\n");
    CHECK(lens.camera.apertureRadius == 0.05f);
    CHECK(lens.camera.focusDistance == 3.5f);
    CHECK(lens.camera.apertureProfile == ApertureProfile::Gaussian);
    CHECK(load(camera + "aperture = 0\naperture_profile = 'uniform'\n").camera.apertureRadius == 0.0f);

    const auto refused = [](const std::string& key) { return error(camera + key + "\n"); };
    CHECK(refused("aperture = -0.5")
        == "scene file s.toml:4:12: aperture of camera is out of range: -0.5: use 0 to 1e+12");
    CHECK(contains(refused("aperture = inf"), "aperture of camera is not finite: inf"));
    CHECK(contains(refused("aperture = 1e13"), "aperture of camera is out of range"));
    CHECK(contains(refused("aperture = 'wide'"), "aperture of camera must be a number"));
    for (const char* focus : { "0", "-2", "1e13" })
        CHECK(contains(refused(std::string("focus = ") + focus), "s.toml:4:9: focus of camera is out of range"));
    CHECK(contains(refused("focus = nan"), "focus of camera is not finite: nan"));
    CHECK(contains(refused("aperture_profile = 'hexagon'"),
        "aperture_profile of camera is unknown: 'hexagon': use one of: uniform, gaussian"));
    CHECK(contains(refused("apperture = 1"), "unknown key in camera: 'apperture': did you mean 'aperture'?"));
}

TEST_CASE("a shutter: closed at time 0 by default, and every key")
{
    const Scene none = load(mesh);
    CHECK(none.shutterOpen == 0.0);
    CHECK(none.shutterClose == 0.0);
    CHECK(none.shutterProfile == ShutterProfile::Box);
    const Scene s = load(mesh + "[shutter]\nopen = -0.5\nclose = 2\nprofile = 'gaussian'\n");
    CHECK(s.shutterOpen == -0.5);
    CHECK(s.shutterClose == 2.0);
    CHECK(s.shutterProfile == ShutterProfile::Gaussian);
    CHECK(load("[shutter]\nclose = 1\nprofile = 'box'\n").shutterOpen == 0.0);
    CHECK(error("[shutter]\nopen = 1\nclose = 1\n") == "");

    CHECK(error("[shutter]\nopen = 1\nclose = 0.5\n")
        == "scene file s.toml:3:9: close of shutter is before open: 0.5 and 1: close it when it opens or later");
    CHECK(contains(error("[shutter]\nopen = 1\n"), "s.toml:1:1: shutter lacks a key: close"));
    CHECK(contains(error("[shutter]\nclose = nan\n"), "close of shutter is not finite"));
    CHECK(contains(error("[shutter]\nclose = 1\nprofile = 'round'\n"), "use one of: box, gaussian"));
    CHECK(contains(
        error("[shutter]\nclosed = 1\nclose = 1\n"), "unknown key in shutter: 'closed': did you mean 'close'"));
    CHECK(contains(error("[[shutter]]\nclose = 1\n"), "shutter of the scene must be one table"));
    CHECK(contains(error("[shuter]\nclose = 1\n"), "unknown key in the scene: 'shuter': did you mean 'shutter'?"));
}

TEST_CASE("camera keys: linear between keys, held outside, and as the camera's own where silent")
{
    const std::string keys = camera
        + "[[camera.key]]\ntime = 1\neye = [0, 0, 4]\n[[camera.key]]\ntime = 3\neye = [2, 0, 4]\nlook_at = [0, 4, 0]\n"
          "up = [0, 0, 2]\n";
    const Scene s = load(keys + shutter("1.5", "9"));
    CHECK(near(s.camera.eye, { 0.5f, 0, 4 }));
    CHECK(near(s.camera.lookAt, { 0, 1, 0 })); // from the camera's own [0, 0, 0] a quarter of the way to [0, 4, 0]
    CHECK(near(s.camera.up, glm::normalize(glm::vec3(0, 0.75f, 0.5f))));
    REQUIRE(wedge::scene::cameraMoves(s));
    CHECK(near(s.cameraAtClose->eye, { 2, 0, 4 }));
    CHECK(near(s.cameraAtClose->lookAt, { 0, 4, 0 }));
    CHECK(near(s.cameraAtClose->up, { 0, 0, 1 }));
    // Where nothing sets the focus it is at look_at as the shutter opens, and stays.
    const float focus = glm::length(glm::vec3(0.5f, -1, 4));
    CHECK(s.camera.focusDistance == doctest::Approx(focus));
    CHECK(s.cameraAtClose->focusDistance == s.camera.focusDistance);
    CHECK(s.cameraAtClose->verticalFov == s.camera.verticalFov);

    const Scene before = load(keys + shutter("-3", "1"));
    CHECK(before.camera.eye == glm::vec3(0, 0, 4));
    CHECK_FALSE(wedge::scene::cameraMoves(before));
    CHECK(before.camera.focusDistance == 0.0f);
    CHECK_FALSE(wedge::scene::cameraMoves(load(keys))); // without a shutter it is time 0
    CHECK(load(keys).camera.eye == glm::vec3(0, 0, 4));
    CHECK_FALSE(wedge::scene::cameraMoves(load(keys + shutter("2", "2"))));
    CHECK(load(keys + shutter("2", "2")).camera.eye == glm::vec3(1, 0, 4));
    const Scene rest = load(camera
        + "[[camera.key]]\ntime = 0\neye = [0.1, 0.2, 0.7]\n[[camera.key]]\ntime = 1\neye = [0.1, 0.2, 0.7]\n"
        + shutter("0.1", "0.7"));
    CHECK_FALSE(wedge::scene::cameraMoves(rest));
    CHECK_FALSE(wedge::scene::cameraMoves(load(camera + shutter("0", "1"))));
}

TEST_CASE("camera keys that are wrong")
{
    const auto refused = [](const std::string& keys) { return error(camera + keys + shutter("0", "1")); };
    const std::string key = "[[camera.key]]\n";
    CHECK(
        refused(key + "eye = [0, 0, 1]\n") == "scene file s.toml:4:1: camera.key lacks a key: time: add 'time = ...'");
    CHECK(contains(refused(key + "time = 1\n" + key + "time = 1\n"),
        "s.toml:7:8: time of camera.key is not after that of the key before: 1 and 1"));
    CHECK(
        contains(refused(key + "time = 1\n" + key + "time = 0.5\n"), "is not after that of the key before: 1 and 0.5"));
    CHECK(contains(refused(key + "time = inf\n"), "time of camera.key is not finite"));
    CHECK(contains(refused(key + "time = 0\neye = [1, 2]\n"), "eye of camera.key must have 3 numbers"));
    CHECK(contains(refused(key + "time = 0\neye = [0, 2e12, 0]\n"), "eye of camera.key has a coordinate beyond 1e12"));
    CHECK(contains(refused(key + "time = 0\nlookat = [0, 0, 0]\n"),
        "s.toml:6:1: unknown key in camera.key: 'lookat': did you mean 'look_at'?"));
    CHECK(contains(refused(key + "time = 0\neye = [0, 0, 0]\n"), "at time 0: camera looks nowhere"));
    CHECK(contains(refused(key + "time = 0\n" + key + "time = 1\nup = [0, 0, 1]\n"), "at time 1: camera's up is zero"));
    CHECK(contains(refused("keys = []\n"), "unknown key in camera: 'keys': did you mean 'key'?"));
}

TEST_CASE("mesh keys: scaled, turned and moved, against positions worked out by hand")
{
    const auto at = [](const std::string& open, const std::string& close, const std::string& keys) {
        return load(mesh + keys + shutter(open, close));
    };
    const std::string move = "key = [{ time = 0 }, { time = 2, translate = [4, 0, 0] }]\n";
    const Scene moved = at("0.5", "1", move);
    CHECK(near(tip(moved), { 2, 0, 0 }));
    CHECK(near(tipAtClose(moved), { 3, 0, 0 }));
    CHECK(vectorAt(moved.geometry.normalsAtClose, 0) == glm::vec3(0, 1, 0));
    CHECK(near(tipAtClose(at("-1", "7", move)), { 5, 0, 0 })); // held after the last key
    CHECK(near(tip(at("-1", "7", move)), { 1, 0, 0 })); // and before the first

    const std::string turn = "key = [{ time = 0 }, { time = 1, rotate = [0, 0, 1, 90] }]\n";
    const Scene turned = at("0", "1", turn);
    CHECK(near(tip(turned), { 1, 0, 0 }));
    CHECK(near(tipAtClose(turned), { 0, 1, 0 }));
    CHECK(near(vectorAt(turned.geometry.normalsAtClose, 0), { -1, 0, 0 }));
    const float half = std::sqrt(0.5f);
    CHECK(near(tipAtClose(at("0", "0.5", turn)), { half, half, 0 })); // at an even speed
    // From 350 to 10 degrees it goes the shorter way, over 0.
    const std::string over = "key = [{ time = 0, rotate = [0, 0, 1, 350] }, { time = 1, rotate = [0, 0, 1, 10] }]\n";
    CHECK(near(tip(at("0.5", "1", over)), { 1, 0, 0 }));

    const std::string grow = "key = [{ time = 0, scale = 2 }, { time = 1, scale = [4, 1, 1] }]\n";
    CHECK(near(tip(at("0", "0.5", grow)), { 2, 0, 0 }));
    CHECK(near(tipAtClose(at("0", "0.5", grow)), { 3, 0, 0 }));
    // Scale, then rotation, then translation; the mesh's transform before them.
    const std::string all = "transform = { translate = [1, 0, 0] }\n"
                            "key = [{ time = 0, scale = 3, rotate = [0, 0, 1, 90], translate = [10, 0, 0] }]\n";
    CHECK(near(tip(load(mesh + all)), { 10, 6, 0 }));
    CHECK_FALSE(wedge::scene::geometryMoves(load(mesh + all)));
}

TEST_CASE("mesh keys: instances come after them, and what rests is at the same places at both ends")
{
    const Scene s = load(mesh + "instances = [{}, { transform = { rotate = [0, 1, 0, 90] } }]\n"
        + "[[mesh.key]]\ntime = 0\n[[mesh.key]]\ntime = 1\ntranslate = [1, 0, 0]\n" + mesh
        + "transform = { translate = [0, 7, 0] }\n" + shutter("0", "1"));
    const auto& g = s.geometry;
    REQUIRE(wedge::scene::geometryMoves(s));
    REQUIRE(g.positionsAtClose.size() == g.positions.size());
    REQUIRE(g.normalsAtClose.size() == g.normals.size());
    CHECK(near(vectorAt(g.positionsAtClose, g.indices[1]), { 2, 0, 0 }));
    CHECK(near(vectorAt(g.positionsAtClose, g.indices[4]), { 0, 0, -2 }));
    CHECK(vectorAt(g.positionsAtClose, g.indices[7]) == glm::vec3(1, 7, 0));
    CHECK(corner(g, 2, 1) == glm::vec3(1, 7, 0));
    const wedge::scene::Summary sum = wedge::scene::summary(s);
    CHECK(sum.movingTriangles == 2);
    CHECK(sum.geometryBytes == 9 * (6 + 3 + 3 + 2) * 4 + 3 * 5 * 4);
    CHECK(near(sum.bounds.lo, { -1, 0, -2 })); // at both ends
    CHECK(near(sum.bounds.hi, { 2, 7, 0 }));

    // The one that rests first, and the moving one second.
    const Scene second =
        load(mesh + mesh + "key = [{ time = 0 }, { time = 1, translate = [0, 0, 3] }]\n" + shutter("0", "1"));
    REQUIRE(second.geometry.positionsAtClose.size() == second.geometry.positions.size());
    CHECK(tipAtClose(second) == glm::vec3(1, 0, 0));
    CHECK(near(vectorAt(second.geometry.positionsAtClose, second.geometry.indices[4]), { 1, 0, 3 }));
    CHECK(wedge::scene::summary(second).movingTriangles == 1);
}

TEST_CASE("motion that goes nowhere is none")
{
    const std::string move = mesh + "key = [{ time = 0 }, { time = 2, translate = [4, 0, 0] }]\n";
    CHECK_FALSE(wedge::scene::geometryMoves(load(move))); // no shutter
    CHECK(tip(load(move)) == glm::vec3(1, 0, 0));
    CHECK_FALSE(wedge::scene::geometryMoves(load(move + shutter("1", "1"))));
    CHECK(near(tip(load(move + shutter("1", "1"))), { 3, 0, 0 }));
    CHECK_FALSE(wedge::scene::geometryMoves(load(move + shutter("2", "5"))));
    CHECK_FALSE(wedge::scene::geometryMoves(load(mesh + shutter("0", "1"))));
    const std::string same = "rotate = [1, 2, 3, 77], translate = [0.1, 0.2, 0.3], scale = 1.7 }";
    const Scene rest =
        load(mesh + "key = [{ time = 0, " + same + ", { time = 1, " + same + "]\n" + shutter("0.1", "0.7"));
    CHECK_FALSE(wedge::scene::geometryMoves(rest));
    CHECK(rest.geometry.normalsAtClose.empty());
    CHECK(wedge::scene::summary(rest).movingTriangles == 0);
}

TEST_CASE("mesh keys that are wrong")
{
    const auto refused = [](const std::string& keys) { return error(mesh + keys + shutter("0", "1")); };
    const std::string key = "[[mesh.key]]\n";
    CHECK(refused(key + "rotate = [0, 1, 0, 90]\n")
        == "scene file s.toml:3:1: mesh.key lacks a key: time: add 'time = ...'");
    CHECK(contains(refused(key + "time = 2\n" + key + "time = 1\n"),
        "s.toml:6:8: time of mesh.key is not after that of the key before: 2 and 1"));
    CHECK(contains(refused(key + "time = 0\nrotate = [0, 0, 0, 90]\n"), "s.toml:5:10: rotate of mesh.key has no axis"));
    CHECK(contains(refused(key + "time = 0\nrotate = [0, 1, 90]\n"), "rotate of mesh.key must have 4 numbers"));
    CHECK(contains(refused(key + "time = 0\nscale = 0\n"), "scale of mesh.key squeezes the mesh flat"));
    CHECK(contains(refused(key + "time = 0\n" + key + "time = 1\nscale = [1, -1, 1]\n"),
        "s.toml:7:9: scale of mesh.key squeezes the mesh flat, at this key or on the way to it: factors 1 and -1"));
    CHECK(error(mesh + key + "time = 0\nscale = [-1, 1, 1]\n") == "");
    CHECK(contains(refused(key + "time = 0\ntranslate = [0, nan, 0]\n"), "translate of mesh.key is not finite"));
    CHECK(contains(refused(key + "time = 0\ntransform = { scale = 2 }\n"), "unknown key in mesh.key: 'transform'"));
    CHECK(contains(refused(key + "time = 0\nrotation = [0, 1, 0, 9]\n"), "did you mean 'rotate'?"));
    CHECK(contains(refused(key + "time = 0\n" + key + "time = 1\ntranslate = [0, 1e13, 0]\n"),
        "s.toml:2:8: a coordinate is beyond 1e12: 1e+13"));
    CHECK(contains(refused("key = [3]\n"), "entry of mesh.key is not a table: 3"));
}
