// Small files that ask for much: they load, or fail with one line, without much time or memory. The sizes here are such
// that what is quadratic, exponential or recursive does not come back in the time that a test may take.

#include <doctest/doctest.h>

#include "host/scene/geometry_limit.h"
#include "scene_support.h"

using namespace scene_test;
using wedge::scene::loadScene;
using wedge::scene::Scene;

namespace {

std::string repeated(const std::string& part, std::size_t times)
{
    std::string out;
    out.reserve(part.size() * times);
    for (std::size_t i = 0; i < times; ++i)
        out += part;
    return out;
}

/// The parts with their numbers in place of every #.
std::string numbered(const std::string& part, std::size_t times)
{
    std::string out;
    for (std::size_t i = 0; i < times; ++i) {
        for (const char c : part) {
            if (c == '#')
                out += std::to_string(i);
            else
                out += c;
        }
    }
    return out;
}

} // namespace

TEST_CASE("scene files nest so deep and no deeper")
{
    CHECK(error(repeated("a.", 31'000) + "a = 1\n")
        == "scene file s.toml:1:32: key has too many parts: more than 16: nest it less");
    CHECK(
        contains(error(std::string("\n[") + repeated("a . ", 31'000) + "a]\n"), "s.toml:2:64: key has too many parts"));
    CHECK(contains(error(std::string("[[") + repeated("'a'.", 31'000) + "a]]\n"), "key has too many parts"));
    CHECK(contains(error("x = {" + repeated("a.", 31'000) + "a = 1}\n"), "key has too many parts"));
    CHECK(contains(error("x = {b = 1, " + repeated("\"a\".", 31'000) + "a = 1}\n"), "key has too many parts"));
    CHECK(contains(error("a = " + repeated("[", 200'000)), "s.toml:1:21: brackets are nested too deep"));
    CHECK(contains(error("a = " + repeated("{a=", 200'000)), "brackets are nested too deep"));
    CHECK(contains(error("a = '''\n''' \na = \"\\\"\"\nb = " + repeated("[", 40)), "s.toml:4:21: brackets"));
    // The deepest that goes through.
    const std::string parts = repeated("a.", 15) + "a";
    CHECK(contains(error(parts + " = " + repeated("{" + parts + " = ", 16) + "1" + repeated("}", 16)), "unknown key"));
    CHECK(contains(error("a = " + repeated("[", 16) + repeated("]", 16)), "unknown key"));
}

TEST_CASE("dots and brackets that nest nothing")
{
    const std::string dots = repeated(".", 100), brackets = repeated("[{", 100);
    for (const std::string& text : { "# " + dots + brackets + "\n", "[[light]]\nname = \"" + dots + brackets + "\"\n",
             "[[light]]\nname = '" + dots + brackets + "'\n",
             "[[light]]\nname = '''\n" + dots + "'" + brackets + "'''\n",
             "[[light]]\nname = \"\"\"\n\\\"\"\"" + dots + "\n" + brackets + "\"\"\"\"\"\n",
             "[camera]\neye = [" + repeated("1.5, ", 50) + "]\n", repeated("[[light]]\n", 50) }) {
        CAPTURE(text);
        const std::string said = error(text);
        CHECK(!contains(said, "parts"));
        CHECK(!contains(said, "nested"));
        CHECK(!contains(said, "not valid TOML"));
    }
}

TEST_CASE("long names are near nothing, and messages stay short")
{
    const std::string x(400'000, 'x'), y(400'000, 'y');
    const std::string said = error("[[material]]\nname = \"" + x + "\"\n" + mesh + "material = \"" + y + "\"\n");
    CHECK(contains(said, "material of mesh is unknown"));
    CHECK(contains(said, "add a [[material]] of that name"));
    CHECK(said.size() <= 350);
    CHECK(error(std::string(5'000'000, 'k') + " = 1\n").size() <= 350);
    CHECK(contains(error("\"\\u001b[2J\" = 1\n"), "'\\x1b[2J'"));
    CHECK(contains(error("[[materials]]\nname = 'a'\n"), "did you mean 'material'?"));
}

TEST_CASE("thousands of materials, meshes, lights, keys and shapes")
{
    const std::size_t many = 5'000;
    const Scene chosen = load(numbered("[[material]]\nname = \"m#\"\n", many)
        + numbered("[[mesh]]\nfile = \"m.obj\"\nmaterial = \"m#\"\n", many));
    CHECK(chosen.geometry.materialIds.back() == many - 1);
    CHECK(load(mesh + "instances = [" + repeated("{},", 30'000) + "]\n").geometry.objectIds.size() == 30'000);
    CHECK(load(mesh + numbered("[[mesh.shape]]\ntime = #\nfile = \"m.obj\"\n", many)).geometry.indices.size() == 3);
    CHECK(load(mesh + "key = [" + numbered("{time = #},", many) + "]\n").geometry.indices.size() == 3);
    CHECK(load(mesh + repeated("[[light]]\ntype = \"point\"\nposition = [0, 1, 2]\nintensity = 1\n", many))
              .pointLights.size()
        == many);
}

TEST_CASE("more triangles than there may be are refused before they are made")
{
    const TemporaryFolder folder;
    folder.write("m.obj", triangleObj + repeated("f 1 2 3\n", 9'999));
    const std::string copies = mesh + "instances = [" + repeated("{},", 30'000) + "]\n";
    CHECK(errorOf(folder.write("s.toml", copies))
        == "scene file s.toml:2:8: the scene has too many triangles: 0 and 30000 times 10000: use fewer copies, or "
           "simpler meshes; 67108864 is the most");
    CHECK(contains(
        errorOf(folder.write("s.toml", mesh + numbered("[[mesh.shape]]\ntime = #\nfile = \"m.obj\"\n", 9'000))),
        "too many triangles"));
    CHECK(contains(errorOf(folder.write("s.toml", repeated(mesh, 9'000))), "too many triangles"));
    // Few triangles whose objects' names are long.
    const std::string name = "name = \"" + std::string(500'000, 'n') + "\"\n";
    CHECK(contains(errorOf(folder.write("t.toml",
                       "[[mesh]]\nfile = \"o.obj\"\n" + name + "instances = [" + repeated("{},", 100'000) + "]\n")),
        "mesh file not found"));
    folder.write("o.obj", triangleObj);
    CHECK(contains(errorOf(folder.path("t.toml")), "take more than half of the memory"));
    folder.write("o.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + numbered("o #\nf 1 2 3\n", 50'000));
    const std::string instance = "{name = \"" + std::string(500'000, 'n') + "\"},";
    CHECK(contains(
        errorOf(folder.write("t.toml", "[[mesh]]\nfile = \"o.obj\"\ninstances = [" + repeated(instance, 10) + "]\n")),
        "take more than half of the memory"));
}

TEST_CASE("each library is read once, and not too many are looked for")
{
    const TemporaryFolder folder;
    folder.write("m.mtl", numbered("newmtl m#\nKd 0.5\n", 20'000));
    folder.write("m.obj", repeated("mtllib m.mtl ./m.mtl\n", 5'000) + numbered("usemtl M#\n", 20'000) + triangleObj);
    const Scene scene = loadScene(folder.write("s.toml", mesh));
    CHECK(scene.materials.size() == 20'000);
    CHECK(warns(scene, "... and 19990 more about materials whose names differ in case"));
    CHECK(contains(errorOf(folder.write("n.obj", numbered("mtllib #.mtl\n", 5'000) + triangleObj)),
        "mesh file n.obj names too many material libraries: more than 1000: merge them"));
}

TEST_CASE("many corners at one place are smoothed")
{
    const TemporaryFolder folder;
    folder.write("m.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + repeated("f 1 2 3\n", 20'000) + repeated("f 1 4 2\n", 20'000));
    const Scene smooth = loadScene(folder.write("s.toml", mesh + "smooth = true\n"));
    CHECK(glm::distance(vectorAt(smooth.geometry.normals, 0), glm::normalize(glm::vec3(0, 1, 1))) < 1e-5f);
    const Scene creased = loadScene(folder.write("s.toml", mesh + "smooth = 80\n"));
    CHECK(glm::distance(vectorAt(creased.geometry.normals, 0), glm::vec3(0, 0, 1)) < 1e-5f);
}

TEST_CASE("large faces, those too that cross themselves")
{
    const TemporaryFolder folder;
    std::string comb, ring, tangle;
    for (int i = 0; i < 2499; ++i) {
        const std::string x = std::to_string(i);
        comb += "v " + x + " 0 0\nv " + x + ".25 10 0\nv " + x + ".5 10 0\nv " + x + ".75 0 0\n";
    }
    comb += "v 2499 -1 0\nv 0 -1 0\n";
    for (int i = 9998; i > 0; --i)
        ring.append(" ").append(std::to_string(i));
    for (int i = 0; i < 9998; ++i)
        tangle.append(" ").append(std::to_string(i * 7919 % 9998 + 1));
    const Scene whole = loadScene(folder.write("comb.obj", comb + repeated("f" + ring + "\n", 3)));
    CHECK(whole.geometry.indices.size() == 3 * (3 * 9996 + 2));
    CHECK(!warns(whole, "crosses itself"));
    const Scene crossed = loadScene(folder.write("tangle.obj", comb + repeated("f" + tangle + "\n", 3)));
    CHECK(warns(crossed, "tangle.obj:9999: face of 9998 corners crosses itself"));
    CHECK(contains(errorOf(folder.write("big.obj", comb + "f" + ring + " 1 2 3\n")),
        "big.obj:9999: face has too many corners: '10001'"));
}

TEST_CASE("meshes of which nothing is seen")
{
    const TemporaryFolder folder;
    const std::string flat = "v 0 0 0\nv 1 1 1\nv 2 2 2\nv 3 3 3\nf 1 2 3\nf 1 2 3 4\nf 1 2 1 2 1\n";
    CHECK(errorOf(folder.write("m.obj", flat))
        == "mesh file m.obj has nothing to see: no face with an area: repair the mesh");
    const Scene scene = loadScene(folder.write("s.toml", mesh));
    CHECK(warns(scene, "s.toml:2:8: mesh has no triangle with an area, nothing of it is seen"));
    CHECK(warns(scene, "m.obj:6: face of 4 corners has no area"));
    folder.write("m.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 1 2\n");
    CHECK(warns(loadScene(folder.path("s.toml")), "nothing of it is seen"));
}
