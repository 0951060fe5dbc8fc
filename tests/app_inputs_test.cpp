// No file that was read for a call is written by it, whatever kind of input it is and whatever path leads there.
#include "tests/app_testing.h"

#include <sys/stat.h>

namespace wedge::app::test {
namespace {

namespace fs = std::filesystem;

const std::string refused = "wedge: error: output is a file that is read, ";

/// A folder with a scene of all kinds of input: a mesh with a library and a texture, a map, a folder of kernels, and a
/// picture to compare with.
class Inputs : public Workplace {
public:
    Inputs()
    {
        write("s.toml", camera + light + "[environment]\nmap = \"map.exr\"\n[[mesh]]\nfile = \"m.obj\"\n");
        write("m.obj",
            "mtllib m.mtl\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nvt 0 0\nvt 0 1\nvt 1 1\nvt 1 0\nusemtl a\n"
            "f 1/1 2/2 3/3 4/4\n");
        write("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd t.png\n");
        picture({ "-o", "map.exr" }, "16x8");
        picture({ "-o", "t.png", "-o", "reference.exr" }, "16x12");
        fs::create_directories(path() / "k" / "frame");
        fs::copy_file(WEDGE_SOURCE_DATA "/../kernels/frame/primary.cl", path() / "k" / "frame" / "primary.cl");
        fs::create_directory(path() / "d");
    }

