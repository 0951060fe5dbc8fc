// Maps of [environment] whose headers or numbers are unusual: what is used of them, and what is said.
#include "tests/app_testing.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace wedge::app::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A grey map of 16 x 8 that stores the rows from y0 to y1, which is not among them, and those texels.
void writeMap(const Workplace& place, int y0, int y1, const std::vector<std::pair<int, float>>& texels = {})
{
    image::LayeredImage map { 16, 8, { 0, y0, 16, y1 }, {}, {} };
    for (const char* name : { "R", "G", "B" })
        map.channels.push_back({ name, std::vector<float>(static_cast<std::size_t>(16 * (y1 - y0)), 1.0f) });
    for (const auto& [at, value] : texels)
        for (image::Channel& channel : map.channels)
            channel.values[static_cast<std::size_t>(at)] = value;
    image::writeExr((place.path() / "m.exr").string(), map);
}

/// The mean of what a camera in the middle of the map sees that looks along a direction, and what was said.
struct Seen {
    double mean = 0.0;
    std::string said;
};

Seen seen(const Workplace& place, const std::string& direction, const std::string& keys = "map = \"m.exr\"\n")
{
    place.write("s.toml",
        "[camera]\neye = [0, 0, 0]\nlook_at = " + direction
            + "\nup = [0, 0.1, -1]\nfov = 20\n[image]\nwidth = 8\nheight = 8\n[environment]\nsuns = false\n" + keys);
    const Outcome outcome = place.run({ "render", "s.toml", "--method", "mc", "--spp", "1", "-o", "a.exr" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const std::string known = "wedge: warning: scene s.toml: no mesh, only lights and what is behind all are seen\n";
    REQUIRE(outcome.err.ends_with(known));
    Seen result { 0.0, outcome.err.substr(0, outcome.err.size() - known.size()) };
    const image::LayeredImage picture = place.exr("a.exr");
    for (const float v : picture.find("G")->values)
        result.mean += v / 64.0;
    return result;
}

std::string refusal(const Workplace& place, const std::string& keys = "map = \"m.exr\"\n")
{
    place.write("s.toml",
        "[camera]\neye = [0, 0, 0]\nlook_at = [0, 0, -1]\n[image]\nwidth = 8\nheight = 8\n[environment]\n" + keys);
    const Outcome outcome = place.run({ "render", "s.toml", "--quiet", "-o", "a.exr" });
    CHECK(outcome.status == failure);
    CHECK(std::ranges::count(outcome.err, '\n') == 1);
    return outcome.err;
}

} // namespace

TEST_CASE("a map that stores its upper half has a black lower one")
{
    const Workplace place;
    writeMap(place, 0, 4);
    CHECK(seen(place, "[0, 1, 0]").mean == doctest::Approx(1));
    CHECK(seen(place, "[0, -1, 0]").mean == 0);
    writeMap(place, 4, 8);
    CHECK(seen(place, "[0, 1, 0]").mean == 0);
    CHECK(seen(place, "[0, -1, 0]").mean == doctest::Approx(1));
}

TEST_CASE("what a map stores outside of its display window is no part of the sphere")
{
    const Workplace place;
    std::vector<std::pair<int, float>> outside;
    outside.reserve(16 * 4);
    for (int i = 0; i < 16 * 4; ++i)
        outside.emplace_back(i, infinity); // four rows above the zenith
    writeMap(place, -4, 8, outside);
    const Seen above = seen(place, "[0, 1, 0]");
    CHECK(above.mean == doctest::Approx(1));
    CHECK(above.said == "");
}

TEST_CASE("infinite texels count as the largest finite number of the map, which is said")
{
    const Workplace place;
    std::vector<std::pair<int, float>> texels { { 16 * 4, 30.0f } };
    for (int i = 0; i < 16; ++i)
        texels.emplace_back(i, infinity);
    writeMap(place, 0, 8, texels);
    const Seen above = seen(place, "[0, 1, 0]");
    CHECK(above.mean == doctest::Approx(30).epsilon(0.1));
    CHECK(above.said
        == "wedge: warning: environment map m.exr: 16 texels are infinite, and count as 30, the largest finite number "
           "in it: repair the map, or write it "
           "anew as 32-bit floats\n");
    CHECK(seen(place, "[0, 1, 0]", "map = \"m.exr\"\nintensity = 0\n").mean == 0);
    texels.clear();
    for (int i = 0; i < 16 * 8; ++i)
        texels.emplace_back(i, i == 3 ? infinity : 0.0f);
    writeMap(place, 0, 8, texels);
    CHECK(contains(refusal(place), "infinite numbers and no finite one above 0: 3 in "));
    writeMap(place, 0, 8, { { 5, -infinity } });
    CHECK(contains(refusal(place), "numbers that are no radiance: 3 in "));
    CHECK(contains(refusal(place), "m.exr"));
}

TEST_CASE("radiance beyond what is worked with is said, of maps, by the intensity, and the same everywhere")
{
    const Workplace place;
    writeMap(place, 0, 8, { { 3, 1e20f } });
    CHECK(contains(seen(place, "[0, -1, 0]").said, "1 texel is beyond 1e+12 W/(sr m^2)"));
    writeMap(place, 0, 8, { { 3, 2e4f }, { 4, 3e4f } });
    CHECK(seen(place, "[0, -1, 0]").said == "");
    const Seen strong = seen(place, "[0, -1, 0]", "map = \"m.exr\"\nintensity = 1e8\n");
    CHECK(contains(strong.said, "2 texels are beyond 1e+12 W/(sr m^2) by its numbers and the intensity 1e+08"));
    writeMap(place, 0, 8, { { 3, 3e38f } });
    CHECK(contains(seen(place, "[0, -1, 0]", "map = \"m.exr\"\nintensity = 1e8\n").said, "1 texel is beyond"));
    place.write("s.toml", "[environment]\nradiance = [1, 1e8, 1]\nintensity = 1e6\n");
    CHECK(contains(place.run({ "info", "s.toml" }).err, "radiance times intensity is 1e+14 W/(sr m^2), 1e+12 is used"));
}

TEST_CASE("negative numbers count as 0, and are said where they are no trace of resampling")
{
    const Workplace place;
    writeMap(place, 0, 8, { { 3, 100.0f }, { 4, -0.5f } });
    CHECK(seen(place, "[0, -1, 0]").said == "");
    writeMap(place, 0, 8, { { 3, -1.0f } });
    CHECK(contains(seen(place, "[0, -1, 0]").said, "3 negative numbers, down to -1, are no radiance and count as 0"));
    std::vector<std::pair<int, float>> texels { { 64, 1000.0f } };
    for (int i = 0; i < 32; ++i)
        texels.emplace_back(i, -20.0f);
    writeMap(place, 0, 8, texels);
    CHECK(contains(seen(place, "[0, -1, 0]").said, "96 negative numbers, down to -20"));
}

TEST_CASE("a cube map is no map of the sphere that is read")
{
    const Workplace place;
    const std::string path = (place.path() / "m.exr").string();
    {
        Imf::Header header(2, 12);
        std::vector<float> values(24, 1.0f);
        Imf::FrameBuffer frame;
        for (const char* name : { "R", "G", "B" }) {
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow()));
        }
        Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(12);
    }
    CHECK(contains(refusal(place), "environment map is a cube map (its attribute envmap): "));
}

TEST_CASE("an exposure that a map was multiplied with is not in its light")
{
    const Workplace place;
    const auto map = [&](const std::string& lines) {
        std::string pixels;
        for (int i = 0; i < 8; ++i)
            pixels += std::string("\x80\x80\x80\x81", 4);
        place.write("m.hdr", "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + pixels);
        return seen(place, "[0, 1, 0]", "map = \"m.hdr\"\n").mean;
    };
    CHECK(map("") == doctest::Approx(1));
    CHECK(map("EXPOSURE=4\n") == doctest::Approx(0.25));
    CHECK(map("EXPOSURE=4\nEXPOSURE=0.5\nCOLORCORR=1 0.25 1\n") == doctest::Approx(2));
    place.write("m.hdr", "#?RADIANCE\nEXPOSURE=none\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n1111");
    CHECK(contains(refusal(place, "map = \"m.hdr\"\n"), "its header has 'EXPOSURE=none', which is not a number"));
}

} // namespace wedge::app::test
