// Meshes, cameras and lights far from the origin, where single precision tells no points apart.

#include <doctest/doctest.h>

#include <cmath>
#include <iomanip>
#include <sstream>

#include "scene_support.h"

using namespace scene_test;
using wedge::scene::Geometry;
using wedge::scene::loadScene;
using wedge::scene::Scene;

namespace {

/// As surveyors have them: metres from the equator, and from a meridian.
constexpr double east = 448265.375, north = 5411931.8125;

/// A wall of panes of 25 cm, as triangles or as quads, moved.
std::string wall(double x, double y, double size = 0.25, bool quads = true)
{
    std::ostringstream out;
    out << std::setprecision(17);
    constexpr int panes = 12;
    for (int row = 0; row <= panes; ++row) {
        for (int column = 0; column <= panes; ++column)
            out << "v " << x + size * column << " " << y + size * row << " " << 0.1 * row << "\n";
    }
    for (int row = 0; row < panes; ++row) {
        for (int column = 0; column < panes; ++column) {
            const int a = row * (panes + 1) + column + 1, b = a + panes + 1;
            if (quads)
                out << "f " << a << " " << a + 1 << " " << b + 1 << " " << b << "\n";
            else
                out << "f " << a << " " << a + 1 << " " << b << "\nf " << a + 1 << " " << b + 1 << " " << b << "\n";
        }
    }
    return out.str();
}

std::string number(double value)
{
    std::ostringstream out;
    out << std::setprecision(17) << value;
    return out.str();
}

std::string translate(double x, double y) { return "{ translate = [" + number(x) + ", " + number(y) + ", 0] }"; }

Scene load(const TemporaryFolder& folder, const std::string& toml)
{
    return loadScene(folder.write("scene.toml", toml));
}

double largestDifference(const Geometry& a, const Geometry& b)
{
    REQUIRE(a.positions.size() == b.positions.size());
    double largest = 0;
    for (std::size_t i = 0; i < a.positions.size(); ++i)
        largest = std::max(largest, std::abs(double { a.positions[i] } - double { b.positions[i] }));
    return largest;
}

const std::string far = "single precision tells points";

} // namespace

TEST_CASE("a mesh that a transform brings to the origin is the mesh that was made there")
{
    for (const bool quads : { true, false }) {
        const TemporaryFolder folder;
        folder.write("near.obj", wall(0, 0, 0.25, quads));
        folder.write("far.obj", wall(east, north, 0.25, quads));
        // A vertex at the origin that no face uses, and one more face there.
        folder.write("stray.obj", "v 0 0 0\n" + wall(east, north, 0.25, quads).substr(0) + "f -3 -2 -1\n");
        const Scene near = load(folder, "[[mesh]]\nfile = \"near.obj\"\n");
        const Scene moved =
            load(folder, "[[mesh]]\nfile = \"far.obj\"\ntransform = " + translate(-east, -north) + "\n");
        CHECK(moved.geometry.indices == near.geometry.indices);
        CHECK(largestDifference(moved.geometry, near.geometry) < 1e-6);
        CHECK(!warns(moved, far));
        CHECK(!warns(moved, "no area"));
        // By an instance, by keys, and in steps that nearly cancel.
        const Scene instance = load(
            folder, "[[mesh]]\nfile = \"far.obj\"\ninstances = [{ transform = " + translate(-east, -north) + " }]\n");
        CHECK(largestDifference(instance.geometry, near.geometry) < 1e-6);
        const Scene keyed = load(folder,
            "[[mesh]]\nfile = \"far.obj\"\n[[mesh.key]]\ntime = 0\ntranslate = [" + number(-east) + ", "
                + number(-north) + ", 0]\n");
        CHECK(largestDifference(keyed.geometry, near.geometry) < 1e-6);
        const Scene there = load(folder,
            "[[mesh]]\nfile = \"near.obj\"\ntransform = [" + translate(east + 0.1, north) + ", "
                + translate(-east, -north) + "]\n");
        CHECK(there.geometry.positions[0] == doctest::Approx(0.1).epsilon(1e-5));
        CHECK(!warns(there, far));
    }
}

TEST_CASE("scale, and smooth normals, of a mesh far away")
{
    const TemporaryFolder folder;
    folder.write("near.obj", wall(0, 0));
    folder.write("far.obj", wall(east, north));
    const std::string smooth = "smooth = true\n";
    const Scene near =
        load(folder, "[[mesh]]\nfile = \"near.obj\"\n" + smooth + "transform = { scale = [0.01, 0.02, 0.01] }\n");
    const Scene scaled = load(folder,
        "[[mesh]]\nfile = \"far.obj\"\n" + smooth + "transform = [{ scale = [0.01, 0.02, 0.01] }, "
            + translate(-0.01 * east, -0.02 * north) + "]\n");
    CHECK(largestDifference(scaled.geometry, near.geometry) < 1e-7);
    double worst = 0;
    for (std::size_t i = 0; i < near.geometry.normals.size(); ++i)
        worst = std::max(worst, std::abs(double { near.geometry.normals[i] } - double { scaled.geometry.normals[i] }));
    CHECK(worst < 1e-5);
}