    Outcome call(const Arguments& more) const
    {
        Arguments arguments = { "render", "s.toml", "--size", "16x12", "--method", "mc", "--spp", "1" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }

    /// The call is wrong, names input and output, and leaves everything as it was.
    void checkRefused(const Arguments& more, const std::string& input, const std::string& output,
        const std::string& remedy = "give it a name of its own") const
    {
        CAPTURE(output);
        const std::vector<std::string> before = files();
        const std::string bytes = text(input);
        const Outcome outcome = call(more);
        CAPTURE(outcome.err);
        CHECK(outcome.status == wrongCall);
        CHECK(outcome.err.starts_with(refused));
        CHECK(std::ranges::count(outcome.err, '\n') == 1);
        CHECK(contains(outcome.err, fs::path(input).filename().string() + ": " + output + ": " + remedy));
        CHECK(text(input) == bytes);
        CHECK(files() == before);
    }

private:
    void picture(const Arguments& outputs, const std::string& size) const
    {
        Arguments arguments = { "render", box, "--size", size, "--method", "mc", "--spp", "1", "--quiet" };
        arguments.insert(arguments.end(), outputs.begin(), outputs.end());
        REQUIRE(run(arguments).status == 0);
    }
};

TEST_CASE("the outputs of a call that names none are none of its inputs")
{
    const Inputs place;
    fs::rename(place.path() / "map.exr", place.path() / "s.exr");
    const std::string scene = place.text("s.toml");
    std::string renamed = scene;
    renamed.replace(renamed.find("map.exr"), 7, "s.exr");
    place.write("s.toml", renamed);
    place.checkRefused({}, "s.exr", "s.exr", "name outputs with -o");
    CHECK(place.call({ "-o", "other.exr" }).status == 0);

    // A picture of ours that is a texture is left out, as one that is not ours.
    fs::rename(place.path() / "s.exr", place.path() / "map.exr");
    place.write("s.toml", scene);
    fs::rename(place.path() / "t.png", place.path() / "s.png");
    place.write("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd s.png\n");
    const std::string texture = place.text("s.png");
    const Outcome outcome = place.call({});
    CHECK(outcome.status == 0);
    CHECK(contains(outcome.err, "wedge: warning: no picture is written, since its file is read"));
    CHECK(place.text("s.png") == texture);
    CHECK(place.has("s.exr"));
    CHECK(place.call({ "--view", "agx" }).status == wrongCall);
    CHECK(place.call({}).status == 0); // an EXR that an earlier call wrote is replaced
}

TEST_CASE("an input is no image, report or drawing, by whatever path")
{
    const Inputs place;
    fs::create_symlink("../map.exr", place.path() / "d" / "link.exr");
    fs::create_hard_link(place.path() / "map.exr", place.path() / "hard.exr");
    fs::create_hard_link(place.path() / "s.toml", place.path() / "hard.json");
    fs::create_directory_symlink("d", place.path() / "e");
    const std::string absolute = (place.path() / "map.exr").string();
    for (const std::string& output : { std::string("map.exr"), std::string("./d/../map.exr"), absolute,
             std::string("d/link.exr"), std::string("e/link.exr"), std::string("hard.exr") }) {
        place.checkRefused({ "-o", output }, "map.exr", output);
        place.checkRefused({ "-o", "a.exr", "--report", output }, "map.exr", output);
    }
    for (const char* input : { "m.obj", "m.mtl", "s.toml" }) {
        place.checkRefused({ "-o", "a.exr", "--report", input }, input, input);
        fs::create_symlink(input, place.path() / "drawing.svg");
        place.checkRefused({ "--explain", "drawing.svg" }, input, "drawing.svg");
        fs::remove(place.path() / "drawing.svg");
    }
    place.checkRefused({ "-o", "a.exr", "--report", "hard.json" }, "s.toml", "hard.json");
    place.checkRefused({ "-o", "t.png" }, "t.png", "t.png");
    place.checkRefused({ "-o", "reference.exr", "--reference", "reference.exr" }, "reference.exr", "reference.exr");
    const Arguments kernels = { "--kernel-dir", "k", "-o", "a.exr", "--report", "k/frame/primary.cl" };
    place.checkRefused(kernels, "k/frame/primary.cl", "k/frame/primary.cl");
}

TEST_CASE("a texture that cannot be decoded is a file of the user's, one that is not there is none")
{
    const Inputs place;
    place.write("t.png", "a photograph that a full disk has cut off");
    place.checkRefused({ "-o", "t.png" }, "t.png", "t.png");
    place.write("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd gone.png\n");
    CHECK(place.call({ "-o", "gone.png" }).status == 0);
    CHECK(place.has("gone.png"));
    if (geteuid() != 0) {
        fs::remove(place.path() / "gone.png");
        place.write("gone.png", "mine");
        fs::permissions(place.path() / "gone.png", fs::perms::owner_write);
        CHECK(place.call({ "-o", "gone.png" }).status == wrongCall);
    }
}

TEST_CASE("a frame of a sequence is none of its inputs, and none is rendered")
{
    const Inputs place;
    fs::rename(place.path() / "map.exr", place.path() / "shot.0003.exr");
    std::string scene = place.text("s.toml");
    scene.replace(scene.find("map.exr"), 7, "shot.0003.exr");
    place.write("s.toml", scene);
    place.checkRefused({ "--frames", "0:4", "-o", "shot.%04d.exr" }, "shot.0003.exr", "shot.0003.exr");
    CHECK(place.call({ "--frames", "0:1", "-o", "shot.%04d.exr" }).status == 0);
    // Frames of an earlier call are looked at and replaced.
    CHECK(place.call({ "--frames", "0:1", "-o", "shot.%04d.exr", "--seed", "3" }).status == 0);
    CHECK(textOf(place.exr("shot.0001.exr"), "seed") == "3");
    place.checkRefused({ "--frames", "0:4", "-o", "shot.%04d.exr" }, "shot.0003.exr", "shot.0003.exr");
}

TEST_CASE("an error map is neither of the images")
{
    const Inputs place;
    fs::create_hard_link(place.path() / "reference.exr", place.path() / "map.png");
    fs::create_hard_link(place.path() / "t.png", place.path() / "hard.png");
    for (const auto& [output, input] :
        { std::pair("map.png", "reference.exr"), std::pair("hard.png", "t.png"), std::pair("t.png", "t.png") }) {
        const std::string bytes = place.text(input);
        const Outcome outcome = place.run({ "compare", "t.png", "reference.exr", "--error-map", output });
        CAPTURE(outcome.err);
        CHECK(outcome.status == wrongCall);
        CHECK(outcome.out == "");
        CHECK(outcome.err.starts_with(refused));
        CHECK(contains(outcome.err, std::string(input) + ": " + output));
        CHECK(place.text(input) == bytes);
    }
    CHECK(place.run({ "compare", "t.png", "reference.exr", "--error-map", "new.png" }).status == 0);
    CHECK(place.run({ "compare", "t.png", "reference.exr", "--error-map", "new.png" }).status == 0);
}

TEST_CASE("devices are outputs as ever")
{
    const Inputs place;
    fs::create_symlink("/dev/null", place.path() / "null.exr");
    CHECK(place.call({ "-o", "null.exr", "--report", "/dev/null" }).status == 0);
    fs::create_symlink("/dev/null", place.path() / "null.svg");
    CHECK(place.call({ "--explain", "null.svg" }).status == 0);
}

} // namespace
} // namespace wedge::app::test
