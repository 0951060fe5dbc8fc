// Styles of lights' shadows: --no-style, layers, and what is refused.
#include "tests/app_testing.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace wedge::app::test {
namespace {

/// A wall on a floor, under a sun.
void writeScene(Workplace& place, const std::string& more)
{
    place.write("floor.obj", "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3 4\n");
    place.write("wall.obj", "v 0 0 -1\nv 0 0 1\nv 0 1 1\nv 0 1 -1\nf 1 2 3 4\n");
    place.write("s.toml",
        "[camera]\neye = [0, 2, 4]\nlook_at = [0, 0, 0]\n[image]\nwidth = 48\nheight = 32\n"
        "[[mesh]]\nname = \"floor\"\nfile = \"floor.obj\"\n"
        "[[mesh]]\nname = \"wall\"\nfile = \"wall.obj\"\n"
        "[[light]]\ntype = \"directional\"\nname = \"the sun\"\ndirection = [1, -1.5, 0]\nirradiance = 2\n"
            + more);
}

const std::string style = "[[light.style]]\ninflation = 0.1\nsoftness = 0.1\n";

image::LayeredImage rendered(const Workplace& place, const Arguments& more)
{
    Arguments all { "render", "s.toml", "--quiet", "-o", "a.exr" };
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = place.run(all);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    return image::readExr((place.path() / "a.exr").string());
}

std::vector<float> channelOf(const image::LayeredImage& image, const std::string& name)
{
    for (const image::Channel& channel : image.channels)
        if (channel.name == name)
            return channel.values;
    return {};
}

} // namespace

TEST_CASE("--no-style leaves styles out, layers show what they are made of, and images say so")
{
    Workplace place;
    writeScene(place, "");
    const image::LayeredImage plain = rendered(place, {});
    writeScene(place, style);
    const image::LayeredImage styled = rendered(place, { "--layers", "shadowMatte,shadowDistance" });
    const image::LayeredImage without = rendered(place, { "--no-style" });
    CHECK(textOf(without, "method.styles") == "off");
    CHECK(channelOf(without, "R") == channelOf(plain, "R"));
    CHECK(channelOf(styled, "R") != channelOf(plain, "R"));
    const std::vector<float> matte = channelOf(styled, "shadowMatte.the_sun.Y");
    const std::vector<float> distance = channelOf(styled, "shadowDistance.the_sun.Z");
    REQUIRE(matte.size() == 48 * 32);
    REQUIRE(distance.size() == matte.size());
    std::size_t lit = 0, shadowed = 0;
    for (std::size_t i = 0; i < matte.size(); ++i) {
        lit += distance[i] > 0 ? 1 : 0;
        shadowed += distance[i] < 0 ? 1 : 0;
        CHECK((distance[i] < 0) == (matte[i] == 0 && distance[i] != 0));
    }
    CHECK(lit > 60);
    CHECK(shadowed > 30);
}

TEST_CASE("styles that frames cannot have are refused in a line")
{
    Workplace place;
    writeScene(place, style);
    const auto refused = [&](const Arguments& more, const std::string& says) {
        Arguments all { "render", "s.toml", "-o", "a.exr" };
        all.insert(all.end(), more.begin(), more.end());
        const Outcome outcome = place.run(all);
        CHECK(outcome.status == wrongCall);
        CHECK_MESSAGE(contains(outcome.err, says), outcome.err);
    };
    const std::string several = "wedge: error: styles of shadows are of frames through a pinhole where nothing moves, "
                                "neither antialiased nor progressive: style of light the sun: add --no-style, or leave "
                                "out --antialias, --progressive, the lens and what moves";
    refused({ "--antialias" }, several);
    refused({ "--progressive" }, several);
    refused({ "--aperture", "0.1" }, several);
    rendered(place, { "--antialias", "--no-style", "--spp", "8" });
    rendered(place, { "--integrator", "ao", "--antialias", "--spp", "8" });
    refused({ "--no-style", "--layers", "shadowMatte" }, "layer cannot be made, no light's shadows have a style");
}

TEST_CASE("styles by distance and of some objects are rendered, and unknown objects refused in a line")
{
    Workplace place;
    const auto red = [&](const std::string& style) {
        writeScene(place, "[[light.style]]\n" + style);
        return channelOf(rendered(place, {}), "R");
    };
    const std::vector<float> plain = red("brightness = 0.3\n");
    const std::vector<float> away = red("brightness = { at = [0.3, 0.2, 0] }\n");
    const std::vector<float> some = red("brightness = 0.3\nreceivers = 'wall'\n");
    CHECK(away != plain);
    CHECK(some != plain);
    CHECK(red("brightness = 0.3\nreceivers = ['wall', 'floor']\n") == plain);
    CHECK(red("brightness = { at = [0.3, 0, 0] }\n") == plain);
    writeScene(place, "[[light.style]]\nbrightness = 0.3\ncasters = 'wal'\n");
    const Outcome outcome = place.run({ "render", "s.toml", "-o", "a.exr" });
    CHECK(outcome.status == failure);
    CHECK_MESSAGE(contains(outcome.err, "names no object of the scene: 'wal': did you mean 'wall'?"), outcome.err);
}

