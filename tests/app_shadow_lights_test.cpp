// --shadows and what goes with it: what is told of it, and what is wrong.
#include "tests/app_testing.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

/// A box on a floor.
void writeScene(Workplace& place, const std::string& more)
{
    place.write("floor.obj", "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3 4\n");
    place.write("wall.obj", "v 0 0 -1\nv 0 0 1\nv 0 1 1\nv 0 1 -1\nf 1 2 3 4\n");
    place.write("s.toml",
        "[camera]\neye = [0, 2, 4]\nlook_at = [0, 0, 0]\n[image]\nwidth = 24\nheight = 16\n"
        "[[material]]\nname = \"gloss\"\nmodel = \"phong\"\ndiffuse = 0.2\nspecular = 0.6\nexponent = 400\n"
        "[[mesh]]\nfile = \"floor.obj\"\nmaterial = \"gloss\"\n[[mesh]]\nfile = \"wall.obj\"\nmaterial = \"gloss\"\n"
            + more);
}

const std::string sky = "[environment]\nradiance = [0.5, 0.7, 1]\n";

} // namespace

TEST_CASE("lights for an environment's shadows are told of in images and reports")
{
    Workplace place;
    writeScene(place, sky);
    const auto render = [&](Arguments more) {
        more.insert(more.begin(), { "render", "s.toml", "--quiet", "-o", "a.exr", "--report", "r.json" });
        const Outcome outcome = place.run(more);
        REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
        return image::readExr((place.path() / "a.exr").string());
    };
    const auto told = [&](const image::LayeredImage& image, const std::string& name) {
        return textOf(image, "method." + name);
    };
    const auto report = [&] { return nlohmann::json::parse(readAll(place.path() / "r.json")); };
    const image::LayeredImage ratio = render({ "--shadows", "ratio" });
    CHECK(told(ratio, "shadows") == "ratio");
    CHECK(told(ratio, "shadowLights") == "40");
    CHECK(told(ratio, "shadowComplete") == "map");
    CHECK(report()["method"]["shadows"] == "ratio");
    CHECK_FALSE(contains(readAll(place.path() / "r.json"), "clamped_pixels"));
    const image::LayeredImage lights =
        render({ "--method", "mc", "--shadows", "subtractive", "--shadow-lights", "5", "--shadow-complete", "lights" });
    CHECK(told(lights, "shadowLights") == "5");
    CHECK(told(lights, "shadowComplete") == "lights");
    CHECK(told(lights, "shadowClamp") == "on");
    CHECK(contains(readAll(place.path() / "r.json"), "\"clamped_pixels\": 0"));
    const image::LayeredImage cached = render({ "--method", "mc", "--shadows", "ratio", "--shadow-complete", "cache" });
    CHECK(told(cached, "shadowComplete") == "cache");
    const image::LayeredImage few =
        render({ "--shadows", "ratio", "--shadow-lights", "30:4", "--shadow-scale", "1/16" });
    CHECK(told(few, "shadowLights") == "30:4");
    CHECK(told(few, "shadowScale") == "1/16");
    CHECK(told(render({ "--shadows", "ratio", "--shadow-lights", "30:4", "--shadow-lights", "9" }), "shadowLights")
        == "9");
    const image::LayeredImage open =
        render({ "--shadows", "additive", "--shadows", "subtractive", "--shadow-clamp", "off" });
    CHECK(told(open, "shadowClamp") == "off");
    CHECK_FALSE(contains(readAll(place.path() / "r.json"), "clamped_pixels"));
    // By time: what is chosen is told, and gives the same picture by itself.
    const image::LayeredImage soon = render({ "--shadows", "ratio", "--shadow-time", "0.0000001" });
    CHECK(told(soon, "shadowLights") == "1");
    CHECK(told(soon, "shadowScale") == "1/16"); // the image has 384 pixels
    CHECK(render({ "--shadows", "additive", "--shadow-time", "0.0000001" }).metadata.count("method.shadowScale") == 0);
    const image::LayeredImage same = render({ "--shadows", "ratio", "--shadow-lights", "1", "--shadow-scale", "1/16" });
    CHECK(image::beauty(soon).rgb == image::beauty(same).rgb);
    CHECK(told(render({ "--shadows", "ratio", "--shadow-time", "10000" }), "shadowLights") == "2048");
    // As if nothing had been asked for.
    render({ "--shadows", "ratio", "--shadows", "sampled" });
    CHECK_FALSE(report()["method"].contains("shadows"));
}

