#include "host/decode/hdr.h"
#include "tests/decode_support.h"

using namespace wedge::decode;
using namespace wedge::decode::test;

namespace {

std::string hdr(const std::string& size, const std::string& data, const std::string& lines = "FORMAT=32-bit_rle_rgbe\n")
{
    return "#?RADIANCE\n" + lines + "\n" + size + "\n" + data;
}

/// Each pixel is one letter: mantissas of that letter and exponent 128.
std::string letters(const std::string& bytes)
{
    HdrReader reader(bytesOf(bytes));
    std::string out;
    reader.readRows([&](int, std::span<const Rgbe> pixels) {
        for (const Rgbe& p : pixels) {
            CHECK((p[0] == p[1] && p[1] == p[2] && p[3] == 128));
            out += static_cast<char>(p[0]);
        }
    });
    return out;
}

std::string pixel(char letter) { return std::string(3, letter) + "\x80"; }
std::string repeat(int count) { return text({ 1, 1, 1, count }); }

void decodeAsReference(Bytes bytes, const Limits& limits)
{
    HdrReader reader(bytes);
    limits.admit(reader.size(), bytes.size());
    reader.readRows([](int, std::span<const Rgbe>) {});
}

const std::string channel = text({ 0x83, 'a', 2, 'b', 'c', 0x84, 'd' });
const std::string newRow = text({ 2, 2, 0, 9 }) + channel + channel + channel + text({ 0x89, 128 });
const std::string oldRow = pixel('a') + repeat(2) + pixel('b') + pixel('c') + pixel('d') + repeat(3);

} // namespace

TEST_CASE("HDR: flat rows, old runs and new ones, in any order")
{
    CHECK(letters(hdr("-Y 2 +X 2", pixel('a') + pixel('b') + pixel('c') + pixel('d'))) == "abcd");
    CHECK(letters(hdr("-Y 1 +X 9", newRow)) == "aaabcdddd");
    CHECK(letters(hdr("-Y 3 +X 9", newRow + oldRow + newRow)) == "aaabcddddaaabcddddaaabcdddd");
    // A run directly behind another counts 256 times.
    const std::string longRow = letters(hdr("-Y 1 +X 600", pixel('a') + repeat(0x57) + repeat(2)));
    CHECK(longRow == std::string(600, 'a'));
    CHECK(letters("#?RGBE\nSOFTWARE=x\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n# more\n\n-Y 1 +X 1\n" + pixel('z')) == "z");
}

TEST_CASE("HDR: values, and what a texture gets of them")
{
    CHECK(hdrValue(128, 129) == 1.0f);
    CHECK(hdrValue(1, 138) == 4.0f);
    CHECK(hdrValue(255, 0) == 0.0f);
    CHECK(hdrValue(255, 255) == doctest::Approx(255.0 * 0x1p119));
    // 1, 0.25 and 0 at the exponent 129; everything above 1 is clipped.
    const std::string bytes = hdr("-Y 1 +X 2", text({ 128, 32, 0, 129, 200, 200, 200, 200 }));
    CHECK(fromTop(decodeHdr(bytesOf(bytes), {})) == Pixels { packRgba(255, 137, 0), packRgba(255, 255, 255) });
    // As plain numbers.
    CHECK(fromTop(decodeHdrFor(TextureUse::Numbers, bytesOf(bytes), {}))
        == Pixels { packRgba(255, 64, 0), packRgba(255, 255, 255) });
}

