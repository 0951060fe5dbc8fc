// [environment] of scene files: maps of each kind, what is wrong with them, and what is told of them.
#include "tests/app_testing.h"

#include <doctest/doctest.h>

#include <cmath>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

/// A camera that looks ahead (-z) from the origin, and nothing else.
constexpr const char* ahead =
    "[camera]\neye = [0, 0, 0]\nlook_at = [0, 0, -1]\nfov = 20\n[image]\nwidth = 16\nheight = 16\n";

/// One with a floor below it.
void writeFloor(Workplace& place, const std::string& environment)
{
    place.write("floor.obj", "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3 4\n");
    place.write("s.toml",
        "[camera]\neye = [0, 2, 4]\nlook_at = [0, 0, 0]\n[image]\nwidth = 24\nheight = 16\n[[mesh]]\nfile = "
        "\"floor.obj\"\n"
            + environment);
}

struct Texel {
    float r, g, b;
};

/// A map of the colours, rows from above.
void writeMap(const std::filesystem::path& path, int width, int height, const std::vector<Texel>& texels)
{
    image::LayeredImage map;
    map.width = width;
    map.height = height;
    map.window = { 0, 0, width, height };
    map.channels = { { "R", {} }, { "G", {} }, { "B", {} } };
    for (const Texel& t : texels) {
        map.channels[0].values.push_back(t.r);
        map.channels[1].values.push_back(t.g);
        map.channels[2].values.push_back(t.b);
    }
    image::writeExr(path.string(), map);
}

/// The image of a scene.
image::LayeredImage render(Workplace& place, const std::vector<std::string>& more = {})
{
    std::vector<std::string> arguments { "render", "s.toml", "--quiet", "--method", "mc", "--spp", "16", "-o",
        "a.exr" };
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = place.run(arguments);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    return image::readExr((place.path() / "a.exr").string());
}

Texel middle(const image::LayeredImage& image)
{
    const std::size_t i = static_cast<std::size_t>(image.height / 2) * static_cast<std::size_t>(image.width)
        + static_cast<std::size_t>(image.width / 2);
    return { image.find("R")->values[i], image.find("G")->values[i], image.find("B")->values[i] };
}

} // namespace

TEST_CASE("a map is turned and scaled, and has its up where the scene does")
{
    Workplace place;
    // What is behind, left, ahead, right; above white, below black.
    const Texel behind { 8, 0, 0 }, left { 0, 8, 0 }, front { 0, 0, 8 }, right { 8, 8, 0 };
    std::vector<Texel> texels;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) {
            const Texel around[] = { behind, left, front, right };
            texels.push_back(y == 0 ? Texel { 9, 9, 9 } : y == 7 ? Texel { 0, 0, 0 } : around[(x + 2) / 4 % 4]);
        }
    writeMap(place.path() / "m.exr", 16, 8, texels);
    const auto seen = [&](const std::string& more, const std::string& view = ahead) {
        place.write("s.toml", view + std::string("[environment]\nmap = \"m.exr\"\n") + more);
        return middle(render(place));
    };
    const auto is = [](const Texel& t, const Texel& expected) {
        return std::abs(t.r - expected.r) + std::abs(t.g - expected.g) + std::abs(t.b - expected.b) < 1e-3f;
    };
    CHECK(is(seen(""), front));
    CHECK(is(seen("intensity = 0.5\n"), { 0, 0, 4 }));
    // Turned to the left by a quarter, what was to the right is ahead.
    CHECK(is(seen("rotation = 90\n"), right));
    CHECK(is(seen("rotation = -90\n"), left));
    CHECK(is(seen("rotation = 180\n"), behind));
    CHECK(is(seen("visible = false\n"), { 0, 0, 0 }));
    const std::string upwards = "[camera]\neye = [0, 0, 0]\nlook_at = [0, 1, 0]\nup = [0, 0, 1]\nfov = 5\n";
    CHECK(is(seen("", upwards), { 9, 9, 9 }));
    CHECK(is(seen("up = \"z\"\n", upwards), front)); // which is along y then
    const std::string alongX = "[camera]\neye = [0, 0, 0]\nlook_at = [1, 0, 0]\nfov = 5\n";
    CHECK(is(seen("", alongX), right));
}

