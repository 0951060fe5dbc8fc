// The filter over time as users see it: any range and any crop give the same bits, and what does not change stays.
#include "tests/app_testing.h"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

const std::string moving = scenes + "/motion.toml";
const std::string ball = "[[mesh]]\nfile = \"" + scenes
    + "/meshes/sphere.obj\"\ntransform = [{ scale = 0.3 }, { translate = [-0.5, 0.4, 0] }]\n";
const std::string rolls = "key = [{ time = 0 }, { time = 1, translate = [1, 0, 0], rotate = [0, 0, 1, -90] }]\n";
const std::string passesBy = "key = [{ time = 0 }, { time = 1, eye = [0.7, 1.2, 3] }]\n";

/// Frames of a size of 48 x 32, with the filter.
Outcome frames(const Workplace& place, const std::string& scene, const std::string& range, Arguments more = {})
{
    Arguments all = { "render", scene, "--size", "48x32", "--fps", "8", "--frames", range };
    if (std::ranges::find(more, "--temporal") == more.end()) {
        all.insert(all.end(), { "--temporal", "on" });
    }
    all.insert(all.end(), more.begin(), more.end());
    return place.run(all);
}

std::vector<float> cropped(const std::vector<float>& values, int x0, int y0, int x1, int y1)
{
    std::vector<float> out;
    for (int y = y0; y < y1; ++y) {
        out.insert(out.end(), values.begin() + y * 48 + x0, values.begin() + y * 48 + x1);
    }
    return out;
}

/// RMS difference of two frames' green, and the mean of the second.
std::pair<double, double> difference(const Workplace& place, const std::string& one, const std::string& other)
{
    const std::vector<float> a = values(place.exr(one), "G"), b = values(place.exr(other), "G");
    double sum = 0, mean = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
        mean += b[i];
    }
    const auto count = static_cast<double>(a.size());
    return { std::sqrt(sum / count), mean / count };
}

TEST_CASE("temporal: a frame has the same bits in any range, with any crop, and when it is made again")
{
    const Workplace place;
    place.write("s.toml", camera + passesBy + quad + light + ball + rolls);
    const std::string own = "s.toml";
    struct Kind {
        std::string scene;
        Arguments how;
        bool distributed = false; ///< of which frames without layers keep terms in fewer bits
    };
    const Kind kinds[] = { { own, { "--spp", "16", "--bounces", "1" } },
        { moving, { "--spp", "16", "--bounces", "1" }, true }, { own, { "--spp", "17", "--integrator", "ao" } },
        { own, { "--spp", "16", "--bounces", "1", "--aperture", "0.1" }, true },
        { own, { "--filter", "fixed", "--spp", "16", "--bounces", "1" } } };
    for (std::size_t kind = 0; kind < std::size(kinds); ++kind) {
        CAPTURE(kind);
        const std::string& scene = kinds[kind].scene;
        const auto with = [&](Arguments more) {
            more.insert(more.end(), kinds[kind].how.begin(), kinds[kind].how.end());
            return more;
        };
        REQUIRE(frames(place, scene, "1:9", with({ "-o", "a%d.exr" })).status == 0);
        REQUIRE(frames(place, scene, "9", with({ "-o", "b%d.exr" })).status == 0);
        REQUIRE(frames(place, scene, "8:9", with({ "-o", "c%d.exr", "--crop", "20,9,31,22" })).status == 0);
        REQUIRE(frames(place, scene, "9", with({ "-o", "d%d.exr", "--layers", "direct,indirect,depth" })).status == 0);
        const std::vector<float> nine = values(place.exr("a9.exr"), "R");
        CHECK(nine == values(place.exr("b9.exr"), "R"));
        const auto [off, mean] = difference(place, "d9.exr", "a9.exr");
        CHECK(off <= (kinds[kind].distributed ? 0.01 * mean : 0.0));
        REQUIRE(frames(place, scene, "8:9", with({ "-o", "f%d.exr", "--layers", "direct,objectId" })).status == 0);
        CHECK(values(place.exr("f9.exr"), "R") == values(place.exr("d9.exr"), "R"));
        CHECK(cropped(nine, 20, 9, 31, 22) == values(place.exr("c9.exr"), "R"));
        const std::vector<float> fifth = values(place.exr("a5.exr"), "R");
        std::filesystem::remove(place.path() / "a5.exr");
        CHECK(contains(frames(place, scene, "1:9", with({ "-o", "a%d.exr" })).out, "8 of 9 frames are there"));
        CHECK(fifth == values(place.exr("a5.exr"), "R"));
        // And it does something.
        REQUIRE(frames(place, scene, "9", with({ "-o", "e%d.exr", "--temporal", "off" })).status == 0);
        CHECK(nine != values(place.exr("e9.exr"), "R"));
        for (const char* name : { "a", "b", "c", "d", "e", "f" }) {
            for (int i = 1; i < 10; ++i) {
                std::filesystem::remove(place.path() / (name + std::to_string(i) + ".exr"));
            }
        }
    }
}

