// What headers say of pixels beside their values: windows, primaries, curves, and kinds that are refused.
#include "host/image/exr.h"
#include "host/image/metrics.h"
#include "host/image/read_image.h"

#include "host/error.h"
#include "tests/image_test_support.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <doctest/doctest.h>
#include <functional>
#include <optional>
#include <vector>

using namespace wedge::image;
using namespace wedge::image::test;

namespace {

/// What a pixel has, by its place in the display window.
using Colour = std::function<float(int x, int y, int channel)>;

float place(int x, int y, int channel) { return static_cast<float>(100 * channel + 10 * y + x); }

/// Writes channels of those names over a data window, both windows with corners that are inclusive.
void writeExrOf(const std::string& path, const Imath::Box2i& display, const Imath::Box2i& data,
    const std::function<void(Imf::Header&)>& change = {}, const Colour& colour = place,
    const std::vector<std::string>& names = { "R", "G", "B" })
{
    Imf::Header header(display, data);
    const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
    std::vector<std::vector<float>> values(names.size());
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < names.size(); ++c) {
        for (int y = data.min.y; y <= data.max.y; ++y)
            for (int x = data.min.x; x <= data.max.x; ++x)
                values[c].push_back(colour(x - display.min.x, y - display.min.y, static_cast<int>(c)));
        header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, values[c].data(), data));
    }
    CHECK(static_cast<int>(values[0].size()) == width * height);
    if (change)
        change(header);
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
}

/// The pixels of that window, black outside of `stored`.
std::vector<float> placesOf(const Window& window, const Window& stored)
{
    std::vector<float> out;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            for (int c = 0; c < 3; ++c)
                out.push_back(stored.contains({ x, y, x + 1, y + 1 }) ? place(x, y, c) : 0.0f);
    return out;
}