TEST_CASE("HDR: what pixels were multiplied with is divided out")
{
    const auto radiance = [](const std::string& lines) {
        HdrReader reader(bytesOf(hdr("-Y 1 +X 1", text({ 128, 64, 32, 129 }), lines + "FORMAT=32-bit_rle_rgbe\n")));
        std::array<float, 3> out {};
        reader.readRows([&](int, std::span<const Rgbe> pixels) { out = reader.radiance(pixels[0]); });
        return out;
    };
    using Rgb = std::array<float, 3>;
    CHECK(radiance("") == Rgb { 1, 0.5f, 0.25f });
    CHECK(radiance("EXPOSURE=4\n") == Rgb { 0.25f, 0.125f, 0.0625f });
    CHECK(radiance("EXPOSURE= 2.0e0 \r\npfilt -e 2\nEXPOSURE=+2\n") == Rgb { 0.25f, 0.125f, 0.0625f });
    CHECK(radiance("COLORCORR=1 2 0.5\n") == Rgb { 1, 0.25f, 0.5f });
    CHECK(radiance("COLORCORR=1 2 0.5\nEXPOSURE=0.5\nCOLORCORR=1 0.5 0.5\n") == Rgb { 2, 1, 2 });
    CHECK(radiance("GAMMA=1\nVIEW=-vtv -vp 0 0 0\nPIXASPECT=2\nPRIMARIES=0 0 0 0 0 0 0 0\nSOFTWARE=x\n")
        == Rgb { 1, 0.5f, 0.25f });
    // A line of a command, which is indented, is no variable.
    CHECK(radiance("\tEXPOSURE=4\n") == Rgb { 1, 0.5f, 0.25f });
    CHECK(radiance("PRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.313 0.329\n") == Rgb { 1, 0.5f, 0.25f });
    // Red and green the other way round; the white moves a little, since equal parts of them are not equally bright.
    const Rgb turned = radiance("PRIMARIES=0.30 0.60 0.64 0.33 0.15 0.06 0.3127 0.3290\n");
    CHECK(turned[0] == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(turned[1] == doctest::Approx(1.0).epsilon(1e-4));
    const std::string dark = hdr("-Y 1 +X 1", text({ 128, 32, 0, 129 }), "EXPOSURE=0.5\nFORMAT=32-bit_rle_rgbe\n");
    CHECK(fromTop(decodeHdr(bytesOf(dark), {})) == Pixels { packRgba(255, 188, 0) });
}

TEST_CASE("HDR: lines that make no sense are refused with what they say")
{
    const auto failure = [](const std::string& lines) {
        return failureOf(hdr("-Y 1 +X 1", pixel('a'), lines + "FORMAT=32-bit_rle_rgbe\n"), decodeHdr);
    };
    CHECK(failure("EXPOSURE=bright\n") == "its header has 'EXPOSURE=bright', which is not a number");
    CHECK(failure("EXPOSURE=\n") == "its header has 'EXPOSURE=', which is not a number");
    for (const char* wrong : { "0", "-1" })
        CHECK(failure(std::string("EXPOSURE=") + wrong + "\n")
            == std::string("its header has 'EXPOSURE=") + wrong + "', which is not above 0");
    for (const char* wrong : { "inf", "nan", "1 2", "1x" })
        CHECK(failure(std::string("EXPOSURE=") + wrong + "\n").find("which is not a number") != std::string::npos);
    CHECK(failure("COLORCORR=1 1\n") == "its header has 'COLORCORR=1 1', which is not three numbers");
    CHECK(failure("COLORCORR=1 0 1\n") == "its header has 'COLORCORR=1 0 1', which is not above 0");
    CHECK(failure("PRIMARIES=0.6 0.3\n") == "its header has 'PRIMARIES=0.6 0.3', which is not eight numbers");
    CHECK(failure("PRIMARIES=.3 .3 .3 .3 .3 .3 .3 .3\n") == "its primaries span no colours");
    CHECK(failure("EXPOSURE=1e-20\nEXPOSURE=1e-20\n").find("is out of range") != std::string::npos);
    CHECK(failure("GAMMA=2.2\n") == "its pixels are encoded, by its line 'GAMMA=2.2'");
}

TEST_CASE("HDR: headers that are not read")
{
    const auto failure = [](const std::string& bytes) { return failureOf(bytes, decodeHdr); };
    CHECK(failure("#?OTHER\n\n") == "it is not Radiance HDR");
    CHECK(failure(hdr("-Y 1 +X 1", pixel('a'), "")) == "it does not say that its format is 32-bit_rle_rgbe");
    CHECK(failure(hdr("-Y 1 +X 1", pixel('a'), "FORMAT=32-bit_rle_xyze\n")) == "its format is not 32-bit_rle_rgbe");
    for (const char* size : { "+Y 1 +X 1", "+X 1 -Y 1", "-Y 1 -X 1", "-Y 0 +X 1", "-Y 1 +X -1", "-Y 1 +X 1 ", "-Y 1",
             "-Y 99999999999 +X 1", "" }) {
        CAPTURE(size);
        CHECK(failure(hdr(size, pixel('a'))).find("its rows do not go from top to bottom") == 0);
    }
    CHECK(failure(std::string("#?RADIANCE\n") + std::string(5000, 'x')) == "a line of its header is too long");
    CHECK(failure(hdr("-Y 40000 +X 40000", "")) == "it has 40000x40000 pixels, at most 32768 a side are read");
}

TEST_CASE("HDR: runs that lie")
{
    const auto failure = [](const std::string& data) { return failureOf(hdr("-Y 1 +X 9", data), decodeHdr); };
    CHECK(failure(text({ 2, 2, 0, 8 }) + newRow.substr(4)) == "one of its rows has another width");
    CHECK(failure(text({ 2, 2, 0, 9, 0, 0, 0, 0, 0, 0, 0, 0 })) == "a run of pixels is empty or goes beyond its row");
    CHECK(failure(text({ 2, 2, 0, 9, 0x8a, 0 })) == "a run of pixels is empty or goes beyond its row");
    CHECK(failure(repeat(2) + pixel('a')) == "a run of pixels has no pixel or goes beyond its row");
    CHECK(failure(pixel('a') + repeat(9)) == "a run of pixels has no pixel or goes beyond its row");
    CHECK(failure(pixel('a') + repeat(0) + repeat(0) + repeat(0) + repeat(0) + repeat(0))
        == "a run of pixels has no pixel or goes beyond its row");
}

TEST_CASE("HDR: missing data are an error at every byte, and no damaged byte crashes or loops")
{
    const std::string bytes = hdr("-Y 2 +X 9", newRow + oldRow);
    checkEveryTruncationFails(bytes, decodeHdr);
    checkEveryTruncationFails(bytes, decodeAsReference);
    checkNoDamagedByteCrashes(bytes, decodeHdr);
    checkNoDamagedByteCrashes(bytes, decodeAsReference);
}
