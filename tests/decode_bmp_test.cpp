#include "host/decode/bmp.h"
#include "tests/decode_support.h"

#include <limits>

using namespace wedge::decode;
using namespace wedge::decode::test;

namespace {

struct Bmp {
    std::uint32_t header = 40;
    int width = 3, height = 2;
    unsigned bits = 24;
    std::uint32_t compression = 0, colours = 0;
    std::string masks = "", palette = "", data = "";

    std::string bytes() const
    {
        File info;
        info.u32(header);
        if (header == 12) {
            info.u16(static_cast<unsigned>(width)).u16(static_cast<unsigned>(height)).u16(1).u16(bits);
        } else {
            info.u32(static_cast<std::uint32_t>(width)).u32(static_cast<std::uint32_t>(height)).u16(1).u16(bits);
            info.u32(compression).u32(0).u32(0).u32(0).u32(colours).u32(0).add(masks);
            if (info.bytes.size() < header)
                info.bytes.resize(header);
        }
        info.add(palette);
        File file;
        const auto at = static_cast<std::uint32_t>(14 + info.bytes.size());
        file.add("BM").u32(at + static_cast<std::uint32_t>(data.size())).u32(0).u32(at);
        return file.add(info.bytes).add(data).bytes;
    }
};

Pixels decoded(const Bmp& bmp) { return fromTop(decodeBmp(bytesOf(bmp.bytes()), {})); }
std::string failure(const Bmp& bmp) { return failureOf(bmp.bytes(), decodeBmp); }

/// Rows of a picture of one row and its padding to four bytes.
std::string padded(std::string row)
{
    row.resize((row.size() + 3) / 4 * 4);
    return row;
}

const std::string twoRows =
    padded(text({ 1, 2, 3, 4, 5, 6, 7, 8, 9 })) + padded(text({ 10, 11, 12, 13, 14, 15, 16, 17, 18 }));
const Pixels lower = { packRgba(3, 2, 1), packRgba(6, 5, 4), packRgba(9, 8, 7) };
const Pixels upper = { packRgba(12, 11, 10), packRgba(15, 14, 13), packRgba(18, 17, 16) };
const Pixels fromBelow = { upper[0], upper[1], upper[2], lower[0], lower[1], lower[2] };
const std::string palette3 = text({ 1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0 });

std::string mask(std::initializer_list<std::uint32_t> values)
{
    File file;
    for (const std::uint32_t value : values)
        file.u32(value);
    return file.bytes;
}

} // namespace

TEST_CASE("BMP: 24 bits below every header, from the bottom and the top")
{
    for (const std::uint32_t header : { 12u, 40u, 52u, 56u, 64u, 108u, 124u }) {
        CAPTURE(header);
        CHECK(decoded({ .header = header, .data = twoRows }) == fromBelow);
    }
    CHECK(decoded({ .height = -2, .data = twoRows })
        == Pixels { lower[0], lower[1], lower[2], upper[0], upper[1], upper[2] });
    CHECK(failure({ .header = 16, .data = twoRows }) == "its header of 16 bytes is of a kind that is not read");
}

TEST_CASE("BMP: palettes of 1, 4 and 8 bits, with entries of 3 and 4 bytes")
{
    const Pixels row = { lower[1], lower[0], lower[1] };
    CHECK(decoded({ .height = 1, .bits = 1, .colours = 2, .palette = palette3.substr(0, 8), .data = padded("\xa0") })
        == row);
    CHECK(decoded({ .height = 1, .bits = 4, .colours = 3, .palette = palette3, .data = padded(text({ 0x10, 0x20 })) })
        == Pixels { lower[1], lower[0], lower[2] });
    CHECK(decoded({ .height = 1, .bits = 8, .colours = 3, .palette = palette3, .data = padded(text({ 1, 0, 2 })) })
        == Pixels { lower[1], lower[0], lower[2] });
    CHECK(decoded({ .header = 12, .height = 1, .bits = 1, .palette = twoRows.substr(0, 6), .data = padded("\xa0") })
        == row);
    CHECK(failure({ .height = 1, .bits = 8, .colours = 3, .palette = palette3, .data = padded(text({ 1, 3, 2 })) })
        == "a pixel has a colour that its palette lacks");
    CHECK(failure({ .height = 1, .bits = 8, .data = padded(text({ 0, 0, 0 })) }) == "it has no palette");
}