TEST_CASE("an angular map is the same picture of the sphere")
{
    Workplace place;
    // Red where it is ahead, green to the right, blue above, grey behind.
    constexpr int side = 64;
    std::vector<Texel> texels;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double u = (x + 0.5) / side * 2 - 1, v = 1 - (y + 0.5) / side * 2, r = std::hypot(u, v);
            const double angle = r * std::acos(-1.0), sine = r > 0 ? std::sin(angle) / r : 0.0;
            const auto part = [](double c) { return static_cast<float>(std::max(c, 0.0)); };
            texels.push_back({ part(std::cos(angle)), part(u * sine), part(v * sine) });
        }
    writeMap(place.path() / "m.exr", side, side, texels);
    const auto seen = [&](const std::string& at, const std::string& up) {
        place.write("s.toml",
            "[camera]\neye = [0, 0, 0]\nlook_at = " + at + "\nup = " + up
                + "\nfov = 5\n[environment]\nmap = \"m.exr\"\nlayout = \"angular\"\n");
        return middle(render(place));
    };
    CHECK(seen("[0, 0, -1]", "[0, 1, 0]").r == doctest::Approx(1).epsilon(0.02));
    CHECK(seen("[1, 0, 0]", "[0, 1, 0]").g == doctest::Approx(1).epsilon(0.02));
    CHECK(seen("[0, 1, 0]", "[0, 0, 1]").b == doctest::Approx(1).epsilon(0.02));
    const Texel diagonal = seen("[1, 1, -1]", "[0, 1, 0]");
    for (const float c : { diagonal.r, diagonal.g, diagonal.b })
        CHECK(c == doctest::Approx(1 / std::sqrt(3.0)).epsilon(0.03));
    const Texel back = seen("[-1, -1, 1]", "[0, 1, 0]");
    CHECK(back.r + back.g + back.b < 0.05f);
}

TEST_CASE("an environment lights what there is, by every method, and is told of")
{
    Workplace place;
    writeFloor(place, "[environment]\nradiance = [1, 0.5, 0.25]\n");
    for (const char* method : { "mc", "aaf" }) {
        const image::LayeredImage image = render(place, { "--method", method, "--layers", "direct,emission" });
        float direct = 0, emission = 0;
        for (const float v : image.find("direct.R")->values)
            direct = std::max(direct, v);
        for (const float v : image.find("emission.R")->values)
            emission = std::max(emission, v);
        CHECK(direct == doctest::Approx(0.5).epsilon(0.2)); // of a grey
        CHECK(emission == 1.0f);
    }
    const Outcome info = place.run({ "info", "s.toml" });
    CHECK(contains(info.out, "environment, a map of 1x1"));
    CHECK_FALSE(contains(info.err, "no light"));
    CHECK(contains(place.run({ "info", "--json", "s.toml" }).out, "\"environment\""));
}

