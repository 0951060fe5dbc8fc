// Meshes: Wavefront OBJ and MTL, good and bad.

#include <doctest/doctest.h>

#include <cmath>

#include "scene_support.h"

using namespace scene_test;
using wedge::scene::loadScene;
using wedge::scene::Scene;

namespace {

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// A scene file around one mesh, so that no floor is added.
Scene loadMesh(const TemporaryFolder& folder, const std::string& obj, const std::string& keys = "")
{
    folder.write("mesh.obj", obj);
    return loadScene(folder.write("scene.toml", "[[mesh]]\nfile = \"mesh.obj\"\n" + keys));
}

std::string objError(const std::string& obj)
{
    const TemporaryFolder folder;
    return errorOf(folder.write("m.obj", obj));
}

double area(const Scene& scene)
{
    double sum = 0.0;
    for (std::size_t t = 0; t < scene.geometry.indices.size() / 3; ++t) {
        const glm::vec3 a = corner(scene.geometry, t, 0);
        sum += 0.5 * glm::length(glm::cross(corner(scene.geometry, t, 1) - a, corner(scene.geometry, t, 2) - a));
    }
    return sum;
}

} // namespace

TEST_CASE("wrong vertices and faces are told with file, line and value")
{
    CHECK(objError("v 0 0 0\nv 1 nan 0\n")
        == "mesh file m.obj:2: vertex coordinate is not a finite number: 'nan': repair the mesh");
    CHECK(contains(objError("v 0 0 -inf\n"), "m.obj:1: vertex coordinate is not a finite number: '-inf'"));
    CHECK(contains(objError("v 0 1e39 0\n"), "m.obj:1: vertex coordinate is not a finite number: '1e39'"));
    CHECK(contains(objError("v 0 1e999999999999 0\n"), "not a finite number: '1e999999999999'"));
    CHECK(contains(objError("# c\n\nv 0 x1 0\n"), "m.obj:3: vertex coordinate is not a number: 'x1'"));
    CHECK(contains(objError("v 0 0 0\nv 1 0"), "m.obj:2: vertex has fewer than 3 coordinates: '2'"));
    CHECK(objError(triangle + "f 1 2 4\n")
        == "mesh file m.obj:4: face has a wrong vertex index: '4': use 1 to 3 or -3 to -1, what is defined before this "
           "line");
    CHECK(contains(objError(triangle + "f 1 2 0\n"), "m.obj:4: face has a wrong vertex index: '0'"));
    CHECK(contains(objError(triangle + "f -1 -2 -4\n"), "m.obj:4: face has a wrong vertex index: '-4'"));
    CHECK(contains(objError(triangle + "f 1 2 99999999999999999999\n"), "wrong vertex index"));
    CHECK(contains(
        objError(triangle + "vt 0 0\nf 1/1 2/2 3/1\n"), "m.obj:5: face has a wrong texture coordinate index: '2/2'"));
    CHECK(contains(objError(triangle + "f 1//1 2//1 3//1\n"),
        "m.obj:4: face has a wrong normal index: '1//1': define a normal before it"));
    CHECK(contains(objError(triangle + "f 1 2 three\n"), "m.obj:4: face corner is not an index: 'three'"));
    CHECK(contains(objError(triangle + "f 1/1/1/1 2 3\n"), "m.obj:4"));
    CHECK(contains(objError("v 0 0 0\r\nv 1 0 0\r\nv nan 0 0\r\n"), "m.obj:3")); // line ends of other systems count one
    CHECK(contains(objError("v 0 0 0\rv nan 0 0\r"), "m.obj:2"));
    CHECK(contains(objError("v 0 \\\n0 0\nv nan 0 0\n"), "m.obj:3")); // so does a continued line's own
}

