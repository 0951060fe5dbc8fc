#include "host/decode/texture.h"
#include "tests/decode_support.h"

using namespace wedge::decode;
using namespace wedge::decode::test;

namespace {

const std::string tga = File().u8(0).u8(0).u8(3).u16(0).u16(0).u8(0).u32(0).u16(1).u16(1).u8(8).u8(0).u8(7).bytes;

std::string refusal(const std::string& bytes) { return failureOf(bytes, decodeTexture); }

std::string admission(Size size, std::size_t fileBytes, const Limits& limits)
{
    try {
        limits.admit(size, fileBytes);
    } catch (const Failure& failure) {
        return failure.what();
    }
    return "";
}

} // namespace

TEST_CASE("a texture's format is told by its content")
{
    CHECK(fromTop(decodeTexture(bytesOf(tga), {})) == Pixels { packRgba(7, 7, 7) });
    CHECK(fromTop(decodeTexture(bytesOf("#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81"), {}))
        == Pixels { packRgba(255, 255, 255) });
    CHECK(refusal("BM") == "it ends before the picture does");
    CHECK(refusal("\x89PNG\r\n\x1a\n") == "it ends before the picture does");
    CHECK(refusal("\xff\xd8\xff\xe0") == "Premature end of JPEG file");
}

TEST_CASE("formats that are not read are named")
{
    const std::pair<const char*, std::string> files[] = { { "GIF", "GIF89a" }, { "Photoshop", "8BPS" },
        { "TIFF", std::string("II*\0", 4) }, { "WebP", "RIFF1234WEBP" }, { "EXR", "v/1\x01" }, { "DDS", "DDS |" },
        { "PBM, PGM or PPM", "P5 3000 3000 65535\n" }, { "PBM, PGM or PPM", "P6\n1 1\n" } };
    for (const auto& [name, bytes] : files)
        CHECK(refusal(bytes) == std::string(name) + " is no format that is read");
    for (const char* other : { "hello, this is a text and no picture", "P5", "\x01", "<svg/>" })
        CHECK(refusal(other) == "its format is not known");
    CHECK(refusal("") == "it is empty");
}

TEST_CASE("limits: of a side, of pixels, of pixels a byte, and of all textures together")
{
    const Limits limits;
    CHECK(admission({ 4096, 2048 }, 0, limits) == "");
    CHECK(admission({ 4097, 2048 }, 2048 * 4097 / 1100 - 1, limits) == "it claims 4097x2048 pixels in 7626 bytes");
    CHECK(admission({ 4097, 2048 }, 2048 * 4097 / 1100, limits) == "");
    // A picture of one colour packs 1032 : 1 at the best.
    CHECK(admission({ 4096, 4096 }, 4096 * 4096 / 1032, limits) == "");
    CHECK(admission({ 4097, 4096 }, 4096 * 4097 / 1032, limits) != "");
    CHECK(admission({ 8192, 8192 }, 8192 * 8192 / 32, limits) == "");
    CHECK(admission({ 8192, 8192 }, 8192 * 8192 / 32 - 1, limits) == "it claims 8192x8192 pixels in 2097151 bytes");
    CHECK(admission({ 8192, 8192 }, 8192 * 8192 / 1032, { .unquestioned = 1 << 25 }) == "");
    // Images that are measured cost more.
    CHECK(admission({ 2048, 1024 }, 0, wedge::decode::referenceLimits) == "");
    CHECK(admission({ 2048, 2048 }, 600, wedge::decode::referenceLimits) != "");
    CHECK(admission({ 2896, 2896 }, 2'000'000, wedge::decode::referenceLimits) != "");
    CHECK(admission({ 2896, 2896 }, 2'100'000, wedge::decode::referenceLimits) == "");
    CHECK(admission({ 8193, 8192 }, 1 << 30, limits) == "it has 8193x8192 pixels, at most 67108864 are read");
    CHECK(admission({ 32769, 1 }, 1 << 30, limits) == "it has 32769x1 pixels, at most 32768 a side are read");
    CHECK(admission({ 0, 5 }, 100, limits) == "it has 0x5 pixels");
    CHECK(admission({ 5, -1 }, 100, limits) == "it has 5x-1 pixels");
    CHECK(admission({ 5, 4 }, 100, { .together = 20 }) == "");
    CHECK(admission({ 5, 4 }, 100, { .together = 19 })
        == "it has 5x4 pixels, of the textures of all the scene only 19 more are read");
}