TEST_CASE("directions are chosen by the map or among pre-computed ones, as asked, and are told of")
{
    Workplace place;
    writeFloor(place, "[environment]\nradiance = [0.5, 0.7, 1]\n");
    const auto told = [&](Arguments more) {
        more.insert(more.begin(), { "render", "s.toml", "--quiet", "-o", "a.exr" });
        const Outcome outcome = place.run(more);
        REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
        return textOf(image::readExr((place.path() / "a.exr").string()), "method.environmentSampling");
    };
    CHECK(told({}) == "map");
    CHECK(told({ "--method", "mc", "--spp", "4" }) == "map");
    CHECK(told({ "--as-published" }) == "precomputed");
    CHECK(told({ "--as-published", "--environment-sampling", "map" }) == "map");
    const auto precomputed = [&](Arguments more) {
        more.insert(more.end(), { "--environment-sampling", "precomputed" });
        return more;
    };
    for (const Arguments& more :
        { Arguments {}, { "--method", "mc", "--spp", "4" }, { "--antialias" }, { "--progressive", "--spp", "16" } })
        CHECK(told(precomputed(more)) == "precomputed");
    const auto refused = [&](const Arguments& more, const std::string& says) {
        CAPTURE(says);
        Arguments all { "render", "s.toml", "-o", "a.exr" };
        all.insert(all.end(), more.begin(), more.end());
        const Outcome outcome = place.run(all);
        CHECK(outcome.status == wrongCall);
        CHECK(outcome.err.ends_with("wedge: error: option has no effect " + says + "; see wedge render --help\n"));
    };
    refused(precomputed({ "--method", "mc", "--light-sampling", "directions" }),
        "with reflected directions alone: --environment-sampling: leave it out, or add --light-sampling both");
    refused(precomputed({ "--integrator", "ao" }),
        "with integrator ao: --environment-sampling: leave it out, or add --integrator path");
    writeFloor(place, "");
    refused(precomputed({}),
        "without an environment: --environment-sampling: leave it out, or add [environment] to the scene");
}

TEST_CASE("a map's sun is told of, is seen as the map has it, stays in sequences, and can be left in the map")
{
    Workplace place;
    std::vector<Texel> texels(64 * 32, Texel { 1, 1, 1 });
    texels[10 * 64 + 32] = { 40000, 30000, 20000 };
    writeMap(place.path() / "m.exr", 64, 32, texels);
    const std::string keys = "[environment]\nmap = \"m.exr\"\n";
    writeFloor(place, keys);
    CHECK(contains(place.run({ "info", "s.toml" }).out, "a sun of it is an area light"));
    CHECK(contains(place.run({ "info", "--json", "s.toml" }).out, "\"share\""));
    const image::LayeredImage apart = render(place, { "--report", "r.json" });
    CHECK(contains(readAll(place.path() / "r.json"), "\"share\""));
    // A later frame has it, too: nothing moves, so that its floor is as bright.
    CHECK(place
              .run({ "render", "s.toml", "--quiet", "--frames", "3:3", "--method", "mc", "--spp", "16", "-o",
                  "f.%d.exr" })
              .status
        == 0);
    const Texel floor = middle(apart), later = middle(image::readExr((place.path() / "f.3.exr").string()));
    CHECK(later.g == doctest::Approx(floor.g).epsilon(0.1));
    writeFloor(place, keys + "suns = false\n");
    CHECK_FALSE(contains(place.run({ "info", "s.toml" }).out, "a sun of it"));
    CHECK(middle(render(place, { "--spp", "1024" })).g == doctest::Approx(floor.g).epsilon(0.1));
    const std::string view = "[camera]\neye = [0, 0, 0]\nlook_at = [0.05, 0.53, -1]\nfov = 1\n";
    place.write("s.toml", view + keys + "suns = false\n");
    const Texel whole = middle(render(place));
    place.write("s.toml", view + keys);
    CHECK(middle(render(place)).g == whole.g);
    CHECK(whole.g > 10000);
}