TEST_CASE("what lights for an environment's shadows cannot do is refused in a line")
{
    Workplace place;
    writeScene(place, sky);
    const auto refused = [&](const Arguments& more, const std::string& says) {
        CAPTURE(says);
        Arguments all { "render", "s.toml", "-o", "a.exr" };
        all.insert(all.end(), more.begin(), more.end());
        const Outcome outcome = place.run(all);
        CHECK(outcome.status == wrongCall);
        CHECK_MESSAGE(outcome.err.ends_with("wedge: error: " + says + "; see wedge render --help\n"), outcome.err);
    };
    const std::string several =
        "shadows of lights are of frames through a pinhole where nothing moves, neither antialiased "
        "nor progressive: --shadows ratio: leave it out, or leave out --antialias, --progressive, "
        "the lens and what moves";
    refused({ "--shadows", "ratio", "--antialias" }, several);
    refused({ "--shadows", "ratio", "--progressive" }, several);
    refused({ "--shadows", "ratio", "--aperture", "0.1" }, several);
    refused({ "--shadows", "soft" }, "--shadows: soft: choose sampled, additive, subtractive, ratio");
    refused({ "--shadows", "ratio", "--shadow-lights", "0" }, "--shadow-lights: 0: give a whole number from 1 to 4096");
    refused({ "--shadows", "ratio", "--shadow-lights", "3000" },
        "the environment's map has fewer places for lights: 3000 lights, 2048 places: give --shadow-lights 2048 or "
        "less");
    const std::string none = "option has no effect ";
    refused({ "--shadow-lights", "9" },
        none + "without --shadows: --shadow-lights 9: leave it out, or add --shadows ratio");
    refused({ "--shadows", "additive", "--shadow-complete", "lights" },
        none + "with --shadows additive: --shadow-complete lights: leave it out, or add --shadows ratio");
    refused({ "--shadows", "ratio", "--shadow-complete", "table" },
        "--shadow-complete: table: choose map, prefiltered, lights, cache");
    refused({ "--shadows", "ratio", "--shadow-lights", "40:0" },
        "--shadow-lights N:K: 0: give a whole number from 1 to 40");
    refused({ "--shadows", "ratio", "--shadow-lights", "40:41" },
        "--shadow-lights N:K: 41: give a whole number from 1 to 40");
    refused({ "--shadows", "ratio", "--shadow-lights", "200:65" },
        "--shadow-lights N:K: 65: give a whole number from 1 to 64");
    refused({ "--shadows", "ratio", "--shadow-lights", "40:" },
        "--shadow-lights N:K: (empty): give a whole number from 1 to 40");
    refused({ "--shadows", "ratio", "--shadow-scale", "1/8" }, "--shadow-scale: 1/8: choose 1, 1/4, 1/16, 1/1024");
    refused(
        { "--shadows", "ratio", "--shadow-time", "0" }, "--shadow-time: 0: give a number above 0 and at most 1000000");
    refused(
        { "--shadow-time", "1" }, none + "without --shadows: --shadow-time 1: leave it out, or add --shadows ratio");
    refused({ "--shadows", "ratio", "--shadow-time", "1", "--shadow-lights", "9" },
        none + "with --shadow-time 1: --shadow-lights 9: leave it out, or leave out --shadow-time");
    refused({ "--shadows", "ratio", "--shadow-time", "1", "--shadow-scale", "1/4" },
        none + "with --shadow-time 1: --shadow-scale 1/4: leave it out, or leave out --shadow-time");
    refused({ "--shadows", "ratio", "--shadow-scale", "1/1024" },
        "scale of shadows leaves less than a pixel of the image: --shadow-scale 1/1024, 24x16: take a larger share or "
        "a "
        "larger image");
    refused({ "--shadow-scale", "1/4" },
        none + "without --shadows: --shadow-scale 1/4: leave it out, or add --shadows ratio");
    refused({ "--shadows", "additive", "--shadow-scale", "1/4" },
        none + "with --shadows additive: --shadow-scale 1/4: leave it out, or add --shadows ratio");
    refused({ "--shadows", "ratio", "--shadow-complete", "lights", "--shadow-scale", "1/4" },
        none + "with --shadow-complete lights: --shadow-scale 1/4: leave it out, or choose another whole light");
    refused({ "--shadows", "ratio", "--shadow-clamp", "off" },
        none + "with --shadows ratio: --shadow-clamp off: leave it out, or add --shadows subtractive");
    refused({ "--shadows", "ratio", "--environment-widths", "curvature" },
        none + "with --shadows ratio: --environment-widths: leave it out, or leave out --shadows");
    refused({ "--shadows", "ratio", "--integrator", "ao" },
        none + "with integrator ao: --shadows ratio: leave it out, or add --integrator path");
    writeScene(place, "");
    refused({ "--shadows", "ratio" },
        none + "without an environment: --shadows ratio: leave it out, or add [environment] to the scene");
}

} // namespace wedge::app::test