std::string errorOf(const std::function<void()>& call)
{
    try {
        call();
    } catch (const wedge::Error& error) {
        return error.what();
    }
    return "no error";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("an EXR's picture is its display window: black where nothing is stored, and without overscan")
{
    const TempDirectory directory;
    const std::string path = directory / "a.exr";
    const Imath::Box2i display({ 10, -4 }, { 17, -1 }); // 8 x 4
    const Window whole { 0, 0, 8, 4 };
    const std::pair<Imath::Box2i, Window> windows[] = {
        { display, whole }, { { { 10, -4 }, { 17, -3 } }, { 0, 0, 8, 2 } }, // the upper half
        { { { 12, -3 }, { 13, -3 } }, { 2, 1, 4, 2 } }, // a part inside
        { { { 5, -9 }, { 30, 20 } }, { -5, -5, 21, 25 } }, // more on all sides
        { { { 14, -9 }, { 30, -3 } }, { 4, -5, 21, 2 } }, // both
    };
    for (const auto& pair : windows) {
        const auto& data = pair.first;
        const Window& window = pair.second;
        CAPTURE(window.x0);
        CAPTURE(window.y1);
        writeExrOf(path, display, data);
        ImageFile file(path);
        CHECK(file.whole() == whole);
        CHECK(file.stored() == window.within(whole));
        CHECK(file.read().rgb == placesOf(whole, window));
        const Window part { 3, 0, 6, 3 };
        const RgbImage cut = ImageFile(path).read(part);
        CHECK(cut.width == 3);
        CHECK(cut.height == 3);
        CHECK(cut.rgb == placesOf(part, window));
    }
    writeExrOf(path, display, { { 18, 0 }, { 20, 3 } });
    const std::string outside = errorOf([&] { readImage(path); });
    CHECK(contains(outside, "its data window lies outside of its display window"));
    CHECK(contains(outside, path));
}

TEST_CASE("a frame that claims more than its part is held against the size of the file")
{
    const TempDirectory directory;
    const std::string path = directory / "a.exr";
    writeExrOf(path, { { 0, 0 }, { 65535, 8191 } }, { { 5, 5 }, { 6, 6 } });
    ImageFile file(path);
    CHECK(file.read(file.stored()).rgb == placesOf({ 5, 5, 7, 7 }, file.stored()));
    CHECK(contains(errorOf([&] { readImage(path); }), "it has 65536x8192 pixels, at most 67108864 are read"));
    writeExrOf(path, { { 0, 0 }, { 8191, 4095 } }, { { 5, 5 }, { 6, 6 } });
    CHECK(contains(errorOf([&] { readImage(path); }), "it claims 8192x4096 pixels in "));
}

TEST_CASE("what is compared of two files")
{
    const TempDirectory directory;
    const Imath::Box2i display({ 0, 0 }, { 7, 3 });
    const auto file = [&](const std::string& name, const Imath::Box2i& frame, const Imath::Box2i& data) {
        writeExrOf(directory / name, frame, data);
        return ImageFile(directory / name);
    };
    const ImageFile full = file("full.exr", display, display),
                    more = file("more.exr", display, { { -2, -2 }, { 9, 9 } });
    const ImageFile crop = file("crop.exr", display, { { 2, 1 }, { 5, 2 } });
    const ImageFile other = file("other.exr", display, { { 4, 0 }, { 7, 1 } });
    const ImageFile apart = file("apart.exr", display, { { 0, 3 }, { 3, 3 } });
    const ImageFile alone = file("alone.exr", { { 0, 0 }, { 3, 1 } }, { { 0, 0 }, { 3, 1 } }); // as large as the crop
    const auto check = [](const ImageFile& a, const ImageFile& b, const Window& ofA, const Window& ofB, bool isLess) {
        const ComparedParts parts = comparedParts(a, b);
        CHECK(parts.image == ofA);
        CHECK(parts.reference == ofB);
        CHECK(parts.isLess == isLess);
    };
    const Window whole { 0, 0, 8, 4 }, cropped { 2, 1, 6, 3 };
    check(full, full, whole, whole, false);
    check(full, more, whole, whole, false);
    check(more, more, whole, whole, false);
    check(crop, crop, cropped, cropped, false);
    check(full, crop, cropped, cropped, true);
    check(crop, other, { 4, 1, 6, 2 }, { 4, 1, 6, 2 }, true);
    check(crop, alone, cropped, { 0, 0, 4, 2 }, false);
    CHECK(contains(errorOf([&] { comparedParts(crop, apart); }), "different parts of the frame: 2,1,6,3 and 0,3,4,4"));
    CHECK(contains(errorOf([&] { comparedParts(full, alone); }), "differ in size: 8x4 and 4x2"));
}

TEST_CASE("chromaticities of an EXR are converted, its neutral colour to grey")
{
    const TempDirectory directory;
    const std::string path = directory / "a.exr";
    const Imath::Box2i window({ 0, 0 }, { 1, 0 });
    const auto red = [](int x, int, int c) { return x == 1 || c == 0 ? 0.5f : 0.0f; }; // red and grey
    const auto read = [&](const Imf::Chromaticities& chromaticities, std::optional<Imath::V2f> neutral = {}) {
        writeExrOf(
            path, window, window,
            [&](Imf::Header& header) {
                Imf::addChromaticities(header, chromaticities);
                if (neutral)
                    Imf::addAdoptedNeutral(header, *neutral);
            },
            red);
        return readImage(path).rgb;
    };
    const std::vector<float> stored { 0.5f, 0, 0, 0.5f, 0.5f, 0.5f };
    CHECK(read(Imf::Chromaticities()) == stored);
    const Imath::V2f d65(0.3127f, 0.3290f), d60(0.32168f, 0.33767f);
    const std::vector<float> wide =
        read(Imf::Chromaticities { { 0.708f, 0.292f }, { 0.170f, 0.797f }, { 0.131f, 0.046f }, d65 });
    const float expected[] = { 0.5f * 1.6605f, 0.5f * -0.1246f, 0.5f * -0.0182f, 0.5f, 0.5f, 0.5f };
    for (std::size_t i = 0; i < 6; ++i)
        CHECK(wide[i] == doctest::Approx(expected[i]).epsilon(2e-4));
    const std::vector<float> aces =
        read(Imf::Chromaticities { { 0.7347f, 0.2653f }, { 0, 1 }, { 0.0001f, -0.0770f }, d60 });
    CHECK(aces[0] == doctest::Approx(0.5 * 2.5217).epsilon(2e-4));
    for (std::size_t i = 3; i < 6; ++i)
        CHECK(aces[i] == doctest::Approx(0.5).epsilon(1e-5));
    const std::vector<float> cool = read(Imf::Chromaticities(), d60);
    CHECK(cool[5] > 1.04f * cool[3]);
    const Imf::Chromaticities none({ 0.3f, 0.3f }, { 0.3f, 0.3f }, { 0.3f, 0.3f }, { 0.3f, 0.3f });
    const std::string refused = errorOf([&] { read(none); });
    CHECK(contains(refused, "its primaries span no colours"));
    CHECK(contains(refused, path));
}

TEST_CASE("chromaticities leave a luminance alone as it is")
{
    const TempDirectory directory;
    const Imath::Box2i window({ 0, 0 }, { 0, 0 });
    const auto wide = [](Imf::Header& header) {
        Imf::addChromaticities(header, { { 0.7f, 0.3f }, { 0.2f, 0.7f }, { 0.1f, 0.1f }, { 0.4f, 0.4f } });
        Imf::addAdoptedNeutral(header, { 0.3f, 0.3f });
    };
    writeExrOf(directory / "a.exr", window, window, wide, [](int, int, int) { return 0.3f; }, { "Y" });
    CHECK(readImage(directory / "a.exr").rgb == std::vector<float> { 0.3f, 0.3f, 0.3f });
}

TEST_CASE("an EXR of luminance and chroma is refused, and a cube map says that it is one")
{
    const TempDirectory directory;
    const std::string path = directory / "a.exr";
    const Imath::Box2i window({ 0, 0 }, { 1, 1 });
    writeExrOf(path, window, window, {}, place, { "Y", "RY", "BY" });
    const std::string refused = errorOf([&] { readImage(path); });
    CHECK(contains(refused, path + " stores luminance and chroma, its channels are: BY, RY, Y"));
    for (const auto& [kind, isCube] : { std::pair(Imf::ENVMAP_LATLONG, false), std::pair(Imf::ENVMAP_CUBE, true) }) {
        writeExrOf(path, window, window, [kind = kind](Imf::Header& header) { Imf::addEnvmap(header, kind); });
        CHECK(ImageFile(path).isCubeMap() == isCube);
    }
    writeExrOf(path, window, window);
    CHECK_FALSE(ImageFile(path).isCubeMap());
}

TEST_CASE("what a Radiance HDR was multiplied with is divided out")
{
    const TempDirectory directory;
    const std::string path = directory / "a.hdr";
    const auto read = [&](const std::string& lines) {
        writeBytes(path,
            "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x40\x20\x81", 4));
        return readImage(path).rgb;
    };
    CHECK(read("") == std::vector<float> { 1, 0.5f, 0.25f });
    CHECK(read("EXPOSURE=4\nCOLORCORR=1 2 0.5\nEXPOSURE=0.5\n") == std::vector<float> { 0.5f, 0.125f, 0.25f });
    const std::string refused = errorOf([&] { read("EXPOSURE=0\n"); });
    CHECK(contains(refused, "EXPOSURE=0"));
    CHECK(contains(refused, path));
}