TEST_CASE("BMP: 16 and 32 bits, with masks and without")
{
    CHECK(
        decoded({ .width = 2, .height = 1, .bits = 16, .data = text({ 0x00, 0x7c, 0xff, 0x83 }) }) // bit 15 is nothing
        == Pixels { packRgba(255, 0, 0), packRgba(0, 255, 255) });
    const std::string rgb565 = mask({ 0xf800, 0x7e0, 0x1f });
    CHECK(decoded({ .width = 2,
              .height = 1,
              .bits = 16,
              .compression = 3,
              .masks = rgb565,
              .data = text({ 0x20, 0x08, 0xe0, 0x07 }) })
        == Pixels { packRgba(8, 4, 0), packRgba(0, 255, 0) });
    CHECK(decoded({ .width = 1, .height = 1, .bits = 32, .data = text({ 1, 2, 3, 4 }) })
        == Pixels { packRgba(3, 2, 1, 4) });
    CHECK(
        decoded({ .width = 1, .height = 1, .bits = 32, .data = text({ 1, 2, 3, 0 }) }) == Pixels { packRgba(3, 2, 1) });
    for (const std::uint32_t header : { 56u, 108u, 124u })
        CHECK(decoded({ .header = header,
                  .width = 1,
                  .height = 1,
                  .bits = 32,
                  .compression = 3,
                  .masks = mask({ 0xff, 0xff00, 0xff0000, 0xff000000 }),
                  .data = text({ 1, 2, 3, 0 }) })
            == Pixels { packRgba(1, 2, 3, 0) });
    CHECK(decoded({ .width = 1,
              .height = 1,
              .bits = 32,
              .compression = 6,
              .masks = mask({ 0xff, 0xff00, 0xff0000, 0xff000000 }),
              .data = text({ 1, 2, 3, 4 }) })
        == Pixels { packRgba(1, 2, 3, 4) });
    // Ten bits a channel: their upper eight.
    CHECK(decoded({ .width = 1,
              .height = 1,
              .bits = 32,
              .compression = 3,
              .masks = mask({ 0x3ff00000, 0xffc00, 0x3ff }),
              .data = mask({ 4u << 20 | 8u << 10 | 1023u }) })
        == Pixels { packRgba(1, 2, 255) });
    CHECK(failure({ .width = 1,
              .height = 1,
              .bits = 32,
              .compression = 3,
              .masks = mask({ 0xf0f, 0xf0, 0xf000 }),
              .data = "abcd" })
        == "one of its masks has a gap");
    CHECK(failure({ .width = 1,
              .height = 1,
              .bits = 32,
              .compression = 3,
              .masks = mask({ 0, 0xf0, 0xf000 }),
              .data = "abcd" })
        == "it has no mask for one of its colours");
}

TEST_CASE("BMP: runs of 8 and 4 bits: repeats, rows, moves, pixels one by one")
{
    const Bmp runs { .width = 4,
        .height = 3,
        .bits = 8,
        .compression = 1,
        .colours = 3,
        .palette = palette3,
        .data = text({ 4, 1, 0, 0, 0, 3, 0, 1, 2, 0, 0, 2, 0, 1, 1, 2, 0, 1 }) };
    const std::uint32_t a = lower[0], b = lower[1], c = lower[2];
    CHECK(decoded(runs) == Pixels { a, a, a, c, a, b, c, a, b, b, b, b });
    const Bmp nibbles { .width = 4,
        .height = 2,
        .bits = 4,
        .compression = 2,
        .colours = 3,
        .palette = palette3,
        .data = text({ 3, 0x12, 0, 0, 0, 4, 0x01, 0x21, 0, 1 }) };
    CHECK(decoded(nibbles) == Pixels { a, b, c, b, b, c, b, a });
    for (const std::string& beyond : { text({ 5, 1, 0, 1 }), text({ 0, 0, 0, 0, 0, 0, 1, 1, 0, 1 }),
             text({ 0, 2, 4, 0, 1, 1, 0, 1 }), text({ 0, 5, 1, 1, 1, 1, 1, 0, 0, 1 }) }) {
        Bmp wrong = runs;
        wrong.data = beyond;
        CHECK(failure(wrong) == "a run of pixels goes beyond its row");
    }
    Bmp unknown = runs;
    unknown.data = text({ 1, 3, 0, 1 });
    CHECK(failure(unknown) == "a pixel has a colour that its palette lacks");
    Bmp down = runs;
    down.height = -3;
    CHECK(failure(down) == "it has runs of pixels from the top, which only go from the bottom");
    checkEveryTruncationFails(runs.bytes(), decodeBmp);
    checkNoDamagedByteCrashes(runs.bytes(), decodeBmp);
    checkEveryTruncationFails(nibbles.bytes(), decodeBmp);
}

TEST_CASE("BMP: what is not read, and sizes that lie")
{
    CHECK(failure({ .compression = 4, .data = twoRows })
        == "its pixels are of a kind (24 bits, compression 4) that is not read");
    CHECK(
        failure({ .bits = 7, .data = twoRows }) == "its pixels are of a kind (7 bits, compression 0) that is not read");
    CHECK(failure({ .width = 0, .data = twoRows }) == "it has 0x2 pixels");
    CHECK(failure({ .width = -3, .data = twoRows }) == "it has -3x2 pixels");
    CHECK(failure({ .height = std::numeric_limits<int>::min(), .data = twoRows }) == "its height is out of range");
    CHECK(failure({ .width = 30000, .height = 30000 }) == "it has 30000x30000 pixels, at most 67108864 are read");
    CHECK(failure({ .width = 8000, .height = 8000 }) == "it claims 8000x8000 pixels in 54 bytes");
    CHECK(failure({ .width = 2800, .height = 2800 }) == "it ends before the picture does");
}

TEST_CASE("BMP: missing data are an error at every byte, and no damaged byte crashes")
{
    const Bmp files[] = { { .data = twoRows },
        { .header = 124,
            .width = 1,
            .height = 1,
            .bits = 32,
            .compression = 3,
            .masks = mask({ 0xff, 0xff00, 0xff0000, 0xff000000 }),
            .data = text({ 1, 2, 3, 0 }) },
        { .height = 1, .bits = 4, .colours = 3, .palette = palette3, .data = padded(text({ 0x10, 0x20 })) } };
    for (const Bmp& file : files) {
        checkEveryTruncationFails(file.bytes(), decodeBmp);
        checkNoDamagedByteCrashes(file.bytes(), decodeBmp);
    }
}