TEST_CASE("temporal: frames that are equal stay as they are, to the bit")
{
    const Workplace place;
    // A point light has no noise.
    place.write("s.toml",
        camera + quad + ball + "[[light]]\ntype = \"point\"\nposition = [1, 3, 1]\nintensity = [20, 15, 10]\n");
    REQUIRE(frames(place, "s.toml", "0:3", { "-o", "a%d.exr" }).status == 0);
    REQUIRE(frames(place, "s.toml", "3", { "-o", "b%d.exr", "--temporal", "off" }).status == 0);
    CHECK(values(place.exr("a3.exr"), "G") == values(place.exr("b3.exr"), "G"));
}

/// RMS difference of a frame with the filter from the mean of it and those before it, so many in all, without, over
/// that of the frame without.
double apartFromMean(const Workplace& place, const std::string& scene, const Arguments& more,
    const std::string& filter = "on", int of = 8)
{
    const auto with = [&](Arguments arguments) {
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    REQUIRE(frames(place, scene, "0:9", with({ "-o", "a%d.exr", "--temporal", "off" })).status == 0);
    REQUIRE(frames(place, scene, "9", with({ "-o", "b%d.exr", "--temporal", filter })).status == 0);
    const std::vector<float> filtered = values(place.exr("b9.exr"), "G"), last = values(place.exr("a9.exr"), "G");
    std::vector<double> mean(filtered.size(), 0.0);
    for (int i = 10 - of; i < 10; ++i) {
        const std::vector<float> frame = values(place.exr("a" + std::to_string(i) + ".exr"), "G");
        for (std::size_t k = 0; k < mean.size(); ++k) {
            mean[k] += frame[k] / static_cast<double>(of);
        }
    }
    double noise = 0, off = 0;
    for (std::size_t k = 0; k < mean.size(); ++k) {
        noise += (last[k] - mean[k]) * (last[k] - mean[k]);
        off += (filtered[k] - mean[k]) * (filtered[k] - mean[k]);
    }
    REQUIRE(noise > 0);
    return std::sqrt(off / noise);
}

TEST_CASE("temporal: with a still camera a frame is the mean of the last eight, and no more")
{
    const Workplace place;
    place.write("s.toml", camera + quad + light + ball);
    // Some differences are taken for those of light by chance.
    CHECK(apartFromMean(place, "s.toml", { "--spp", "9" }) < 0.1);
}

TEST_CASE(
    "temporal: as published it is that of the last two, of pixels that see one surface; and the same in any range")
{
    const Workplace place;
    place.write("s.toml", camera + quad + light + ball);
    // No difference is taken for one of light.
    CHECK(apartFromMean(place, "s.toml", { "--spp", "9" }, "published", 2) < 0.01);
    place.write("m.toml", camera + passesBy + quad + light + ball + rolls);
    REQUIRE(frames(place, "m.toml", "7:9", { "-o", "c%d.exr", "--temporal", "published", "--report", "r.json" }).status
        == 0);
    REQUIRE(frames(place, "m.toml", "9", { "-o", "d%d.exr", "--temporal", "published" }).status == 0);
    CHECK(values(place.exr("c9.exr"), "R") == values(place.exr("d9.exr"), "R"));
    CHECK(nlohmann::json::parse(place.text("r.json"))["method"]["temporal"] == "published");
    REQUIRE(frames(place, "m.toml", "9", { "-o", "e%d.exr" }).status == 0);
    CHECK(values(place.exr("d9.exr"), "R") != values(place.exr("e9.exr"), "R"));
}

TEST_CASE("temporal: that is so of what mirrors and glass show, and of what is beside them, too")
{
    const Workplace place;
    const double apart = apartFromMean(place, scenes + "/mirrors.toml", { "--spp", "16", "--bounces", "1" });
    MESSAGE("RMS difference over a frame's: ", apart);
    CHECK(apart < 0.1);
}

TEST_CASE("temporal: nothing is left of what has moved: objects, what they hid, their shadows, highlights and lights")
{
    const Workplace place;
    const std::string shiny = "[[material]]\nname = \"shiny\"\nmodel = \"phong\"\ndiffuse = [0.3, 0.3, 0.3]\n"
                              "specular = 0.6\nexponent = 60\n";
    const std::string floor = quad + "material = \"shiny\"\ntransform = { scale = 4 }\n";
    const std::string lamp = "[[light]]\ntype = \"point\"\nposition = [1, 3, 1]\nintensity = [20, 15, 10]\n";
    const std::string glides = "key = [{ time = 0 }, { time = 1, translate = [2, 0, 0] }]\n";
    place.write("ball.toml", camera + shiny + floor + ball + "material = \"shiny\"\n" + glides + lamp);
    place.write("camera.toml", camera + passesBy + shiny + floor + ball + lamp);
    place.write("lamp.toml", camera + shiny + floor + ball + "material = \"shiny\"\n" + lamp + glides);
    for (const std::string scene : { "ball", "camera", "lamp" }) {
        CAPTURE(scene);
        // Without noise, all that differs are traces.
        for (const std::string temporal : { "on", "off" }) {
            REQUIRE(frames(place, scene + ".toml", "7",
                        { "--size", "160x120", "-o", scene + temporal + "%d.exr", "--temporal", temporal })
                        .status
                == 0);
        }
        const auto [rms, mean] = difference(place, scene + "on7.exr", scene + "off7.exr");
        CHECK(mean > 0.01);
        CHECK(rms < 0.01 * mean);
    }
}

TEST_CASE("temporal: a scene that moves as the camera does has the history of one at rest")
{
    const Workplace place;
    const std::string along = "translate = [0.4, 0.3, -0.2] }]\n", keys = "key = [{ time = 0 }, { time = 1, " + along;
    const std::string follows =
        "key = [{ time = 0 }, { time = 1, eye = [0.4, 1.3, 2.8], look_at = [0.4, 0.3, -0.2] }]\n";
    place.write("moves.toml", camera + follows + quad + keys + light + keys + ball + keys);
    place.write("still.toml", camera + quad + light + ball);
    for (const std::string scene : { "moves", "still" }) {
        REQUIRE(frames(place, scene + ".toml", "7", { "-o", scene + "%d.exr", "--spp", "9" }).status == 0);
        REQUIRE(frames(place, scene + ".toml", "7", { "-o", scene + ".off%d.exr", "--spp", "9", "--temporal", "off" })
                    .status
            == 0);
    }
    const double noise = difference(place, "still.off7.exr", "still7.exr").first;
    REQUIRE(noise > 0);
    // Rounding of coordinates is most of what is left: counts, and pixels at edges.
    CHECK(difference(place, "moves.off7.exr", "still.off7.exr").first < 0.5 * noise);
    CHECK(difference(place, "moves7.exr", "still7.exr").first < 0.3 * noise);
}

TEST_CASE("temporal: whether there is a filter is part of what a frame is made from, and of the report")
{
    const Workplace place;
    REQUIRE(frames(place, box, "0:1", { "-o", "s%d.exr", "--temporal", "off" }).status == 0);
    const Outcome on = frames(place, box, "0:1", { "-o", "s%d.exr", "--report", "r.json" });
    CHECK_FALSE(contains(on.out, "are there"));
    const auto report = nlohmann::json::parse(place.text("r.json"));
    CHECK(report["method"]["temporal"] == "on");
    const auto without = frames(place, box, "1", { "-o", "t%d.exr", "--temporal", "off", "--report", "t.json" });
    CHECK(
        report["frames"][1]["memory_bytes"] > nlohmann::json::parse(place.text("t.json"))["frames"][0]["memory_bytes"]);
    CHECK(std::ranges::any_of(
        report["frames"][1]["passes"], [](const auto& pass) { return pass["name"] == "filter over time"; }));
}

TEST_CASE("temporal: calls that are wrong are refused in one line")
{
    const Workplace place;
    checkRefused(place, { "render", box, "--temporal", "on", "-o", "a.exr" }, wrongCall, "--temporal");
    checkRefused(place, { "render", box, "--frames", "0", "--temporal", "often", "-o", "a%d.exr" }, wrongCall, "often");
    checkRefused(place, { "render", box, "--frames", "0", "--temporal", "on", "--method", "mc", "-o", "a%d.exr" },
        wrongCall, "--temporal");
}

TEST_CASE("temporal: what it keeps of frames counts as memory, and is refused where that is more than there may be")
{
    const Workplace place;
    const Arguments call = { "render", box, "--frames", "0", "--size", "640x480", "--spp", "16", "--layers", "all" };
    const auto with = [&](Arguments more) {
        more.insert(more.begin(), call.begin(), call.end());
        return more;
    };
    std::array<double, 2> bytes {};
    for (const std::size_t on : { 0, 1 }) {
        const std::string temporal = on != 0 ? "on" : "off";
        REQUIRE(
            place.run(with({ "--temporal", temporal, "-o", temporal + "%d.exr", "--report", "r.json" })).status == 0);
        bytes[on] = nlohmann::json::parse(place.text("r.json"))["frames"][0]["memory_bytes"];
    }
    // Eight frames of at least 22 bytes a pixel.
    CHECK(bytes[1] - bytes[0] > 8.0 * 22.0 * 640.0 * 480.0);
    const std::string between = std::to_string(static_cast<int>(0.5 * (bytes[0] + bytes[1]) / (1 << 20)));
    checkRefused(place, with({ "--temporal", "on", "--memory-limit", between, "-o", "a%d.exr" }), failure, "memory");
    CHECK(place.run(with({ "--temporal", "off", "--memory-limit", between, "-o", "b%d.exr" })).status == 0);
}

} // namespace
} // namespace wedge::app::test