TEST_CASE("files that are no meshes")
{
    const TemporaryFolder folder;
    CHECK(contains(objError(""), "mesh file m.obj has no faces: it is empty"));
    CHECK(contains(objError(triangle), "mesh file m.obj has no faces"));
    CHECK(contains(objError("Lorem ipsum\nfoo\n"), "has no faces"));
    CHECK(contains(objError(triangle + "f 1 2\nf 1\n"), "m.obj:4: no face has 3 corners: 2 face(s) of fewer"));
    CHECK(contains(objError(std::string("\x7f\x45LF\0\0\1v 0 0 0\n", 15)), "mesh file m.obj holds binary data"));
    CHECK(contains(errorOf(folder.path("none.obj")), "mesh file not found: none.obj"));
    std::filesystem::create_directory(folder.path("folder.obj"));
    CHECK(contains(errorOf(folder.path("folder.obj")), "mesh file is a folder: folder.obj"));
    CHECK(contains(errorOf("/dev/zero.obj"), "not found"));
    CHECK(contains(errorOf(folder.write("a.ply", "ply")), "scene has an unknown format: a.ply"));
    // A sparse file: nothing is stored, nothing must be read.
    const std::string huge = folder.write("huge.obj", triangle);
    std::filesystem::resize_file(huge, (std::uintmax_t { 8 } << 30) + 1);
    CHECK(contains(errorOf(huge), "mesh file is larger than 8589934592 bytes"));
}

TEST_CASE("a truncated mesh never gets through unnoticed or crashes")
{
    const std::string whole = "mtllib m.mtl\n" + triangle + "vt 0 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3/1/1\n";
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const TemporaryFolder folder;
        const std::string file = folder.write("m.obj", whole.substr(0, length));
        // Only the face's last number may lose its tail without making the file wrong.
        CAPTURE(length);
        CHECK((!errorOf(file).empty() || length >= whole.size() - 5));
    }
}

TEST_CASE("faces: relative indices, comments, continued lines, polygons")
{
    const TemporaryFolder folder;
    CHECK(area(loadMesh(folder, triangle + "f -3 -2 -1\n")) == doctest::Approx(0.5));
    CHECK(area(loadMesh(folder, triangle + "f 1 2 3 # first\n")) == doctest::Approx(0.5));
    CHECK(area(loadMesh(folder, triangle + "f 1 \\\n 2 3\n")) == doctest::Approx(0.5));
    CHECK(area(loadMesh(folder, triangle + "f 1/ 2// 3/\n")) == doctest::Approx(0.5));
    CHECK(area(loadMesh(folder, "v +0 .0 0.\nv 1e0 0 0\nv 0 1E+00 1e-60\nf 1 2 3\n")) == doctest::Approx(0.5));
    const Scene quad = loadMesh(folder, triangle + "v 1 1 0\nf 1 2 4 3\n");
    CHECK(quad.geometry.indices.size() == 6);
    CHECK(quad.geometry.positions.size() == 12); // shared corners are one vertex
    CHECK(area(quad) == doctest::Approx(1.0));
    // An L of area 3: a fan from its first corner would cover more.
    const std::string l = "v 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3 4 5 6\n";
    CHECK(area(loadMesh(folder, l)) == doctest::Approx(3.0));
    const Scene dropped = loadMesh(folder, triangle + "f 1 2\nf 1 2 3\n");
    CHECK(dropped.geometry.indices.size() == 3);
    CHECK(warns(dropped, "mesh.obj:4: 1 face(s) of fewer than 3 corners left out"));
}

TEST_CASE("numbers and indices in every spelling mean what they say")
{
    const TemporaryFolder folder;
    const std::string hundreds(300, '0');
    const auto x = [&](const std::string& number) {
        return loadMesh(folder, "v " + number + " 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n").geometry.positions[0];
    };
    CHECK(x("0.1") == 0.1f);
    CHECK(x("+1.5") == 1.5f);
    CHECK(x("-.5") == -0.5f);
    CHECK(x("1.25e+1") == 12.5f);
    CHECK(x("1" + hundreds + "e-299") == 10.0f); // more than a double holds, times as little
    CHECK(x("0." + hundreds + "25e301") == 2.5f);
    CHECK(x("0e999") == 0.0f);
    CHECK(x("1e-400") == 0.0f);
    CHECK(x("0.30000000000000004440892098500626") == 0.3f);
    CHECK(x("16777217") == 16777216.0f);
    // An index that is left out is none, whatever follows.
    const Scene trailing = loadMesh(folder, triangle + "vt 0.5 0.5\nvn 0 0 1\nf 1/1/ 2/1/ 3/1/\nf 1// 2//1 +3/+1/+1\n");
    CHECK(trailing.geometry.indices.size() == 6);
    CHECK(vectorAt(trailing.geometry.normals, trailing.geometry.indices[0]) == glm::vec3(0.0f));
    CHECK(vectorAt(trailing.geometry.normals, trailing.geometry.indices[4]) == glm::vec3(0.0f, 0.0f, 1.0f));
    CHECK(area(loadMesh(folder, "V 0 0 0\nV 1 0 0\nV 0 1 0\nF 1 2 3\n")) == doctest::Approx(0.5));
}