TEST_CASE("shapes of a mesh far away")
{
    const TemporaryFolder folder;
    folder.write("far.obj", wall(east, north));
    folder.write("later.obj", wall(east + 1, north));
    const Scene scene = load(folder,
        "[shutter]\nopen = 0.5\nclose = 0.5\n[[mesh]]\nfile = \"far.obj\"\ntransform = " + translate(-east, -north)
            + "\n[[mesh.shape]]\ntime = 0\nfile = \"far.obj\"\n[[mesh.shape]]\ntime = 1\nfile = \"later.obj\"\n");
    CHECK(scene.geometry.positions[0] == doctest::Approx(0.5).epsilon(1e-6));
}

TEST_CASE("texture coordinates far out are brought back by whole numbers")
{
    const TemporaryFolder folder;
    const auto texcoords = [&](const std::string& vt) {
        folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + vt + "f 1/1 2/2 3/3\n");
        return load(folder, mesh).geometry.texcoords;
    };
    const std::vector<float> far =
        texcoords("vt 448265.375 -5411931.8125\nvt 448266.625 -5411930\nvt 448265.375 0.25\n");
    CHECK(far[0] == 0.375f);
    CHECK(far[1] == 0.1875f);
    CHECK(far[2] == 1.625f);
    CHECK(far[3] == 2.0f);
    const std::vector<float> near = texcoords("vt 40.5 -3.25\nvt 41 0\nvt 42 0\n");
    CHECK(near[0] == 40.5f);
    CHECK(near[1] == -3.25f);
}

TEST_CASE("a mesh that stays far away is told with the size that is lost")
{
    const TemporaryFolder folder;
    folder.write("far.obj", wall(east, north));
    const Scene scene = load(folder, "[[mesh]]\nfile = \"far.obj\"\n");
    CHECK(warns(scene, "scene.toml:2:8: single precision tells points 0.5 m apart at coordinates of 5.41193e+06 m"));
    CHECK(warns(scene, "of 288 triangles lose their shape"));
    CHECK(!warns(scene, "has no area")); // the file's faces have
    // Of its own faces, not of the box: one more triangle at the origin, and the wall keeps losing.
    folder.write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + wall(east, north));
    CHECK(warns(load(folder, "[[mesh]]\nfile = \"two.obj\"\n"), far));
    // A copy that is carried away, of a mesh at the origin.
    folder.write("near.obj", wall(0, 0));
    CHECK(warns(load(folder, "[[mesh]]\nfile = \"near.obj\"\ntransform = " + translate(east, north) + "\n"), far));
    CHECK(!warns(load(folder, "[[mesh]]\nfile = \"near.obj\"\ntransform = " + translate(2000, 0) + "\n"), far));
    CHECK(!warns(load(folder, "[[mesh]]\nfile = \"near.obj\"\n"), far));
    // Large enough, it loses nothing.
    folder.write("land.obj", wall(east, north, 1e4));
    CHECK(!warns(load(folder, "[[mesh]]\nfile = \"land.obj\"\n"), far));
}

TEST_CASE("long and narrow faces far away keep their shape, or are told")
{
    const TemporaryFolder folder;
    // Strips of 50 m by 30 cm, turned, beside a plate that is as large as a town.
    const auto strips = [&](double x, double y) {
        std::ostringstream out;
        out << std::setprecision(17);
        for (int i = 0; i < 20; ++i) {
            const double left = x + 700.0 * i, low = y + 400.0 * i;
            for (const auto& [u, v] :
                { std::pair(0.0, 0.0), std::pair(50.0, 0.0), std::pair(50.0, 0.3), std::pair(0.0, 0.3) })
                out << "v " << left + 0.8 * u - 0.6 * v << " " << low + 0.6 * u + 0.8 * v << " 0\n";
            out << "f -4 -3 -2 -1\n";
        }
        out << "v " << x << " " << y << " 1\nv " << x + 60 << " " << y << " 1\nv " << x << " " << y + 60
            << " 1\nf -3 -2 -1\n";
        return out.str();
    };
    folder.write("near.obj", strips(0, 0));
    folder.write("far.obj", strips(east, north));
    const Scene near = load(folder, "[[mesh]]\nfile = \"near.obj\"\n");
    const Scene moved = load(folder, "[[mesh]]\nfile = \"far.obj\"\ntransform = " + translate(-east, -north) + "\n");
    CHECK(moved.geometry.indices.size() == near.geometry.indices.size());
    const auto area = [](const Scene& scene) {
        double sum = 0.0;
        for (std::size_t t = 0; t < scene.geometry.indices.size() / 3; ++t) {
            const glm::dvec3 a(corner(scene.geometry, t, 0)), b(corner(scene.geometry, t, 1)),
                c(corner(scene.geometry, t, 2));
            sum += 0.5 * glm::length(glm::cross(b - a, c - a));
        }
        return sum;
    };
    CHECK(area(near) == doctest::Approx(20 * 15 + 1800).epsilon(1e-3)); // which ends 13 km from the origin
    CHECK(area(moved) == doctest::Approx(area(near)).epsilon(1e-3));
    CHECK(!warns(moved, far));
    CHECK(!warns(near, far));
    CHECK(warns(load(folder, "[[mesh]]\nfile = \"far.obj\"\n"), far));
    CHECK(warns(loadScene(folder.path("far.obj")), "is moved by"));
}

