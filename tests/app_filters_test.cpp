// Filters of the finished image, by options and by scene files.
#include "tests/app_testing.h"

#include <fstream>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

/// A scene file of the place: that one with more tables at its end.
void writeScene(const Workplace& place, const std::string& more)
{
    std::ofstream(place.path() / "scene.toml") << readAll(WEDGE_SOURCE_DATA "/scenes/penumbra.toml") << more;
    std::filesystem::copy(WEDGE_SOURCE_DATA "/scenes/meshes", place.path() / "meshes",
        std::filesystem::copy_options::recursive | std::filesystem::copy_options::skip_existing);
}

/// The beauty of a small render with these arguments.
std::vector<float> beauty(const Workplace& place, const std::string& scene, const Arguments& more)
{
    Arguments arguments = { "render", scene, "--method", "mc", "--spp", "2", "--size", "32x24", "-o", "a.exr" };
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = place.run(arguments);
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    const image::LayeredImage image = image::readExr((place.path() / "a.exr").string());
    std::vector<float> out;
    for (const char* channel : { "R", "G", "B" }) {
        const std::vector<float> one = values(image, channel);
        out.insert(out.end(), one.begin(), one.end());
    }
    return out;
}

std::string appliedFilters(const Workplace& place)
{
    const auto metadata = image::readExr((place.path() / "a.exr").string()).metadata;
    const auto found = metadata.find("method.filters");
    return found == metadata.end() ? "" : std::get<std::string>(found->second);
}

TEST_CASE("a scene's filters and --add-filter do the same, and the image says which were applied")
{
    const Workplace place;
    writeScene(place, "");
    const std::vector<float> plain = beauty(place, "scene.toml", {});
    CHECK(appliedFilters(place).empty());
    const std::vector<float> added =
        beauty(place, "scene.toml", { "--add-filter", "median", "--add-filter", "colour:red=0.5,density=0.5" });
    CHECK(added != plain);
    const std::string both = "median:radius=1 colour:red=0.5,green=1,blue=1,density=0.5";
    CHECK(appliedFilters(place) == both);
    writeScene(place,
        "\n[[filter]]\ntype = \"median\"\n[[filter]]\ntype = \"gaussian\"\nenabled = false\n"
        "[[filter]]\ntype = \"colour\"\nred = 0.5\ndensity = 0.5\n");
    CHECK(beauty(place, "scene.toml", {}) == added);
    CHECK(appliedFilters(place) == both);
    CHECK(contains(place.run({ "info", "scene.toml" }).out, "filters    " + both));
    CHECK(beauty(place, "scene.toml", { "--no-filters" }) == plain);
    // The scene's come first.
    const std::vector<float> more = beauty(place, "scene.toml", { "--add-filter", "sharpen:amount=1" });
    CHECK(more != added);
    CHECK(appliedFilters(place) == both + " sharpen:sigma=1,amount=1");
    // What they are on.
    const std::vector<float> direct =
        beauty(place, "scene.toml", { "--no-filters", "--add-filter", "median:on=direct" });
    CHECK(appliedFilters(place) == "median:radius=1,on=direct");
    writeScene(place, "\n[[filter]]\ntype = \"median\"\non = [\"direct\"]\n");
    CHECK(beauty(place, "scene.toml", {}) == direct);
    CHECK(appliedFilters(place) == "median:radius=1,on=direct");
    CHECK(beauty(place, "scene.toml", { "--no-filters", "--add-filter", "median" }) != plain);
    CHECK(appliedFilters(place) == "median:radius=1");
}