TEST_CASE("large faces and many blocks of lines lose nothing")
{
    const TemporaryFolder folder;
    std::string text;
    constexpr int corners = 700, copies = 200;
    for (int copy = 0; copy < copies; ++copy) {
        for (int i = 0; i < corners; ++i) {
            const double angle = 2 * std::acos(-1.0) * i / corners;
            text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " "
                + std::to_string(copy) + "\n";
        }
        text += "f";
        for (int i = corners; i > 0; --i)
            text += " -" + std::to_string(i);
        text += "\n";
    }
    REQUIRE(text.size() > 3u << 20); // the library gets a MiB at once
    const Scene scene = loadMesh(folder, text);
    CHECK(scene.geometry.indices.size() / 3 == std::size_t { copies } * (corners - 2));
    CHECK(area(scene) == doctest::Approx(copies * std::acos(-1.0)).epsilon(1e-4));
}

TEST_CASE("what of a mesh file has no effect is told once")
{
    const TemporaryFolder folder;
    const Scene colours = loadMesh(folder, "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 0.5 0.5 0.5\nf 1 2 3\n");
    CHECK(warns(colours, "mesh.obj:1: 3 vertices have colours, which have no effect"));
    CHECK(area(colours) == doctest::Approx(0.5));
    const std::string weights = "v 0 0 0 1\nv 1 0 0 1.0 # a b c\nv 0 1 0 1\n";
    CHECK(!warns(loadMesh(folder, weights + "f 1 2 3\n"), "colours"));
    const Scene unknown = loadMesh(folder, "vx 1\n" + triangle + "f 1 2 3\nsurf 0 1 0 1 1 2 3\nl 1 2\ns 1\np 1\n");
    CHECK(warns(unknown, "mesh.obj:1: statement 'vx' is not read here and has no effect; it is the first of 2"));
    CHECK(!warns(loadMesh(folder, triangle + "s off\nl 1 2\np 1\n# note\nlod 1\nf 1 2 3\n"), "statement"));
    CHECK(warns(loadMesh(folder, triangle + "usemtl\nf 1 2 3\n"), "mesh.obj:4: usemtl names no material"));
}

TEST_CASE("normals and texture coordinates that are not finite become zero, with a warning")
{
    const TemporaryFolder folder;
    const Scene scene =
        loadMesh(folder, triangle + "vn nan 0 1\nvn 0 0 3\nvt nan nan\nvt 0.5 0.25\nf 1/1/1 2/2/2 3/2/2\n");
    CHECK(warns(scene, "1 normal(s) are no finite numbers"));
    CHECK(warns(scene, "1 texture coordinate(s) are no finite numbers"));
    CHECK(vectorAt(scene.geometry.normals, 0) == glm::vec3(0.0f));
    CHECK(vectorAt(scene.geometry.normals, 1) == glm::vec3(0.0f, 0.0f, 1.0f)); // made unit length
    CHECK(scene.geometry.texcoords[0] == 0.0f);
    CHECK(scene.geometry.texcoords[2] == 0.5f);
    CHECK(scene.geometry.texcoords[3] == 0.25f);
}