TEST_CASE("images of any shape have styles, and frames that see beyond the border go with all that looks at pixels")
{
    Workplace place;
    writeScene(place, style);
    for (const char* size : { "1x1", "7x5", "200x3", "64x64" }) {
        CAPTURE(size);
        const image::LayeredImage image = rendered(place, { "--size", size, "--check-launches" });
        CHECK(fmt::format("{}x{}", image.width, image.height) == size);
    }
    const auto sums = [&](const Arguments& more) {
        Arguments all { "--size", "96x64", "--bounces", "1", "--spp", "16", "--check-launches" };
        all.insert(all.end(), more.begin(), more.end());
        const std::vector<float> red = channelOf(rendered(place, all), "R");
        CHECK(red.size() == 96 * 64);
        CHECK(std::ranges::all_of(red, [](float v) { return std::isfinite(v) && v >= 0; }));
        return std::accumulate(red.begin(), red.end(), 0.0);
    };
    const double all = sums({});
    CHECK(sums({ "--add-filter", "path-density" }) == doctest::Approx(all).epsilon(0.03));
    CHECK(sums({ "--add-filter", "gaussian:sigma=1" }) == doctest::Approx(all).epsilon(0.03));
    CHECK(sums({ "--method", "mc" }) == doctest::Approx(all).epsilon(0.03));
    // Frames before are kept with their margins.
    Arguments frames { "render", "s.toml", "--quiet", "--size", "96x64", "--bounces", "1", "--spp", "16",
        "--check-launches", "--frames", "0:2", "--temporal", "on", "-o", "f%d.exr" };
    const Outcome outcome = place.run(frames);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const std::vector<float> last = values(place.exr("f2.exr"), "R");
    CHECK(last.size() == 96 * 64);
    CHECK(std::accumulate(last.begin(), last.end(), 0.0) == doctest::Approx(all).epsilon(0.03));
}

TEST_CASE("keys of a style: frames of a sequence are those of themselves, and what stays is not made again")
{
    Workplace place;
    const std::string keys =
        "[[light.style]]\nsoftness = 0.1\n"
        "key = [{ time = 0 }, { time = 2, inflation = 0.3 }, { time = 4, inflation = 0.3, brightness = 0.5 }]\n";
    writeScene(place,
        keys
            + "[[light]]\ntype = \"quad\"\ncentre = [0, 3, 0]\nhalf_u = [1, 0, 0]\nhalf_v = [0, 0, 1]\n"
              "radiance = 1\n");
    const auto frames = [&](const std::string& range, const Arguments& more) {
        Arguments all { "render", "s.toml", "--frames", range, "--fps", "1" };
        all.insert(all.end(), more.begin(), more.end());
        Outcome outcome = place.run(all);
        REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
        return outcome;
    };
    frames("0:4", { "-o", "s%d.exr", "--report", "s.json" });
    const nlohmann::json report = nlohmann::json::parse(place.text("s.json"));
    REQUIRE(report["frames"].size() == 5);
    for (std::size_t i = 0; i < 5; ++i) {
        CAPTURE(i);
        const auto has = [&](const char* name) {
            return std::ranges::any_of(
                report["frames"][i]["passes"], [&](const auto& pass) { return pass["name"] == name; });
        };
        CHECK(has("styles of shadows"));
        for (const char* name : { "primary rays", "shadows in a style", "distances to shadows' edges" }) {
            CHECK(has(name) == (i == 0));
        }
    }
    const auto red = [&](const std::string& name) { return values(place.exr(name), "R"); };
    for (const std::string number : { "0", "1", "3", "4" }) {
        CAPTURE(number);
        frames(number, { "-o", "t%d.exr" });
        CHECK(red("s" + number + ".exr") == red("t" + number + ".exr"));
    }
    CHECK(red("s0.exr") != red("s1.exr"));
    CHECK(red("s3.exr") != red("s4.exr"));
    // The noise stays, too: a picture of the same knobs, which has frame 0's.
    CHECK(textOf(place.exr("s3.exr"), "method.sequence") == "same random numbers");
    const Outcome first = place.run({ "render", "s.toml", "-o", "p.exr", "--quiet" });
    REQUIRE(first.status == 0);
    CHECK(red("p.exr") == red("s0.exr"));
    writeScene(place,
        "[[light.style]]\nsoftness = 0.1\ninflation = 0.15\n"
        "[[light]]\ntype = \"quad\"\ncentre = [0, 3, 0]\nhalf_u = [1, 0, 0]\nhalf_v = [0, 0, 1]\nradiance = 1\n");
    REQUIRE(place.run({ "render", "s.toml", "-o", "q.exr", "--quiet" }).status == 0);
    // D is told apart farther where keys go farther, and so is rounded otherwise.
    const std::vector<float> numbers = red("q.exr"), keyed = red("s1.exr");
    REQUIRE(numbers.size() == keyed.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        REQUIRE(std::abs(numbers[i] - keyed[i]) < 1e-5f);
    }
}

} // namespace wedge::app::test