TEST_CASE("--environment-widths: which there are, what reports say of them, and where they have no effect")
{
    Workplace place;
    writeMap(place.path() / "m.exr", 4, 2, std::vector<Texel>(8, Texel { 1, 1, 1 }));
    const auto run = [&](const std::string& environment, const std::vector<std::string>& more) {
        writeFloor(place, environment);
        std::vector<std::string> arguments { "render", "s.toml", "--quiet", "-o", "a.exr", "--report", "r.json" };
        arguments.insert(arguments.end(), more.begin(), more.end());
        return place.run(arguments);
    };
    const auto widths = [&](const std::vector<std::string>& more) -> std::string {
        const Outcome outcome = run("[environment]\nmap = \"m.exr\"\n", more);
        REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
        return nlohmann::json::parse(place.text("r.json")).at("method").at("environmentWidths");
    };
    CHECK(widths({}) == "penumbrae");
    CHECK(widths({ "--as-published" }) == "curvature");
    CHECK(widths({ "--as-published", "--environment-widths", "penumbrae" }) == "penumbrae");
    CHECK(widths({ "--spp", "16", "--environment-widths", "curvature" }) == "curvature");
    CHECK(widths({ "--spp", "16", "--environment-widths", "flt" }) == "flt");
    CHECK(widths({ "--spp", "16", "--environment-widths", "corrected" }) == "corrected");
    CHECK(widths({ "--as-published", "--environment-widths", "corrected", "--sampling", "uniform" }) == "corrected");
    const auto refused = [&](const std::string& environment, std::vector<std::string> more, const std::string& what) {
        more.insert(more.end(), { "--environment-widths", "curvature" });
        const Outcome outcome = run(environment, more);
        CHECK(outcome.status == 2);
        CHECK_MESSAGE(contains(outcome.err, what), outcome.err);
        CHECK_MESSAGE(contains(outcome.err, "--environment-widths"), outcome.err);
        CHECK(std::ranges::count(outcome.err, '\n') == 1);
    };
    const std::string sky = "[environment]\nradiance = 1\n";
    refused("", {}, "without light from beyond the scene");
    refused(sky, { "--method", "mc" }, "with method mc");
    refused(sky, { "--integrator", "ao" }, "with integrator ao");
    refused(sky, { "--filter", "fixed" }, "with --filter fixed");
    refused(sky, { "--antialias" }, "with antialiasing");
    refused(sky, { "--progressive" }, "--progressive");
    refused(sky, { "--aperture", "0.1" }, "through a lens");
    const Outcome unknown = run(sky, { "--environment-widths", "wide" });
    CHECK(unknown.status == 2);
    CHECK_MESSAGE(contains(unknown.err, "wide"), unknown.err);
}

TEST_CASE("what is wrong with an environment is told in a line")
{
    Workplace place;
    writeMap(place.path() / "m.exr", 4, 2, std::vector<Texel>(8, Texel { 1, 1, 1 }));
    writeMap(place.path() / "nan.exr", 2, 1, { { 1, 1, 1 }, { std::nanf(""), 1, 1 } });
    place.write("junk.hdr", "no image");
    const auto refused = [&](const std::string& keys, const std::string& what) {
        writeFloor(place, "[environment]\n" + keys);
        const Outcome outcome = place.run({ "render", "s.toml", "--quiet", "-o", "a.exr" });
        CHECK(outcome.status == 1);
        CHECK_MESSAGE(contains(outcome.err, what), outcome.err);
        CHECK(std::ranges::count(outcome.err, '\n') == 1);
    };
    refused("", "neither a radiance nor a map");
    refused("radiance = 1\nmap = \"m.exr\"\n", "both a radiance and a map");
    refused("radiance = -1\n", "is negative");
    refused("radiance = 1\nrotation = 3\n", "has no effect without a map");
    refused("radiance = 1\nsuns = false\n", "has no effect without a map");
    refused("radiance = 1\nlayout = \"angular\"\n", "has no effect without a map");
    refused("map = \"m.exr\"\nlayout = \"angular\"\n", "4x2");
    refused("map = \"m.exr\"\nlayout = \"cube\"\n", "cube");
    refused("map = \"m.exr\"\nintensity = -1\n", "-1");
    refused("map = \"m.exr\"\nup = \"x\"\n", "x");
    refused("map = \"m.exr\"\nturn = 1\n", "unknown key in environment");
    refused("map = \"there.exr\"\n", "there.exr");
    refused("map = \"junk.hdr\"\n", "junk.hdr");
    refused("map = \"nan.exr\"\n", "no radiance");
    refused("map = 3\n", "must be");
}

} // namespace wedge::app::test
