// Warnings: at most ten of a kind, each a line that a terminal can show.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>

#include "host/scene/warnings.h"
#include "scene_support.h"

using namespace scene_test;
using wedge::scene::loadScene;
using wedge::scene::Scene;
using wedge::scene::Warnings;

TEST_CASE("ten of a kind, then how many more, in the order in which they came")
{
    Warnings warnings;
    warnings.add("others", "first");
    for (int i = 0; i < 25; ++i)
        warnings.add("faces", "face " + std::to_string(i));
    warnings.add("others", "last");
    const std::vector<std::string> lines = warnings.lines();
    REQUIRE(lines.size() == 13);
    CHECK(lines[0] == "first");
    CHECK(lines[1] == "face 0");
    CHECK(lines[10] == "face 9");
    CHECK(lines[11] == "... and 15 more about faces");
    CHECK(lines[12] == "last");
    Warnings ten;
    for (int i = 0; i < 10; ++i)
        ten.add("faces", "face");
    CHECK(ten.lines().size() == 10);
}

TEST_CASE("lines are printable and short")
{
    Warnings warnings;
    warnings.add("names", "a\x1b[2Jb\nc" + std::string(1'000'000, 'x'));
    const std::vector<std::string> lines = warnings.lines();
    REQUIRE(lines.size() == 1);
    CHECK(lines[0].starts_with("a\\x1b[2Jb\\nc"));
    CHECK(lines[0].size() <= 400);
}

TEST_CASE("files that give thousands of warnings give tens of lines")
{
    const TemporaryFolder folder;
    std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", library;
    for (int i = 0; i < 3000; ++i) {
        faces += fmt::format("usemtl A{0}\nf 1 2 3\nf 1 2 1\nusemtl none{0}\nf 3 2 1\n", i);
        library += fmt::format("newmtl a{0}\nKd 1 1 -1\nKs 1 1 1\nNs x\nmap_Kd none{0}.png\nd 0.5\n", i);
    }
    folder.write("m.mtl", library);
    folder.write("m.obj", "mtllib m.mtl\n" + faces);
    std::string text = mesh;
    for (int i = 0; i < 300; ++i)
        text += "[[light]]\ntype = \"quad\"\ncorner = [0, 0, 0]\nedge1 = [1, 0, 0]\nedge2 = [1, 1, 0]\nradiance = 1\n"
                "[[material]]\nname = \""
            + std::to_string(i) + "\"\ndiffuse = 1\nspecular = 1\n";
    const Scene scene = loadScene(folder.write("s.toml", text));
    CHECK(scene.warnings.size() < 120);
    CHECK(warns(scene, "... and 2990 more about materials that are not found"));
    CHECK(warns(scene, "... and 2990 more about materials whose names differ in case"));
    CHECK(warns(scene, "... and 5990 more about values of material files"));
    CHECK(warns(scene, "... and 2990 more about faces without area"));
    CHECK(warns(scene, "... and 290 more about lights' edges"));
    CHECK(warns(scene, "m.obj:8: face of 3 corners has no area"));
    CHECK(std::all_of(
        scene.warnings.begin(), scene.warnings.end(), [](const std::string& line) { return line.size() <= 400; }));
}

TEST_CASE("what is said is true also where something else makes up for it")
{
    CHECK(warns(load(mesh), "no light, surfaces stay black but with --integrator ao"));
    CHECK(!warns(load(mesh + "[integrator]\ntype = \"ao\"\n"), "no light"));
    const TemporaryFolder folder;
    folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 2 1 0\nf 1 2 3\n");
    const std::string shape = "[[mesh.shape]]\ntime = 0\nfile = \"open.obj\"\n";
    CHECK(warns(wedge::scene::loadScene(folder.write("s.toml", mesh)), "nothing of it is seen"));
    CHECK(!warns(wedge::scene::loadScene(folder.write("s.toml", mesh + shape)), "nothing of it is seen"));
}
