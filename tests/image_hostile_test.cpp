// Images that strangers made to take memory or time: refused by their headers.
#include "host/image/exr.h"
#include "host/image/read_image.h"

#include "host/error.h"
#include "tests/image_test_support.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfPreviewImageAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <algorithm>
#include <doctest/doctest.h>
#include <sys/stat.h>

using namespace wedge::image;
using namespace wedge::image::test;

namespace {

std::string readError(const std::string& path)
{
    try {
        readImage(path);
    } catch (const wedge::Error& error) {
        return error.what();
    }
    return "no error";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string number(std::uint32_t value)
{
    std::string out;
    for (int shift = 0; shift < 32; shift += 8)
        out += static_cast<char>(value >> shift);
    return out;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value, std::uint32_t size)
{
    return name + '\0' + type + '\0' + number(size) + value;
}
std::string attribute(const std::string& name, const std::string& type, const std::string& value)
{
    return attribute(name, type, value, static_cast<std::uint32_t>(value.size()));
}

std::string channels(int count)
{
    std::string out;
    for (int i = 0; i < count; ++i) {
        out += i < 3 ? std::string(1, "BGR"[i]) : std::string("c").append(std::to_string(i));
        out += '\0' + number(2) + number(0) + number(1) + number(1);
    }
    return out + '\0';
}

/// The headers of a file of width x height pixels, without its pixels.
struct Exr {
    std::uint32_t width = 2, height = 2, flags = 0;
    char compression = 0;
    int channelCount = 3;
    std::string more = "";

    std::string bytes() const
    {
        const std::string box = number(0) + number(0) + number(width - 1) + number(height - 1);
        return number(0x01312f76) + number(2 | flags) + attribute("channels", "chlist", channels(channelCount))
            + attribute("compression", "compression", std::string(1, compression))
            + attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
            + attribute("lineOrder", "lineOrder", std::string(1, '\0'))
            + attribute("pixelAspectRatio", "float", number(0x3f800000))
            + attribute("screenWindowCenter", "v2f", number(0) + number(0))
            + attribute("screenWindowWidth", "float", number(0x3f800000)) + more + '\0';
    }
};

std::string refusal(const Exr& exr, std::size_t padding = 0)
{
    const TempDirectory directory;
    writeBytes(directory / "a.exr", exr.bytes() + std::string(padding, '\0'));
    return readError(directory / "a.exr");
}

std::string tiles(std::uint32_t width, std::uint32_t height, char mode = 0)
{
    return attribute("tiles", "tiledesc", number(width) + number(height) + mode);
}

constexpr std::uint32_t tiled = 0x200, multiPart = 0x1000;

} // namespace

TEST_CASE("EXR: a file by hand is read, so that the refusals below are for what they change")
{
    const TempDirectory directory;
    const std::string header = Exr {}.bytes();
    std::string file = header;
    for (std::uint32_t row = 0; row < 2; ++row) // where each row is
        file += number(static_cast<std::uint32_t>(header.size()) + 16 + row * 32) + number(0);
    for (std::uint32_t row = 0; row < 2; ++row)
        file += number(row) + number(24) + number(0x3f800000) + number(0) + number(0x40000000) + number(0)
            + number(0x40400000) + number(0);
    writeBytes(directory / "a.exr", file);
    CHECK(readImage(directory / "a.exr").rgb == std::vector<float> { 3, 2, 1, 0, 0, 0, 3, 2, 1, 0, 0, 0 });
    for (std::size_t size = 0; size < file.size(); ++size) {
        CAPTURE(size);
        writeBytes(directory / "a.exr", file.substr(0, size));
        CHECK(contains(readError(directory / "a.exr"), "cannot read EXR image ("));
    }
    // A chunk of no bytes: OpenEXR would show what its memory happened to hold.
    for (const std::uint32_t size : { 0u, 23u, 25u, 0xffffffffu }) {
        std::string wrong = file;
        wrong.replace(header.size() + 16 + 4, 4, number(size));
        writeBytes(directory / "a.exr", wrong);
        CHECK(contains(readError(directory / "a.exr"), "a chunk of its pixels is missing or damaged"));
    }
    for (std::size_t at = 0; at < file.size(); ++at) {
        for (const int change : { 0x01, 0x80, 0xff }) {
            std::string damaged = file;
            damaged[at] = static_cast<char>(damaged[at] ^ change);
            writeBytes(directory / "a.exr", damaged);
            readError(directory / "a.exr");
        }
    }
}

TEST_CASE("EXR: attributes are held against the file")
{
    CHECK(contains(refusal({ .more = attribute("a", "string", "", 0x7fffffff) }),
        "its attribute 'a' has not the size that it says"));
    CHECK(
        contains(refusal({ .more = attribute("a", "unknown", "", 0x7fffffff) }), "its attribute 'a' has not the size"));
    CHECK(
        contains(refusal({ .more = attribute("a", "string", "", 0xffffffff) }), "its attribute 'a' has not the size"));
    CHECK(contains(refusal({ .more = attribute("a", "int", "abcdefgh") }), "its attribute 'a' has not the size"));
    CHECK(contains(refusal({ .more = attribute("a", "floatvector", "abcde") }), "its attribute 'a' has not the size"));
    CHECK(
        contains(refusal({ .more = attribute("a", "stringvector", number(0x7fffffff)) }), "it ends inside its header"));
    CHECK(contains(refusal({ .more = attribute("a", "preview", number(0x10000) + number(0x10000)) }), "its preview"));
    CHECK(contains(refusal({ .more = attribute("compression", "compression", "a") }), "'compression' is there twice"));
    CHECK(contains(refusal({ .more = std::string(300, 'x') }), "a name in its header is too long"));
}

TEST_CASE("EXR: sizes are held against the file")
{
    CHECK(contains(refusal({}), "it ends before the picture does"));
    CHECK(contains(refusal({ .width = 8192, .height = 8192 }), "it claims 8192x8192 pixels in "));
    CHECK(contains(refusal({ .width = 8193, .height = 8192 }), "at most 67108864 are read"));
    CHECK(contains(refusal({ .width = 1, .height = 1 << 20 }), "at most 65536 a side are read"));
    CHECK(contains(refusal({ .width = 0 }), "it has 0x2 pixels"));
    CHECK(contains(refusal({ .width = 0x80000000 }), "window is out of range"));
    CHECK(contains(
        refusal({ .width = 1400, .height = 1400, .channelCount = 200 }), "it claims 200 channels of 1400x1400 pixels"));
    CHECK(contains(refusal({ .channelCount = 1025 }), "it has more than 1024 channels"));
    CHECK(contains(refusal({ .channelCount = 0 }), "its header is not complete"));
    CHECK(contains(refusal({ .width = 65536, .height = 16, .compression = 9 }), "its chunks or tiles are too large"));
    CHECK(contains(refusal({ .compression = 10 }), "its compression is of an unknown kind"));
    CHECK(contains(refusal({ .height = 60000 }, 900000), "it ends before the picture does")); // 16 bytes a row
}

TEST_CASE("EXR: more channels than layers are held against the file, those of layers of an empty scene are not")
{
    const std::string claims = "it claims 1024 channels of 512x480 pixels in ";
    CHECK(contains(refusal({ .width = 512, .height = 480, .channelCount = 1024 }, 1'000'000), claims));
    CHECK(contains(refusal({ .width = 1920, .height = 1080, .channelCount = 65 }, 300'000), "it claims 65 channels"));
    CHECK(contains(
        refusal({ .width = 1920, .height = 1080, .channelCount = 64 }, 300), "it ends before the picture does"));
    const TempDirectory directory;
    writeBytes(directory / "a.exr",
        Exr { .width = 512, .height = 480, .channelCount = 1024 }.bytes() + std::string(100, '\0'));
    try {
        wedge::decode::Limits limits = wedge::decode::referenceLimits;
        limits.unquestioned = 1 << 24;
        ImageFile(directory / "a.exr", limits);
    } catch (const wedge::Error& error) {
        CHECK(contains(error.what(), "it ends before the picture does"));
    }
}

TEST_CASE("EXR: a channel of fewer pixels is refused by its name")
{
    const std::string full = number(1) + number(1);
    for (const std::string& sampling : { number(2) + number(1), number(1) + number(2), number(0) + number(0) }) {
        std::string file = Exr {}.bytes();
        const std::size_t second = file.find(full, file.find(full) + 1);
        file.replace(second, sampling.size(), sampling);
        const TempDirectory directory;
        writeBytes(directory / "a.exr", file + std::string(1000, '\0'));
        CHECK(contains(readError(directory / "a.exr"),
            "its channel G is subsampled): " + (directory / "a.exr") + ": convert the image to R, G and B"));
    }
}

TEST_CASE("EXR: parts of unknown types, and chunks that no file holds, are refused")
{
    const std::string scanLines = attribute("type", "string", "scanlineimage");
    const auto chunks = [](std::uint32_t count) { return attribute("chunkCount", "int", number(count)); };
    CHECK(contains(refusal({ .flags = multiPart, .more = attribute("type", "string", "foo") + chunks(0xffffffff) }),
        "a part is of the unknown type 'foo'"));
    CHECK(contains(refusal({ .flags = multiPart }), "a part is of the unknown type ''"));
    for (const std::uint32_t count : { 0u, 0xffffffffu, 0x7fffffffu, 130u }) {
        CAPTURE(count);
        CHECK(
            contains(refusal({ .flags = multiPart, .more = scanLines + chunks(count) }, 600), " chunks of pixels in "));
    }
    CHECK(contains(refusal({ .flags = multiPart, .more = scanLines + chunks(2) }), "it ends "));
}

TEST_CASE("EXR: tiles are held against the file")
{
    CHECK(contains(refusal({ .flags = tiled }), "its header is not complete"));
    CHECK(contains(refusal({ .flags = tiled, .more = tiles(0, 1) }), "the size of its tiles is out of range"));
    CHECK(contains(refusal({ .flags = tiled, .more = tiles(0x7fffffff, 1) }), "the size of its tiles is out of range"));
    CHECK(contains(refusal({ .flags = tiled, .more = tiles(65536, 65536) }), "its chunks or tiles are too large"));
    CHECK(contains(refusal({ .flags = tiled, .more = tiles(1, 1, 3) }), "its tiles are of an unknown mode"));
    CHECK(contains(refusal({ .width = 1000, .height = 1000, .flags = tiled, .more = tiles(1, 1, 2) }, 100000),
        "it ends before the picture does"));
}

TEST_CASE("EXR: deep data are refused, of several parts the first is read")
{
    const TempDirectory directory;
    const std::string path = directory / "a.exr";
    CHECK(contains(refusal({ .flags = 0x800 }), "it has deep data"));
    CHECK(contains(refusal({ .flags = 0x4000 }), "it is of an unknown version"));
    CHECK(contains(
        refusal({ .flags = multiPart, .more = attribute("type", "string", "deepscanline") }), "it has deep data"));
    std::vector<Imf::Header> headers;
    for (const char* name : { "first", "second" }) {
        Imf::Header header(3, 2);
        header.setName(name);
        header.setType(Imf::SCANLINEIMAGE);
        header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
        header.insert("views", Imf::StringVectorAttribute({ "left", "right" }));
        const std::vector<Imf::PreviewRgba> preview(6);
        header.setPreviewImage(Imf::PreviewImage(3, 2, preview.data()));
        headers.push_back(header);
    }
    {
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
        for (int part = 0; part < 2; ++part) {
            std::vector<float> values { 1, 2, 3, 4, 5, 6.0f + static_cast<float>(part) };
            Imf::OutputPart out(file, part);
            Imf::FrameBuffer frame;
            frame.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 12));
            out.setFrameBuffer(frame);
            out.writePixels(2);
        }
    }
    CHECK(readImage(path).rgb == std::vector<float> { 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6 });
    const std::string whole = readBytes(path);
    for (std::size_t at = 0; at < whole.size(); at += 3) {
        std::string damaged = whole;
        damaged[at] ^= 0x40;
        writeBytes(path, damaged);
        readError(path);
    }
}

TEST_CASE("a file's size is known before it is decoded, of each format")
{
    const TempDirectory directory;
    const std::string hdr = directory / "a.hdr", exr = directory / "a.exr";
    writeBytes(hdr, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 30 +X 40\n"); // and no pixels
    const ImageFile file(hdr);
    CHECK(file.width() == 40);
    CHECK(file.height() == 30);
    const std::vector<float> row(5);
    writeExr(exr, { 5, 1, { 0, 0, 5, 1 }, { { "Y", row, false } }, {} });
    CHECK(ImageFile(exr).width() == 5);
    CHECK(ImageFile(exr).height() == 1);
    CHECK(contains(readError(hdr), "cannot read HDR image (it ends before the picture does)"));
}

TEST_CASE("a Radiance header that claims much takes no memory")
{
    const TempDirectory directory;
    const auto claiming = [&](const std::string& size) {
        writeBytes(directory / "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n");
        return readError(directory / "a.hdr");
    };
    CHECK(contains(claiming("-Y 13000 +X 13000"), "at most 67108864 are read"));
    CHECK(contains(claiming("-Y 8000 +X 8000"), "it claims 8000x8000 pixels in 51 bytes"));
    CHECK(contains(claiming("-Y 16 +X 16"), "it ends before the picture does"));
}

TEST_CASE("only regular files are images")
{
    const TempDirectory directory;
    for (const char* name : { "a.exr", "a.png", "a.hdr" }) {
        const std::string path = directory / name;
        REQUIRE(mkfifo(path.c_str(), 0600) == 0);
        CHECK(contains(readError(path), " image is not a regular file: " + path));
    }
}
