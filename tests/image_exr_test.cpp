#include "host/image/exr.h"
#include "host/image/read_image.h"

#include "host/error.h"
#include "tests/image_test_support.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTestFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <stdexcept>

using namespace wedge::image;
using namespace wedge::image::test;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

std::vector<float> noise(std::size_t count, std::uint32_t seed)
{
    std::vector<float> values;
    for (std::size_t i = 0; i < count; ++i)
        values.push_back(static_cast<float>(hashed(static_cast<std::uint32_t>(i), 0, 0, seed) * 10.0 - 5.0));
    return values;
}

LayeredImage layered(int width, int height, Window window)
{
    const auto pixels = static_cast<std::size_t>(window.width()) * window.height();
    LayeredImage image { width, height, window, {}, {} };
    std::uint32_t seed = 0;
    for (const char* name : { "R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "depth.Z", "objectId.I" })
        image.channels.push_back({ name, noise(pixels, ++seed), false });
    image.channels.back().integer = true;
    for (std::size_t i = 0; i < pixels; ++i)
        image.channels.back().values[i] = static_cast<float>(i % 5 ? 16777216 - i : 0);
    image.channels[6].values.back() = infinity;
    return image;
}

bool sameBits(const std::vector<float>& a, const std::vector<float>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
        [](float x, float y) { return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y); });
}

void checkSameChannels(const LayeredImage& read, const LayeredImage& written)
{
    REQUIRE(read.channels.size() == written.channels.size());
    for (const Channel& channel : written.channels) {
        CAPTURE(channel.name);
        const Channel* found = read.find(channel.name);
        REQUIRE(found);
        CHECK(found->integer == channel.integer);
        CHECK(sameBits(found->values, channel.values));
    }
}

std::string readError(const std::string& path)
{
    try {
        readExr(path);
    } catch (const wedge::Error& error) {
        return error.what();
    }
    return "no error";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("floats come back bit by bit, whole frames and crops")
{
    const TempDirectory directory;
    const Window windows[] = { { 0, 0, 1, 1 }, { 0, 0, 37, 23 }, { 5, 7, 31, 8 }, { 36, 22, 37, 23 } };
    for (const Window& window : windows) {
        CAPTURE(window.x0);
        CAPTURE(window.x1);
        LayeredImage image = layered(37, 23, window);
        image.channels[0].values[0] = -0.0f;
        image.channels[1].values[0] = std::numeric_limits<float>::denorm_min();
        image.channels[2].values[0] = std::numeric_limits<float>::max();
        image.channels[3].values[0] = std::numeric_limits<float>::quiet_NaN();
        image.channels[4].values[0] = -infinity;
        writeExr(directory / "a.exr", image);
        const LayeredImage read = readExr(directory / "a.exr");
        CHECK(read.width == 37);
        CHECK(read.height == 23);
        CHECK(read.window == window);
        checkSameChannels(read, image);
        CHECK(std::isinf(read.find("depth.Z")->values.back()));
        CHECK(read.find("depth") == nullptr);
    }
    CHECK(directory.entries() == 1);
}

TEST_CASE("pixels stand where they belong")
{
    // A crop of 2x3 at (4, 1): the values spell x + 100 y, checked with OpenEXR itself and not with our reader.
    const TempDirectory directory;
    LayeredImage image { 8, 6, { 4, 1, 6, 4 }, { { "R", { 104, 105, 204, 205, 304, 305 }, false } }, {} };
    writeExr(directory / "a.exr", image);
    Imf::InputFile file((directory / "a.exr").c_str());
    CHECK(file.header().displayWindow() == Imath::Box2i({ 0, 0 }, { 7, 5 }));
    CHECK(file.header().dataWindow() == Imath::Box2i({ 4, 1 }, { 5, 3 }));
    std::vector<float> frame(48, -1.0f);
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, frame.data(), Imath::V2i(0, 0), 8, 6));
    file.setFrameBuffer(buffer);
    file.readPixels(1, 3);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 8; ++x)
            CHECK(frame[static_cast<std::size_t>(8 * y + x)]
                == (x >= 4 && x < 6 && y >= 1 && y < 4 ? static_cast<float>(x + 100 * y) : -1.0f));
}

