// Outputs that can no longer be written when the image is there: what else there is is written, the picture is kept,
// and one line says where. More of them, and those that fail from the start, are in tests/hostile/outputs.cpp.
#include "tests/app_testing.h"

#include <nlohmann/json.hpp>

#include <sys/stat.h>

namespace wedge::app::test {
namespace {

namespace fs = std::filesystem;

const std::string failed = "wedge: error: cannot write file (";

/// A long render to d/a.exr and b.png: while it renders something happens, then it is interrupted.
Outcome renderWhile(const Workplace& place, const std::function<void()>& happens, const Arguments& more = {})
{
    fs::create_directory(place.path() / "d");
    Arguments arguments = { "render", box, "--method", "mc", "--spp", "1000000", "--size", "64x64", "--verbose", "-o",
        "d/a.exr", "-o", "b.png" };
    arguments.insert(arguments.end(), more.begin(), more.end());
    return place.run(arguments, [&](pid_t process) {
        waitUntilRendering(place, process);
        happens();
        kill(process, SIGINT);
    });
}

/// What is in a regular file, and nothing of anything else, which reading might wait for.
std::string readIfFile(const fs::path& path)
{
    std::error_code ignored;
    return fs::is_regular_file(path, ignored) ? readAll(path) : "";
}

/// The name behind "kept as".
std::string rescued(const Outcome& outcome)
{
    const std::string before = "; kept as ";
    const std::size_t at = outcome.err.find(before);
    REQUIRE(at != std::string::npos);
    const std::size_t start = at + before.size();
    return outcome.err.substr(start, outcome.err.find('\n', start) - start);
}

void checkKept(const Workplace& place, const Outcome& outcome, const std::string& name)
{
    CHECK(outcome.status == failure);
    CHECK(contains(outcome.err, failed));
    CHECK(contains(outcome.out, "wrote b.png"));
    CHECK(place.has("b.png"));
    CHECK(rescued(outcome) == name);
    const image::LayeredImage image = image::readExr((place.path() / name).string());
    CHECK(image.width == 64);
    CHECK(std::get<int>(image.metadata.at("complete")) == 0);
}

TEST_CASE("without -o a render is an EXR and a PNG of the scene's name")
{
    const Workplace place;
    const Arguments call = { "render", box, "--size", "16x12", "--method", "mc", "--spp", "1" };
    const auto with = [&call](const Arguments& more) {
        Arguments arguments = call;
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    const Outcome first = place.run(call);
    CHECK(first.status == 0);
    CHECK(first.err == "");
    CHECK(contains(first.out, "wrote cornell.exr\nwrote cornell.png\n"));
    REQUIRE(place.files() == std::vector<std::string> { "cornell.exr", "cornell.png" });

    // What it wrote itself it replaces, also behind a link, and says nothing where it is to be quiet.
    const std::string exr = place.text("cornell.exr"), png = place.text("cornell.png");
    fs::create_directory(place.path() / "d");
    fs::rename(place.path() / "cornell.png", place.path() / "d" / "p.png");
    fs::create_symlink("d/p.png", place.path() / "cornell.png");
    const Outcome again = place.run(with({ "--seed", "5", "--quiet" }));
    CHECK(again.status == 0);
    CHECK(again.out + again.err == "");
    CHECK(place.text("cornell.exr") != exr);
    CHECK(place.text("d/p.png") != png);

    // A picture that is read or reported to is none to write.
    const std::string seeded = place.text("d/p.png");
    CHECK(place.run(with({ "--reference", "d/p.png" })).status == 0);
    CHECK(place.text("d/p.png") == seeded);
    CHECK(place.run(with({ "--report", "cornell.png" })).status == 0);
    CHECK(place.text("d/p.png").starts_with("{"));
}

TEST_CASE("without -o no file is replaced that the program did not write")
{
    const Workplace place;
    const fs::path picture = place.path() / "cornell.png";
    const std::function<void()> others[] = { [&] { place.write("cornell.png", "\x89PNG a photograph"); },
        [&] { fs::create_directory(picture); }, [&] { fs::create_symlink("nowhere", picture); },
        [&] { fs::create_symlink("cornell.png", picture); }, [&] { REQUIRE(mkfifo(picture.c_str(), 0600) == 0); } };
    for (const std::function<void()>& make : others) {
        make();
        const std::string before = readIfFile(picture);
        const Arguments call = { "render", box, "--size", "8x6", "--method", "mc", "--spp", "1" };
        const Outcome outcome = place.run(call);
        CHECK(outcome.status == 0);
        CHECK(contains(outcome.out, "wrote cornell.exr\n"));
        CHECK_FALSE(contains(outcome.out, "cornell.png"));
        CHECK(contains(outcome.err, "wedge: warning: no picture is written"));
        CHECK(contains(outcome.err, "cornell.png: name outputs with -o"));
        CHECK(readIfFile(picture) == before);
        CHECK(place.files() == std::vector<std::string> { "cornell.exr", "cornell.png" });
        fs::remove(picture);
        fs::remove(place.path() / "cornell.exr");
    }
}

TEST_CASE("--view is for PNGs alone")
{
    const Workplace place;
    const auto rendered = [&place](const Arguments& more) {
        Arguments arguments = { "render", box, "--quiet", "--size", "32x24", "--method", "mc", "--spp", "4",
            "--exposure", "2", "-o", "a.exr", "-o", "a.png" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        CHECK(place.run(arguments).status == 0);
        return std::pair(place.exr("a.exr"), place.text("a.png"));
    };
    const auto plain = rendered({}), srgb = rendered({ "--view", "srgb" });
    const auto filmic = rendered({ "--view", "filmic" }), agx = rendered({ "--view=agx" });
    CHECK(srgb.second == plain.second);
    CHECK(filmic.second != plain.second);
    CHECK(agx.second != plain.second);
    CHECK(agx.second != filmic.second);
    for (const auto* other : { &srgb, &filmic, &agx }) {
        for (const char* channel : { "R", "G", "B" }) {
            CHECK(values(other->first, channel) == values(plain.first, channel));
        }
    }
    checkRefused(place, { "render", box, "--view", "aces", "-o", "b.png" }, wrongCall, "aces");
    checkRefused(place, { "render", box, "--view", "agx", "-o", "b.exr" }, wrongCall, "--view: add an output");
}

TEST_CASE("the output's folder disappears")
{
    const Workplace place;
    const Outcome outcome = renderWhile(place, [&] { fs::remove_all(place.path() / "d"); });
    checkKept(place, outcome, "./a-rescued.exr");
    CHECK(contains(outcome.err, failed + "No such file or directory): d/a.exr: "));
    CHECK(contains(outcome.out, "wrote ./a-rescued.exr"));
    CHECK(place.files() == std::vector<std::string> { "a-rescued.exr", "b.png" });
}

TEST_CASE("the output becomes a folder, or a link in a circle")
{
    const Workplace folder;
    checkKept(
        folder, renderWhile(folder, [&] { fs::create_directories(folder.path() / "d/a.exr"); }), "./a-rescued.exr");
    const Workplace link;
    checkKept(
        link, renderWhile(link, [&] { fs::create_symlink("a.exr", link.path() / "d/a.exr"); }), "./a-rescued.exr");
}

TEST_CASE("no existing file is overwritten by a rescue")
{
    const Workplace place;
    place.write("a-rescued.exr", "mine");
    place.write("a-rescued-2.exr", "mine, too");
    checkKept(place, renderWhile(place, [&] { fs::remove_all(place.path() / "d"); }), "./a-rescued-3.exr");
    CHECK(place.text("a-rescued.exr") == "mine");
    CHECK(place.text("a-rescued-2.exr") == "mine, too");
}

TEST_CASE("where the working folder is gone, too, the picture goes to the temporary one")
{
    const Workplace place;
    const Outcome outcome = renderWhile(place, [&] { fs::remove_all(place.path()); });
    CHECK(outcome.status == failure);
    CHECK(std::ranges::count(outcome.err, '\n') == 3); // interrupted, and two outputs
    CHECK(rescued(outcome) == (place.temporary() / "a-rescued.exr").string());
    CHECK(image::readExr(rescued(outcome)).width == 64);
}

TEST_CASE("a report that cannot be written loses no image, and an image no report")
{
    const Workplace place;
    Outcome outcome = renderWhile(place, [&] { fs::remove_all(place.path() / "d"); }, { "--report", "d/r.json" });
    checkKept(place, outcome, "./a-rescued.exr");
    CHECK(contains(outcome.err, failed + "No such file or directory): d/r.json: "));
    const Workplace other;
    outcome = renderWhile(other, [&] { fs::remove_all(other.path() / "d"); }, { "--report", "r.json" });
    CHECK(outcome.status == failure);
    CHECK(nlohmann::json::parse(other.text("r.json")).at("frames").at(0).at("complete") == false);
}

/// A progressive render to d/a.exr, whose folder goes after the first step.
Outcome renderSteps(const Workplace& place, const std::function<void()>& later)
{
    fs::create_directory(place.path() / "d");
    return place.run({ "render", box, "--method", "mc", "--size", "64x64", "--progressive", "--spp", "65536", "-o",
                         "d/a.exr", "--report", "r.json", "--verbose" },
        [&](pid_t process) {
            const auto waitFor = [&](const std::string& text) {
                for (int i = 0; i < 9000 && !contains(place.said(), text) && kill(process, 0) == 0; ++i) {
                    std::this_thread::sleep_for(std::chrono::milliseconds(2));
                }
            };
            waitFor("16 spp, ");
            // Out of the way first: the program may be writing into it.
            fs::rename(place.path() / "d", place.path() / "gone");
            fs::remove_all(place.path() / "gone");
            waitFor("\n256 spp, ");
            later();
            waitFor("\n2048 spp, ");
            kill(process, SIGINT);
        });
}

TEST_CASE("steps of a progressive render that fail are tried again, and the last image is kept once")
{
    const Workplace place;
    const Outcome outcome = renderSteps(place, [] {});
    CHECK(outcome.status == failure);
    CHECK(rescued(outcome) == "./a-rescued.exr");
    CHECK(place.files() == std::vector<std::string> { "a-rescued.exr", "r.json" });
    CHECK(contains(outcome.err, "wedge: warning: cannot write file (No such file or directory): d/a.exr"));
    CHECK(outcome.err.find("warning", outcome.err.find("warning") + 1) == std::string::npos); // of many steps
    const nlohmann::json steps = nlohmann::json::parse(place.text("r.json")).at("progressive").at("steps");
    CHECK(steps.size() >= 8);
    CHECK(steps.back().at("files") == nlohmann::json({ "./a-rescued.exr" }));
    CHECK(std::get<float>(place.exr("a-rescued.exr").metadata.at("samplesPerPixel")) >= 2048);
}

TEST_CASE("an output that comes back is written by the next step, and nothing is amiss")
{
    const Workplace place;
    const Outcome outcome = renderSteps(place, [&] { fs::create_directory(place.path() / "d"); });
    CHECK(outcome.status == 130);
    CHECK_FALSE(contains(outcome.err, "wedge: error: "));
    CHECK(place.files() == std::vector<std::string> { "d", "r.json" });
    CHECK(place.exr("d/a.exr").width == 64);
}

TEST_CASE("what a pipe reads of stdout decides nothing")
{
    const Workplace place;
    const std::string call = "'" + program + "' render '" + box + "' --size 16x16 --method mc --spp 1 -o '"
        + (place.path() / "a.exr").string() + "' --verbose | true; exit \\${PIPESTATUS[0]}";
    CHECK(std::system(("exec bash -c \"" + call + "\"").c_str()) == 0);
    CHECK(place.exr("a.exr").width == 16);
}

} // namespace
} // namespace wedge::app::test
