// Scene files: meshes that deform from shape to shape.

#include <cmath>

#include <doctest/doctest.h>

#include "scene_support.h"

using namespace scene_test;
using wedge::scene::loadScene;
using wedge::scene::Scene;

namespace {

// Two triangles that share the edge from (0, 0, 0) to (0, 0, -1); the shapes bend it.
const std::string faces = "f 1 2 3\nf 1 3 4\n";
const std::string flat = "v 0 0 0\nv 1 0 0\nv 0 0 -1\nv -1 0 0\n" + faces;
const std::string bent = "v 0 1 0\nv 1 0 0\nv 0 1 -1\nv -1 0 0\n" + faces;
const std::string shapes = "[[mesh]]\nfile = 'flat.obj'\n[[mesh.shape]]\ntime = 0\nfile = 'flat.obj'\n"
                           "[[mesh.shape]]\ntime = 2\nfile = 'bent.obj'\n";

std::string write(const TemporaryFolder& folder, const std::string& text)
{
    folder.write("flat.obj", flat);
    folder.write("bent.obj", bent);
    return folder.write("s.toml", text);
}

Scene read(const std::string& text)
{
    const TemporaryFolder folder;
    return loadScene(write(folder, text));
}

std::string refused(const std::string& other, const std::string& keys)
{
    const TemporaryFolder folder;
    folder.write("other.obj", other);
    return errorOf(write(folder, "[[mesh]]\nfile = 'flat.obj'\n[[mesh.shape]]\n" + keys));
}

glm::vec3 atClose(const Scene& s, std::size_t triangle, std::size_t which)
{
    return vectorAt(s.geometry.positionsAtClose, s.geometry.indices[3 * triangle + which]);
}

} // namespace

TEST_CASE("shapes: linear between two, held outside, still without a shutter")
{
    const Scene s = read(shapes + "[shutter]\nopen = 0.5\nclose = 1\n");
    REQUIRE(wedge::scene::geometryMoves(s));
    REQUIRE(s.geometry.positionsAtClose.size() == s.geometry.positions.size());
    REQUIRE(s.geometry.normalsAtClose.size() == s.geometry.normals.size());
    CHECK(corner(s.geometry, 0, 0) == glm::vec3(0, 0.25f, 0));
    CHECK(atClose(s, 0, 0) == glm::vec3(0, 0.5f, 0));
    CHECK(atClose(s, 1, 1) == glm::vec3(0, 0.5f, -1));
    CHECK(atClose(s, 0, 1) == glm::vec3(1, 0, 0));
    CHECK(s.geometry.positions.size() == 12); // flat triangles share their vertices
    CHECK(wedge::scene::summary(s).movingTriangles == 2);
    CHECK(atClose(read(shapes + "[shutter]\nopen = 1\nclose = 5\n"), 0, 0) == glm::vec3(0, 1, 0));
    CHECK_FALSE(wedge::scene::geometryMoves(read(shapes)));
    CHECK(corner(read(shapes).geometry, 0, 0) == glm::vec3(0, 0, 0));
    CHECK_FALSE(wedge::scene::geometryMoves(read(shapes + "[shutter]\nopen = 2\nclose = 5\n")));
}

TEST_CASE("shapes under keys and a transform")
{
    const Scene s = read("[shutter]\nclose = 1\n" + shapes
        + "[[mesh.key]]\ntime = 0\n[[mesh.key]]\ntime = 1\ntranslate = [0, 0, 3]\n[mesh.transform]\nscale = 2\n");
    CHECK(corner(s.geometry, 0, 0) == glm::vec3(0, 0, 0));
    CHECK(atClose(s, 0, 0) == glm::vec3(0, 1, 3)); // half way to 1, twice as large, then moved
    CHECK(atClose(s, 0, 1) == glm::vec3(2, 0, 3));
}