TEST_CASE("the file is scanline ZIP of floats with Rec.709 chromaticities and typed metadata")
{
    const TempDirectory directory;
    LayeredImage image = layered(9, 4, { 0, 0, 9, 4 });
    const std::array<float, 16> matrix { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16 };
    image.metadata = { { "seed", -7 }, { "renderTimeSeconds", 1.5f },
        { "device", std::string("a device \"of\" some kind") }, { "worldToCamera", matrix }, { "worldToNDC", matrix },
        { "empty", std::string() } };
    writeExr(directory / "a.exr", image);
    CHECK(readExr(directory / "a.exr").metadata == image.metadata);

    const Imf::InputFile file((directory / "a.exr").c_str());
    const Imf::Header& header = file.header();
    CHECK(header.compression() == Imf::ZIP_COMPRESSION);
    CHECK(header.channels()["depth.Z"].type == Imf::FLOAT);
    CHECK(header.channels()["objectId.I"].type == Imf::UINT);
    REQUIRE(Imf::hasChromaticities(header));
    CHECK(Imf::chromaticities(header).red == Imath::V2f(0.64f, 0.33f));
    CHECK(Imf::chromaticities(header).white == Imath::V2f(0.3127f, 0.3290f));
    REQUIRE(Imf::hasWorldToCamera(header)); // of the type that the standard says
    CHECK(Imf::worldToCamera(header)[3][1] == 14.0f);
    REQUIRE(Imf::hasWorldToNDC(header));
    bool tiled = true;
    CHECK(Imf::isOpenExrFile((directory / "a.exr").c_str(), tiled));
    CHECK_FALSE(tiled);
}

TEST_CASE("integer channels are clamped to what the file can hold")
{
    const TempDirectory directory;
    const float notANumber = std::numeric_limits<float>::quiet_NaN();
    LayeredImage image { 6, 1, { 0, 0, 6, 1 }, { { "id.I", { -3, 2.6f, 4e9f, 1e20f, infinity, notANumber }, true } },
        {} };
    writeExr(directory / "a.exr", image);
    const std::vector<float> read = readExr(directory / "a.exr").channels.at(0).values;
    CHECK(read == std::vector<float> { 0, 3, 4e9f, 4294967296.0f, 4294967296.0f, 0 });
}

TEST_CASE("an image that contradicts itself is not written")
{
    const TempDirectory directory;
    const LayeredImage good = layered(4, 4, { 0, 0, 4, 4 });
    LayeredImage wrongSize = good;
    wrongSize.channels[1].values.pop_back();
    LayeredImage twice = good;
    twice.channels[1].name = "R";
    LayeredImage emptyWindow = good;
    emptyWindow.window = { 2, 2, 2, 3 };
    LayeredImage reserved = good;
    reserved.metadata["version"] = std::string("0.1");
    for (const LayeredImage& bad : { wrongSize, twice, emptyWindow, reserved, LayeredImage {} })
        CHECK_THROWS_AS(writeExr(directory / "a.exr", bad), std::logic_error);
    CHECK(directory.entries() == 0);
}

namespace {

// A 40x30 image of halfs (G a uint) with that compression, data window from (-2, 3), display window from (10, 20).
constexpr Imath::V2i dataOrigin { -2, 3 };
void writeForeign(const std::string& path, Imf::Compression compression, bool tiled)
{
    static std::vector<half> red(1200);
    static std::vector<std::uint32_t> green(1200);
    for (std::uint32_t i = 0; i < 1200; ++i) {
        red[i] = half(static_cast<float>(i % 40) / 64.0f);
        green[i] = i;
    }
    const Imath::Box2i data(dataOrigin, dataOrigin + Imath::V2i(39, 29));
    Imf::Header header(Imath::Box2i({ 10, 20 }, { 109, 69 }), data);
    header.compression() = compression;
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    header.channels().insert("G", Imf::Channel(Imf::UINT));
    header.channels().insert("B", Imf::Channel(Imf::HALF));
    header.insert("precise", Imf::DoubleAttribute(1.0)); // a type that is not ours
    Imf::FrameBuffer frame;
    frame.insert("R", Imf::Slice::Make(Imf::HALF, red.data(), data));
    frame.insert("G", Imf::Slice::Make(Imf::UINT, green.data(), data));
    frame.insert("B", Imf::Slice::Make(Imf::HALF, red.data(), data));
    if (tiled) {
        header.setTileDescription(Imf::TileDescription(16, 8, Imf::ONE_LEVEL));
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(30);
    }
}

} // namespace

TEST_CASE("files of other programs: half and uint, tiles, every kind of compression, any window")
{
    const TempDirectory directory;
    const std::string path = directory / "foreign.exr";
    for (const bool tiled : { false, true }) {
        for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression) {
            CAPTURE(tiled);
            CAPTURE(compression);
            writeForeign(path, static_cast<Imf::Compression>(compression), tiled);
            const LayeredImage image = readExr(path);
            CHECK(image.width == 100);
            CHECK(image.height == 50);
            CHECK(image.window == Window { -12, -17, 28, 13 });
            CHECK(image.metadata.empty());
            REQUIRE(image.find("G"));
            CHECK(image.find("G")->integer);
            CHECK(image.find("G")->values[1199] == 1199.0f);
            CHECK(image.find("R")->values[41] == doctest::Approx(1.0 / 64.0).epsilon(0.02)); // B44 loses some
            CHECK(image.find("R")->values[39] == doctest::Approx(39.0 / 64.0).epsilon(0.02));
        }
    }
    // The picture is the display window: the last pixel of the data, at (27, 12) of it, among them.
    const RgbImage colour = readImage(path);
    CHECK(colour.width == 100);
    CHECK(colour.height == 50);
    CHECK(colour.rgb[3 * (12 * 100 + 27) + 1] == 1199.0f);
    CHECK(colour.rgb[3 * (12 * 100 + 28) + 1] == 0.0f);
}

