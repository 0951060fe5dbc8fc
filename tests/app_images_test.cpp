// Image files that the command line and scenes name: limits, sizes before pixels, and files that never end.
#include "tests/app_testing.h"

#include <sys/stat.h>

using namespace wedge;
using namespace wedge::app::test;

namespace {

const std::string scene =
    "[[mesh]]\nfile = \"m.obj\"\nmaterial = \"a\"\n[[material]]\nname = \"a\"\ndiffuse_texture = \"t\"\n";
const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n";

/// A flat bitmap of 2x2 pixels.
const std::string bitmap("BM\0\0\0\0\0\0\0\0\x1a\0\0\0\x0c\0\0\0\2\0\2\0\1\0\x18\0abcdef\0\0abcdef\0\0", 42);

/// Radiance of that size without a pixel.
std::string hdr(int width, int height)
{
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
}

} // namespace

TEST_CASE("--max-texture-pixels")
{
    const Workplace place;
    place.write("s.toml", scene);
    place.write("m.obj", mesh);
    place.write("t", bitmap);
    CHECK(place.run({ "info", "s.toml" }).status == 0);
    CHECK(place.run({ "info", "s.toml", "--max-texture-pixels", "4" }).status == 0);
    for (const char* command : { "info", "render" }) {
        checkRefused(place, { command, "s.toml", "--max-texture-pixels", "3" }, failure, "raise --max-texture-pixels");
        for (const char* bad : { "0", "-1", "1073741825", "2e6" })
            checkRefused(place, { command, "s.toml", "--max-texture-pixels", bad }, wrongCall, "from 1 to 1073741824");
        checkRefused(
            place, { command, "s.toml", "--max-texture-pixels", "" }, wrongCall, "--max-texture-pixels (empty)");
    }
}

TEST_CASE("sizes are compared before pixels are decoded")
{
    const Workplace place;
    place.write("m.obj", mesh);
    place.write("a.hdr", hdr(20, 10));
    place.write("b.hdr", hdr(10, 20));
    checkRefused(place, { "compare", "a.hdr", "b.hdr" }, failure, "20x10 and 10x20");
    checkRefused(place, { "compare", "a.hdr", "a.hdr" }, failure, "it ends before the picture does");
    checkRefused(
        place, { "render", "m.obj", "--quiet", "--size", "30x30", "--reference", "a.hdr" }, failure, "20x10 and 30x30");
    checkRefused(
        place, { "render", "m.obj", "--quiet", "--size", "20x10", "--reference", "a.hdr" }, failure, "it ends before");
}

TEST_CASE("what is compared of pictures that are stored in part, or with more around them")
{
    const Workplace place;
    const auto write = [&](const std::string& name, const image::Window& window, float beyond) {
        image::LayeredImage picture { 8, 6, window, {}, {} };
        for (const char* channel : { "R", "G", "B" }) {
            picture.channels.push_back({ channel, {} });
            for (int y = window.y0; y < window.y1; ++y)
                for (int x = window.x0; x < window.x1; ++x)
                    picture.channels.back().values.push_back(
                        x < 0 || y < 0 || x >= 8 || y >= 6 ? beyond : 0.01f * static_cast<float>(10 * y + x));
        }
        image::writeExr((place.path() / name).string(), picture);
    };
    write("full.exr", { 0, 0, 8, 6 }, 0);
    write("more.exr", { -3, -2, 9, 9 }, 1e30f);
    write("crop.exr", { 2, 1, 6, 4 }, 0);
    write("same.exr", { 2, 1, 6, 4 }, 0);
    write("other.exr", { 4, 2, 8, 5 }, 0);
    const auto compared = [&](const char* a, const char* b) {
        const Outcome outcome = place.run({ "compare", a, b, "--metric", "rmse" });
        CHECK(outcome.status == 0);
        CHECK(outcome.out == "0\n");
        return outcome.err;
    };
    CHECK(compared("full.exr", "more.exr") == "");
    CHECK(compared("more.exr", "more.exr") == "");
    CHECK(compared("crop.exr", "same.exr") == "");
    CHECK(compared("crop.exr", "more.exr")
        == "wedge: warning: compared are the pixels 2,1,6,4 of the frame, which both crop.exr and more.exr store\n");
    CHECK(contains(compared("crop.exr", "other.exr"), "the pixels 4,2,6,4 of"));

    place.write("m.obj", mesh);
    const auto with = [](const char* reference, const std::string& crop) {
        Arguments all { "render", "m.obj", "--quiet", "--size", "8x6", "--method", "mc", "--spp", "1", "-o", "a.exr",
            "--reference", reference };
        if (!crop.empty())
            all.insert(all.end(), { "--crop", crop });
        return all;
    };
    for (const auto& asked : { std::pair("full.exr", ""), std::pair("more.exr", ""), std::pair("full.exr", "2,1,6,4"),
             std::pair("more.exr", "2,1,6,4"), std::pair("crop.exr", "2,1,6,4"), std::pair("crop.exr", "3,2,5,4") }) {
        const auto& [reference, crop] = asked;
        CAPTURE(asked.first);
        CAPTURE(asked.second);
        const Outcome outcome = place.run(with(reference, crop));
        CHECK_MESSAGE(outcome.status == 0, outcome.err);
    }
    checkRefused(place, with("crop.exr", ""), failure, "crop.exr lacks a part of the image: 2,1,6,4 and 0,0,8,6");
    checkRefused(place, with("crop.exr", "4,2,8,5"), failure, "2,1,6,4 and 4,2,8,5: render with --crop 2,1,6,4");
}

TEST_CASE("a file that never ends is no image")
{
    const Workplace place;
    place.write("s.toml", scene);
    place.write("m.obj", mesh);
    for (const char* name : { "t", "a.png", "a.exr", "a.hdr" })
        REQUIRE(mkfifo((place.path() / name).c_str(), 0600) == 0);
    checkRefused(place, { "info", "s.toml" }, failure, "not a regular file");
    for (const char* name : { "a.png", "a.exr", "a.hdr" }) {
        checkRefused(place, { "compare", name, name }, failure, "not a regular file");
        checkRefused(place, { "render", "m.obj", "--quiet", "--reference", name }, failure, "not a regular file");
    }
}
