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
    CHECK(fromTop(decodeHdr(bytesOf(bytes), {})) == Pixels { packRgba(255, 136, 0), packRgba(255, 255, 255) });
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