TEST_CASE("point lights of a scene far away are told")
{
    const TemporaryFolder folder;
    folder.write("floor.obj", "v -1000 0 -1000\nv 1000 0 -1000\nv 1000 0 1000\nv -1000 0 1000\nf 1 2 3 4\n");
    const auto lit = [&](double y) {
        return load(folder,
            "[[mesh]]\nfile = \"floor.obj\"\ntransform = { translate = [0, " + number(y)
                + ", 0] }\n[[light]]\ntype = \"point\"\nposition = [0, " + number(y + 1.3) + ", 0]\nintensity = 1\n");
    };
    CHECK(warns(lit(5.4e6), "where point light 1 is"));
    CHECK(!warns(lit(0), far));
    CHECK(!warns(lit(5000), far));
}

TEST_CASE("a bare mesh far away is moved with what it gets, and said to be")
{
    const TemporaryFolder folder;
    const Scene near = loadScene(folder.write("near.obj", wall(-1.5, -1.5)));
    const Scene moved = loadScene(folder.write("far.obj", wall(448264.0 - 1.5, 5411932.0 - 1.5)));
    CHECK(warns(
        moved, "the mesh is too far from the origin for single precision, and is moved by [-448264, -5411932, -1] m"));
    CHECK(!warns(near, "moved"));
    REQUIRE(moved.geometry.positions.size() == near.geometry.positions.size());
    for (int axis = 0; axis < 2; ++axis) {
        CHECK(moved.camera.eye[axis] == doctest::Approx(near.camera.eye[axis]).epsilon(1e-4));
        CHECK(moved.areaLights[0].centre[axis] == doctest::Approx(near.areaLights[0].centre[axis]).epsilon(1e-4));
    }
    CHECK(moved.camera.eye.z == doctest::Approx(near.camera.eye.z - 1).epsilon(1e-4));
}

TEST_CASE("cameras and lights far away are told, and lights that keys bring back are exact")
{
    const std::string camera = "[camera]\neye = [" + number(east) + ", " + number(north) + ", 30.1]\nlook_at = ["
        + number(east + 40) + ", " + number(north + 30) + ", 30]\nup = [0, 0, 1]\n";
    const Scene looked = scene_test::load(mesh + camera);
    CHECK(warns(looked,
        "single precision tells points 0.5 m apart at coordinates of 5.41193e+06 m, where the camera's eye is"));
    CHECK(warns(looked, "where the camera's look_at is"));
    CHECK(!warns(scene_test::load(mesh + "[camera]\neye = [0.1, 0.2, 5.3]\nlook_at = [0.1, 0, 0.7]\n"), far));
    const auto quad = [](double x, double y, const std::string& keys) {
        return "[[light]]\ntype = \"quad\"\ncorner = [" + number(x) + ", " + number(y)
            + ", 1.3]\nedge1 = [0.3, 0, 0]\nedge2 = [0, 0.3, 0]\nradiance = 1\n" + keys;
    };
    CHECK(warns(scene_test::load(mesh + quad(east, north, "")), "where the light's middle is"));
    const std::string back =
        "[[light.key]]\ntime = 0\ntranslate = [" + number(-east) + ", " + number(-north) + ", 0]\n";
    const Scene brought = scene_test::load(mesh + quad(east, north, back));
    CHECK(!warns(brought, far));
    CHECK(brought.areaLights[0].centre.x == doctest::Approx(0.15).epsilon(1e-5));
    CHECK(brought.areaLights[0].centre.y == doctest::Approx(0.15).epsilon(1e-5));
    const Scene point = scene_test::load(mesh + "[[light]]\ntype = \"point\"\nposition = [" + number(east + 0.3) + ", "
        + number(north) + ", 2]\nintensity = 1\n" + back);
    CHECK(point.pointLights[0].position.x == doctest::Approx(0.3).epsilon(1e-5));
}