TEST_CASE("beauty is the root colour, or a gray")
{
    const LayeredImage image = layered(3, 2, { 1, 0, 3, 2 });
    const RgbImage colour = beauty(image);
    CHECK(colour.width == 2);
    CHECK(colour.height == 2);
    REQUIRE(colour.rgb.size() == 12);
    for (std::size_t i = 0; i < 12; ++i)
        CHECK(colour.rgb[i] == image.channels[i % 3].values[i / 3]);

    const LayeredImage gray { 1, 1, { 0, 0, 1, 1 }, { { "Y", { 0.25f }, false } }, {} };
    CHECK(beauty(gray).rgb == std::vector<float> { 0.25f, 0.25f, 0.25f });
    LayeredImage layersOnly = image;
    layersOnly.channels.erase(layersOnly.channels.begin(), layersOnly.channels.begin() + 3);
    CHECK_THROWS_WITH_AS(beauty(layersOnly, "a.exr"),
        "a.exr has no colour at its root, its channels are: albedo.R, albedo.G, albedo.B, depth.Z, "
        "objectId.I: use an image with the channels R, G and B",
        wedge::Error);
}

TEST_CASE("files that cannot be read give one line that says why")
{
    const TempDirectory directory;
    const std::string path = directory / "a.exr";
    CHECK(readError(path) == "EXR image not found: " + path + ": check the path");
    CHECK(contains(readError(directory.path()), "EXR image is a folder"));
    writeBytes(path, "");
    CHECK(contains(readError(path), "it is empty"));
    writeBytes(path, "this is a text file, not an image, and long enough to hold a header of some kind");
    CHECK(readError(path)
        == "cannot read EXR image (it is no EXR): " + path + ": check that the file is whole and of its type");

    writeExr(path, layered(60, 50, { 0, 0, 60, 50 }));
    const std::string whole = readBytes(path);
    for (const double part : { 0.001, 0.01, 0.05, 0.5, 0.99 }) {
        CAPTURE(part);
        writeBytes(path, whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
        const std::string message = readError(path);
        CHECK(contains(message, "cannot read EXR image ("));
        CHECK(contains(message, path));
        CHECK_FALSE(contains(message, "\n"));
    }
}

TEST_CASE("no damaged byte crashes the reader")
{
    const TempDirectory directory;
    const std::string path = directory / "a.exr";
    writeExr(path, layered(20, 18, { 0, 0, 20, 18 }));
    const std::string whole = readBytes(path);
    int refused = 0;
    for (std::uint32_t i = 0; i < 400; ++i) {
        std::string damaged = whole;
        const auto at = static_cast<std::size_t>(hashed(i, 1, 0, 1) * 0.2 * static_cast<double>(whole.size()));
        damaged[at] = static_cast<char>(static_cast<int>(hashed(i, 2, 0, 1) * 256.0));
        writeBytes(path, damaged);
        refused += readError(path) != "no error";
    }
    CHECK(refused > 50);
    CHECK(refused < 400);
}

TEST_CASE("a header that claims a huge image takes no memory")
{
    const TempDirectory directory;
    const std::string path = directory / "a.exr";
    writeExr(path, layered(2, 2, { 0, 0, 2, 2 }));
    const std::string small = readBytes(path);
    const std::size_t box = small.find("dataWindow") + 11 + 6 + 4; // name, type "box2i", size
    const auto claiming = [&](std::uint32_t corner, std::size_t padding) {
        std::string huge = small + std::string(padding, '\0'); // room for the table of offsets that must be there
        for (unsigned byte = 0; byte < 8; ++byte)
            huge[box + 8 + byte] = static_cast<char>(corner >> 8 * (byte % 4));
        writeBytes(path, huge);
        return readError(path);
    };
    CHECK(contains(claiming(0x7ffffffe, 0), path));
    CHECK(contains(claiming(0x3fff, 0), path));
    CHECK(contains(claiming(0x3fff, 20000), "it has 16384x16384 pixels, at most 67108864 are read"));
    CHECK(contains(claiming(0x7fff, 40000), "it has 32768x32768 pixels, at most 67108864 are read"));
}

TEST_CASE("an unknown extension is refused with those that are known")
{
    CHECK_THROWS_WITH_AS(
        readImage("picture.jpg"), "image file of unknown format: picture.jpg: use .exr, .png or .hdr", wedge::Error);
    CHECK_THROWS_AS(readImage("noextension"), wedge::Error);
}