TEST_CASE("objects: groups and objects by name, from 1")
{
    const TemporaryFolder folder;
    const Scene scene = loadMesh(folder, triangle + "f 1 2 3\no a\nf 1 2 3\ng b\nf 1 2 3\no a\nf 1 2 3\n");
    CHECK(scene.geometry.objectNames == std::vector<std::string> { "unnamed", "a", "b" });
    CHECK(scene.geometry.objectIds == std::vector<std::uint32_t> { 1, 2, 3, 2 });
}

TEST_CASE("materials of a library")
{
    const TemporaryFolder folder;
    folder.write("m.mtl",
        "newmtl plain\nKd 0.1 0.2 0.3\nKs 0.4 0.5 0.6\nNs 25\nKe 1 2 3\n"
        "newmtl two words\nKd 0.9 0.9 0.9\nKs 0.2 0.2 0.2\nNs 0\n"
        "newmtl Odd Case\nKd 0.7 0 0\n"
        "newmtl broken\nKd 0.5 -1 0.5\nNs -4\nd 0.5\n");
    const Scene scene = loadMesh(folder,
        "mtllib m.mtl\n" + triangle
            + "f 1 2 3\nusemtl plain\nf 1 2 3\nusemtl two words\nf 1 2 3\nusemtl odd case\nf 1 2 3\n"
              "usemtl nowhere\nf 1 2 3\nusemtl broken\nf 1 2 3\n");
    REQUIRE(scene.geometry.materialIds.size() == 6);
    const auto of = [&](std::size_t t) { return scene.materials[scene.geometry.materialIds[t]]; };
    CHECK(of(0).diffuse == glm::vec3(0.5f));
    CHECK(of(1).diffuse == glm::vec3(0.1f, 0.2f, 0.3f));
    CHECK(of(1).specular == glm::vec3(0.4f, 0.5f, 0.6f));
    CHECK(of(1).emission == glm::vec3(1.0f, 2.0f, 3.0f));
    CHECK(of(1).exponent == 25.0f);
    CHECK(of(2).name == "two words");
    CHECK(of(2).exponent == 0.0f);
    CHECK(of(3).diffuse == glm::vec3(0.7f, 0.0f, 0.0f));
    CHECK(of(4).diffuse == glm::vec3(0.5f));
    CHECK(of(5).diffuse == glm::vec3(0.5f, 0.0f, 0.5f));
    CHECK(of(5).exponent == 1.0f);
    CHECK(warns(scene, "some faces of the mesh have no material"));
    CHECK(warns(scene, "diffuse + specular of 'two words' reaches 1.1"));
    CHECK(warns(scene, "material 'odd case' is taken for 'Odd Case'"));
    CHECK(warns(scene, "material 'nowhere' not found, grey is used"));
    CHECK(warns(scene, "material 'broken': Kd has the value -1, 0 is used"));
    CHECK(warns(scene, "material 'broken': Ns has the value -4, 1 is used"));
    CHECK(of(5).opacity == 0.5f);
}

TEST_CASE("material libraries: missing, several on a line, names with spaces")
{
    const TemporaryFolder folder;
    const Scene missing = loadMesh(folder, "mtllib none.mtl\n" + triangle + "usemtl a\nf 1 2 3\n");
    CHECK(warns(missing, "material file not found"));
    CHECK(warns(missing, "material 'a' not found, grey is used"));
    folder.write("a.mtl", "newmtl a\nKd 1 0 0\n");
    folder.write("b c.mtl", "newmtl b\nKd 0 1 0\n");
    const std::string faces = triangle + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n";
    for (const char* lines : { "mtllib a.mtl\nmtllib b c.mtl\n", "mtllib a.mtl b\\ c.mtl\n",
             "mtllib a.mtl \"b c.mtl\"\n", "mtllib \"a.mtl\"\nmtllib \"b c.mtl\"\n", "mtllib 'a.mtl' 'b c.mtl'\n",
             "MTLLIB a.mtl\nMtlLib b c.mtl\n", "mtllib a.mtl \"b c.mtl\" # by x\n" }) {
        const Scene scene = loadMesh(folder, lines + faces);
        CAPTURE(lines);
        REQUIRE(scene.materials.size() == 2);
        CHECK(!warns(scene, "not found"));
        CHECK(scene.materials[0].diffuse == glm::vec3(1.0f, 0.0f, 0.0f));
        CHECK(scene.materials[1].diffuse == glm::vec3(0.0f, 1.0f, 0.0f));
    }
    folder.write("b's.mtl", "newmtl \"b\"\nKd 0 1 0\n");
    const Scene quoted =
        loadMesh(folder, "mtllib a.mtl b's.mtl\n" + triangle + "usemtl \"a\"\nf 1 2 3\nusemtl b\nf 1 2 3\n");
    CHECK(!warns(quoted, "material"));
    CHECK(quoted.materials[1].diffuse == glm::vec3(0.0f, 1.0f, 0.0f));
    folder.write("a.mtl", std::string("\0\1\2\xff junk \n newmtl \n", 20)); // binary: no material, no crash
    CHECK(warns(loadMesh(folder, "mtllib a.mtl\n" + faces), "material 'a' not found"));
}