TEST_CASE("every shape is smoothed by itself, and normals go from one's to the other's")
{
    const auto smoothed = [&](const std::string& value, const std::string& open = "0") {
        std::string text = "[shutter]\nopen = " + open + "\nclose = 2\n" + shapes;
        text.insert(text.find("[[mesh.shape]]"), "smooth = " + value + "\n");
        return read(text);
    };
    const float half = std::sqrt(0.5f);
    const auto normals = [](const Scene& s, std::size_t triangle, bool close) {
        return vectorAt(close ? s.geometry.normalsAtClose : s.geometry.normals, s.geometry.indices[3 * triangle]);
    };
    const auto near = [](const glm::vec3& a, const glm::vec3& b) { return glm::length(a - b) < 1e-5f; };
    const Scene ridge = smoothed("true"); // at the ridge the two sides' mean, up
    CHECK(ridge.geometry.positions.size() == 3 * 4);
    CHECK(near(normals(ridge, 0, false), { 0, 1, 0 }));
    CHECK(near(normals(ridge, 0, true), { 0, 1, 0 }));
    const Scene crease = smoothed("45"); // flat when it opens, two planes when it closes: its vertices part
    CHECK(crease.geometry.positions.size() == 3 * 6);
    CHECK(smoothed("45", "-1").geometry.positions.size() == 3 * 6); // also when only the flat one counts at first
    CHECK(near(normals(crease, 0, false), { 0, 1, 0 }));
    CHECK(near(normals(crease, 0, true), { half, half, 0 }));
    CHECK(near(normals(crease, 1, true), { -half, half, 0 }));
}

TEST_CASE("shapes with a file's own normals, which may be shared otherwise")
{
    const TemporaryFolder folder;
    folder.write(
        "other.obj", "v 0 0 0\nv 1 0 0\nv 0 0 -1\nv -1 0 0\nvn 1 0 0\nvn 0 1 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n");
    folder.write("first.obj", "v 0 0 0\nv 1 0 0\nv 0 0 -1\nv -1 0 0\nvn 0 1 0\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n");
    const Scene s = loadScene(write(folder,
        "[shutter]\nclose = 0.5\n[[mesh]]\nfile = 'first.obj'\nshape = [{ time = 0, file = 'first.obj' }, "
        "{ time = 1, file = 'other.obj' }]\n"));
    REQUIRE(wedge::scene::geometryMoves(s)); // the normals alone
    CHECK(s.geometry.positionsAtClose == s.geometry.positions);
    CHECK(vectorAt(s.geometry.normals, s.geometry.indices[0]) == glm::vec3(0, 1, 0));
    const float half = std::sqrt(0.5f);
    CHECK(glm::length(vectorAt(s.geometry.normalsAtClose, s.geometry.indices[0]) - glm::vec3(half, half, 0)) < 1e-6f);
    CHECK(vectorAt(s.geometry.normalsAtClose, s.geometry.indices[3]) == glm::vec3(0, 1, 0));
    CHECK(wedge::scene::summary(s).movingTriangles == 0);
}

TEST_CASE("shapes that do not fit the mesh are told with both counts")
{
    CHECK(refused("v 0 0 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n", "time = 0\nfile = 'other.obj'\n")
        == "scene file s.toml:5:8: file of mesh.shape has not the triangles of the mesh: 3 vertices and 1 triangles, "
           "the mesh has 4 vertices and 2 triangles: give shapes that differ in their vertices' places and normals "
           "alone");
    CHECK(
        contains(refused("v 0 0 0\nv 1 0 0\nv 0 0 -1\nv -1 0 0\nf 1 2 3\nf 4 1 3\n", "time = 0\nfile = 'other.obj'\n"),
            "has not the triangles of the mesh: triangle 2 of 2 has other corners"));
    CHECK(contains(refused("", "time = 0\nfile = 'none.obj'\n"), "mesh file not found: none.obj"));
    CHECK(contains(refused("", "time = 0\nfile = 'a.ply'\n"), "file of mesh.shape has an unknown format"));
    CHECK(contains(refused("", "time = 0\n"), "mesh.shape lacks a key: file"));
    CHECK(contains(refused("", "file = 'flat.obj'\n"), "mesh.shape lacks a key: time"));
    CHECK(contains(refused("", "time = 0\nfile = 'flat.obj'\nsmooth = true\n"), "unknown key in mesh.shape: 'smooth'"));
    CHECK(contains(refused("", "time = 1\nfile = 'flat.obj'\n[[mesh.shape]]\ntime = 1\nfile = 'bent.obj'\n"),
        "s.toml:7:8: time of mesh.shape is not after that of the key before: 1 and 1"));
}