TEST_CASE("samples of indirect light that are not finite are counted in the report and warned of")
{
    const Workplace place;
    place.write("room.obj",
        "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
        "f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 4 3 7 8\nf 1 4 8 5\nf 2 3 7 6\n");
    // What its walls reflect of a light is what floats just hold, and the sum over bounces is more.
    const auto writeRoom = [&](const std::string& intensity) {
        place.write("room.toml",
            "[camera]\neye = [0, -2e-5, 4e-5]\nlook_at = [0, -1.5e-5, -5e-5]\n[[material]]\nname = \"a\"\n"
            "diffuse = 1\n[[mesh]]\nfile = \"room.obj\"\nmaterial = \"a\"\ntransform = { scale = 5.8e-5 }\n"
            "[[light]]\ntype = \"point\"\nposition = [0, 0, 0]\nintensity = "
                + intensity + "\n");
    };
    constexpr int samples = 32 * 24 * 4;
    const std::string warning = "wedge: warning: samples of indirect light that are not finite, which are left out: ";
    const auto rendered = [&](const Arguments& more) {
        Arguments arguments = { "render", "room.toml", "--method", "mc", "--spp", "4", "--bounces", "12", "--size",
            "32x24", "--report", "r.json", "-o", "a.exr" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        Outcome outcome = place.run(arguments);
        CAPTURE(outcome.err);
        REQUIRE(outcome.status == 0);
        return outcome;
    };
    const auto frame = [&] { return nlohmann::json::parse(place.text("r.json")).at("frames").at(0); };
    writeRoom("1e30");
    for (const char* more : { "", "--antialias", "--progressive" }) {
        CAPTURE(more);
        const Arguments kind = *more != 0 ? Arguments { more } : Arguments {};
        Arguments filtered = kind;
        filtered.insert(filtered.end(), { "--add-filter", "path-density" });
        const Outcome outcome = rendered(filtered);
        const int count = frame().at("samples").at("not_finite");
        CHECK(outcome.err == warning + std::to_string(count) + "\n");
        CHECK(count > 0.9 * samples);
        CHECK(count <= samples);
        filtered.emplace_back("--quiet");
        CHECK(rendered(filtered).err.empty());
        CHECK(rendered(kind).err.empty());
        CHECK_FALSE(frame().contains("samples"));
    }
    // A sequence warns once, of all of its frames.
    const Outcome sequence =
        place.run({ "render", "room.toml", "--method", "mc", "--spp", "4", "--bounces", "12", "--size", "32x24",
            "--add-filter", "path-density", "--frames", "0:1", "--report", "r.json", "-o", "a.%04d.exr" });
    int count = 0;
    const nlohmann::json report = nlohmann::json::parse(place.text("r.json"));
    for (const nlohmann::json& each : report.at("frames")) {
        count += each.at("samples").at("not_finite").get<int>();
    }
    CHECK(sequence.err == warning + std::to_string(count) + "\n");
    CHECK(count > 1.8 * samples);
    writeRoom("1e-9");
    CHECK(rendered({ "--add-filter", "clamp" }).err.empty());
    CHECK(frame().at("samples").at("not_finite") == 0);
}

TEST_CASE("what is wrong with filters is said in one line, with the nearest name or the range")
{
    const Workplace place;
    const auto refused = [&](const std::string& filter, const std::string& says) {
        const Outcome outcome = place.run({ "render", box, "--add-filter", filter, "-o", "a.exr" });
        CAPTURE(filter);
        CAPTURE(outcome.err);
        CHECK(outcome.status == wrongCall);
        CHECK(contains(outcome.err, says));
        CHECK(std::ranges::count(outcome.err, '\n') == 1);
        CHECK_FALSE(place.has("a.exr"));
    };
    refused("medan", "write median");
    refused("", "has no value");
    refused("blur", "choose among: bilateral, bloom");
    refused("median,gaussian", "once for each");
    refused("path-densty:k=3", "write path-density");
    refused("path-density:k=0", "whole number from 1 to 256");
    refused("path-density:low=5", "number from 0 to 4");
    refused("path-density:rgb=0.5", "whole number from 0 to 1");
    refused("path-density:approximate=5", "number from 0 to 4");
    refused("trim", "add --bounces 1 or more");
    refused("median:radus=1", "write radius");
    refused("median:radius", "write median:radius=1");
    refused("median:", "no name");
    refused("median:radius=1,", "no name");
    refused("gaussian:=3", "no name");
    refused("median:radius=1.5", "whole number from 0 to 3");
    refused("median:radius=1.0", "whole number from 0 to 3");
    refused("median:radius=1,radius=2", "twice");
    refused("gaussian:sigma=nan", "number from 0 to 32");
    refused("gaussian:sigma=1e9", "number from 0 to 32");
    refused("gaussian:sigma=", "number from 0 to 32");
    refused("median:on=direkt", "write direct");
    refused("median:on=", "cannot be on (empty)");
    refused("median:on", "write median:on=image");
    refused("median:on=direct+direct", "twice on direct");
    refused("median:on=direct+image", "which come one after the other");
    refused("median:on=direct,on=direct", "twice: on");
    refused("path-density:on=image", "choose among: indirect, indirectDiffuse, indirectGlossy");
    refused("median:on=environment", "the frame has: image, direct");
    refused("median:on=indirect", "the frame has: image, direct");
    const auto refusedCall = [&](const Arguments& more, const std::string& says) {
        Arguments arguments = { "render", box, "--bounces", "1", "--spp", "16", "-o", "a.exr" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = place.run(arguments);
        CAPTURE(outcome.err);
        CHECK(outcome.status == wrongCall);
        CHECK(contains(outcome.err, says));
        CHECK(std::ranges::count(outcome.err, '\n') == 1);
    };
    const Outcome open = place.run(
        { "render", box, "--integrator", "ao", "--spp", "16", "--add-filter", "median:on=direct", "-o", "a.exr" });
    CHECK(open.status == wrongCall);
    CHECK(contains(open.err, "the frame has: image, indirect, ambient"));
    refusedCall({ "--add-filter", "median", "--add-filter", "clamp" }, "give clamp before median");
    refusedCall(
        { "--add-filter", "median", "--add-filter", "median:on=direct" }, "give median:on=direct before median");
    refusedCall({ "--add-filter", "median:on=direct", "--add-filter", "box:on=indirectDiffuse" }, "filter of a term");
    refusedCall({ "--add-filter", "gmon", "--add-filter", "clamp" }, "gmon and clamp: leave one out");
    refusedCall({ "--add-filter", "gmon", "--antialias" }, "neither antialiased nor progressive: gmon");
    refusedCall({ "--add-filter", "gmon", "--progressive" }, "neither antialiased nor progressive: gmon");
    refusedCall(
        { "--add-filter", "path-density:rgb=1", "--antialias" }, "samples by their L*: path-density: leave out");
    refusedCall({ "--add-filter", "path-density:rgb=1", "--progressive" }, "leave out rgb=1");
    const Outcome tight = place.run({ "render", box, "--bounces", "1", "--method", "mc", "--spp", "1048576",
        "--add-filter", "trim", "-o", "a.exr" });
    CHECK(tight.status == failure);
    CHECK(contains(tight.err, "take fewer samples with --spp"));
    const auto refusedScene = [&](const std::string& table, const std::string& says) {
        writeScene(place, table);
        const Outcome outcome = place.run({ "render", "scene.toml", "-o", "a.exr" });
        CAPTURE(table);
        CAPTURE(outcome.err);
        CHECK(outcome.status == failure);
        CHECK(contains(outcome.err, says));
        CHECK(std::ranges::count(outcome.err, '\n') == 1);
    };
    refusedScene("\n[[filter]]\ntype = \"medan\"\n", "use one of: path-density, clamp, trim");
    refusedScene("\n[[filter]]\ntype = \"median\"\n[[filter]]\ntype = \"trim\"\n", "give trim before median");
    refusedScene("\n[[filter]]\nradius = 1\n", "add 'type = ...'");
    refusedScene("\n[[filter]]\ntype = \"median\"\non = \"direkt\"\n", "write 'direct'");
    refusedScene("\n[[filter]]\ntype = \"median\"\non = [\"direct\", \"image\"]\n", "leave one out");
    refusedScene("\n[[filter]]\ntype = \"median\"\non = []\n", "is empty");
    refusedScene("\n[[filter]]\ntype = \"median\"\non = false\n", "a name, or a list of names");
    refusedScene("\n[[filter]]\ntype = \"median\"\non = [1]\n", "a name, or a list of names");
    refusedScene("\n[[filter]]\ntype = \"median\"\nradus = 1\n", "did you mean 'radius'");
    refusedScene("\n[[filter]]\ntype = \"median\"\nradius = 7\n", "0 to 3");
}

} // namespace
} // namespace wedge::app::test