TEST_CASE("a scene file chooses another material library, for one mesh and not for its twin")
{
    const TemporaryFolder folder;
    folder.write("own.mtl", "newmtl a\nKd 0.5 0 0\nKs 0.5 0.5 0.5\nnewmtl b\nKd 0 0 1\n");
    folder.write("other.mtl", "newmtl a\nKd 0 1 0\n");
    const std::string faces = "mtllib own.mtl\n" + triangle + "usemtl a\nf 1 2 3\n";
    const Scene twins = loadMesh(folder, faces, "[[mesh]]\nfile = \"mesh.obj\"\nmtl = \"other.mtl\"\n");
    const auto materialOf = [&](std::size_t t) { return twins.materials.at(twins.geometry.materialIds.at(t)); };
    CHECK(materialOf(0).diffuse == glm::vec3(0.5f, 0, 0));
    CHECK(materialOf(1).diffuse == glm::vec3(0, 1, 0));
    CHECK(materialOf(1).specular == glm::vec3(0));
    const Scene lacking = loadMesh(folder, faces + "usemtl b\nf 1 2 3\n", "mtl = \"other.mtl\"\n");
    CHECK(warns(lacking, "material 'b' not found, grey is used"));
    CHECK(contains(errorOf(folder.write("s.toml", "[[mesh]]\nfile = \"mesh.obj\"\nmtl = \"none.mtl\"\n")),
        "material file not found: none.mtl"));
}

TEST_CASE("textures of a library: backslashes, options, missing and broken files")
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path("tex"));
    std::filesystem::copy_file(dataFolder() + "/scenes/textures/tiles.png", folder.path("tex/my tiles.png"));
    folder.write("junk.png", "\x89PNG\r\n junk");
    folder.write("m.mtl",
        "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd tex\\my tiles.png\n"
        "newmtl b\nKd 0 0 0\nmap_Kd -s 2 -blendu on tex/my tiles.png\nmap_Ks none.png\n"
        "newmtl c\nKd 0.5 0.5 0.5\nmap_Ke junk.png\n");
    const Scene scene =
        loadMesh(folder, "mtllib m.mtl\n" + triangle + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n");
    REQUIRE(scene.textures.size() == 1); // the same file is read once
    CHECK(scene.materials[0].diffuseTexture == 0);
    CHECK(scene.materials[1].diffuseTexture == 0);
    CHECK(scene.materials[1].diffuse == glm::vec3(1.0f));
    CHECK(scene.materials[1].specularTexture == -1);
    CHECK(scene.materials[2].emissionTexture == -1);
    CHECK(warns(scene, "material 'b': Kd is black and would hide its texture"));
    CHECK(warns(scene, "material 'b': the option -s of texture"));
    CHECK(warns(scene, "none.png: check the path; the plain colour is used"));
    CHECK(warns(scene, "material 'c': texture file cannot be decoded"));
    // The tile of the image's lower left corner is red: row 0 is the bottom, R the low byte.
    const wedge::scene::Texture& t = scene.textures[0];
    REQUIRE(t.width == 64);
    REQUIRE(t.height == 64);
    const std::uint32_t red = 0xff000000u | 60u << 16 | 70u << 8 | 190u;
    CHECK(t.rgba[5 * 64 + 5] == red);
    CHECK(t.rgba[60 * 64 + 5] != red);
}

TEST_CASE("smooth normals: flat unless asked, by angle, not over the file's own")
{
    const TemporaryFolder folder;
    // Two unit squares that meet at a right angle along the z axis.
    const std::string fold = "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nv 0 -1 0\nv 0 -1 1\nf 1 2 3 4\nf 2 1 5 6\n";
    const auto normalsAt = [](const Scene& scene, const glm::vec3& p) {
        std::vector<glm::vec3> found;
        for (std::size_t i = 0; i < scene.geometry.positions.size() / 3; ++i) {
            if (vectorAt(scene.geometry.positions, i) == p)
                found.push_back(vectorAt(scene.geometry.normals, i));
        }
        return found;
    };
    const auto flat = normalsAt(loadMesh(folder, fold), { 0, 0, 0 });
    REQUIRE(flat.size() == 1);
    CHECK(flat[0] == glm::vec3(0.0f));
    for (const char* key : { "smooth = true\n", "smooth = 90\n" }) {
        const auto smooth = normalsAt(loadMesh(folder, fold, key), { 0, 0, 0 });
        CAPTURE(key);
        REQUIRE(smooth.size() == 1);
        CHECK(glm::length(smooth[0] - glm::normalize(glm::vec3(-1, 1, 0))) < 1e-6f);
    }
    const auto creased = normalsAt(loadMesh(folder, fold, "smooth = 80\n"), { 0, 0, 0 });
    REQUIRE(creased.size() == 2);
    CHECK(creased[0] == glm::vec3(0, 1, 0));
    CHECK(creased[1] == glm::vec3(-1, 0, 0));
    const std::string own = triangle + "vn 0 1 0\nf 1//1 2//1 3//1\n";
    CHECK(normalsAt(loadMesh(folder, own, "smooth = true\n"), { 0, 0, 0 })[0] == glm::vec3(0, 1, 0));
    CHECK(normalsAt(loadMesh(folder, own, "smooth = false\n"), { 0, 0, 0 })[0] == glm::vec3(0));
    // Triangles without area have no normal to give and must not make NaN.
    const Scene sliver = loadMesh(folder, triangle + "f 1 2 3\nf 1 1 2\n", "smooth = true\n");
    for (const float n : sliver.geometry.normals)
        CHECK(std::isfinite(n));
}

TEST_CASE("a bare mesh gets a camera that sees it, a light that shines on it and a floor below")
{
    const TemporaryFolder folder;
    const Scene scene = loadScene(folder.write("m.obj", "o thing\n" + triangle + "f 1 2 3\n"));
    CHECK(scene.geometry.objectNames == std::vector<std::string> { "thing", "floor" });
    CHECK(scene.geometry.indices.size() == 9);
    REQUIRE(scene.areaLights.size() == 1);
    const auto& light = scene.areaLights[0];
    const glm::vec3 centre(0.5f, 0.5f, 0.0f);
    const glm::vec3 facing = glm::normalize(glm::cross(light.halfU, light.halfV));
    CHECK(glm::dot(facing, glm::normalize(centre - light.centre)) == doctest::Approx(1.0));
    const glm::vec3 forward = glm::normalize(scene.camera.lookAt - scene.camera.eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, scene.camera.up));
    const float tangent = std::tan(glm::radians(scene.camera.verticalFov) / 2.0f);
    for (std::size_t i = 0; i < 3; ++i) { // every corner is inside the image
        const glm::vec3 d = vectorAt(scene.geometry.positions, i) - scene.camera.eye;
        const float depth = glm::dot(d, forward);
        CHECK(depth > 0.0f);
        CHECK(std::abs(glm::dot(d, right)) < depth * tangent * 4.0f / 3.0f);
        CHECK(std::abs(glm::dot(d, glm::cross(right, forward))) < depth * tangent);
    }
    CHECK(vectorAt(scene.geometry.positions, 3).y < 0.0f);
}
