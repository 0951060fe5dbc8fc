#include "host/decode/tga.h"
#include "tests/decode_support.h"

using namespace wedge::decode;
using namespace wedge::decode::test;

namespace {

struct Tga {
    unsigned type = 2, bits = 24, descriptor = 0x20; // from the top
    unsigned width = 2, height = 2;
    unsigned mapFirst = 0, mapLength = 0, mapBits = 0;
    std::string id = "", map = "", data = "";

    std::string bytes() const
    {
        File file;
        file.u8(static_cast<unsigned>(id.size())).u8(mapLength > 0 ? 1 : 0).u8(type);
        file.u16(mapFirst).u16(mapLength).u8(mapBits).u32(0).u16(width).u16(height).u8(bits).u8(descriptor);
        return file.add(id).add(map).add(data).bytes;
    }
};

Pixels decoded(const Tga& tga)
{
    const std::string bytes = tga.bytes();
    CHECK(isTga(bytesOf(bytes)));
    return fromTop(decodeTga(bytesOf(bytes), {}));
}

const std::string fourBgr = text({ 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 });
const Pixels four = { packRgba(3, 2, 1), packRgba(6, 5, 4), packRgba(9, 8, 7), packRgba(12, 11, 10) };

} // namespace

TEST_CASE("TGA: every origin")
{
    CHECK(decoded({ .descriptor = 0x20, .data = fourBgr }) == four);
    CHECK(decoded({ .descriptor = 0x00, .data = fourBgr }) == Pixels { four[2], four[3], four[0], four[1] });
    CHECK(decoded({ .descriptor = 0x30, .data = fourBgr }) == Pixels { four[1], four[0], four[3], four[2] });
    CHECK(decoded({ .descriptor = 0x10, .data = fourBgr }) == Pixels { four[3], four[2], four[1], four[0] });
}

TEST_CASE("TGA: every depth")
{
    CHECK(decoded({ .bits = 32, .descriptor = 0x28, .width = 1, .height = 1, .data = text({ 1, 2, 3, 4 }) })
        == Pixels { packRgba(3, 2, 1, 4) });
    for (const unsigned bits : { 15u, 16u }) // 1 00001 00010 11111
        CHECK(decoded({ .bits = bits, .width = 1, .height = 1, .data = text({ 0x5f, 0x84 }) })
            == Pixels { packRgba(255 / 31, 2 * 255 / 31, 255) });
    CHECK(decoded({ .type = 3, .bits = 8, .width = 2, .height = 1, .data = text({ 7, 200 }) })
        == Pixels { packRgba(7, 7, 7), packRgba(200, 200, 200) });
    CHECK(decoded({ .type = 3, .bits = 16, .descriptor = 0x28, .width = 1, .height = 1, .data = text({ 7, 200 }) })
        == Pixels { packRgba(7, 7, 7, 200) });
}

TEST_CASE("TGA: colour maps of every depth, which may begin at any index")
{
    const Tga bgr { .type = 1,
        .bits = 8,
        .width = 2,
        .height = 1,
        .mapFirst = 5,
        .mapLength = 2,
        .mapBits = 24,
        .id = "some text",
        .map = fourBgr.substr(0, 6),
        .data = text({ 6, 5 }) };
    CHECK(decoded(bgr) == Pixels { four[1], four[0] });
    Tga wide = bgr;
    wide.bits = 16;
    wide.data = text({ 6, 0, 5, 0 });
    CHECK(decoded(wide) == Pixels { four[1], four[0] });
    Tga alpha = bgr;
    alpha.mapBits = 32;
    alpha.descriptor = 0x28;
    alpha.map = text({ 1, 2, 3, 4, 5, 6, 7, 8 });
    CHECK(decoded(alpha) == Pixels { packRgba(7, 6, 5, 8), packRgba(3, 2, 1, 4) });
    Tga packed = bgr;
    packed.mapBits = 15;
    packed.map = text({ 0, 0, 0xff, 0x7f });
    CHECK(decoded(packed) == Pixels { packRgba(255, 255, 255), packRgba(0, 0, 0) });
    for (const int outside : { 4, 7 }) {
        Tga wrong = bgr;
        wrong.data = text({ outside, 5 });
        CHECK(failureOf(wrong.bytes(), decodeTga) == "a pixel has a colour that its colour map lacks");
    }
    // A true-colour picture may carry a map, which is passed over.
    CHECK(decoded({ .mapLength = 2, .mapBits = 24, .map = fourBgr.substr(6, 6), .data = fourBgr }) == four);
}

TEST_CASE("TGA: what no bit of the descriptor calls an attribute is no alpha")
{
    CHECK(
        decoded({ .bits = 32, .width = 1, .height = 1, .data = text({ 1, 2, 3, 4 }) }) == Pixels { packRgba(3, 2, 1) });
    CHECK(decoded({ .type = 10, .bits = 32, .width = 2, .height = 1, .data = text({ 0x81, 1, 2, 3, 4 }) })
        == Pixels(2, packRgba(3, 2, 1)));
    CHECK(decoded({ .type = 3, .bits = 16, .width = 1, .height = 1, .data = text({ 7, 200 }) })
        == Pixels { packRgba(7, 7, 7) });
    CHECK(decoded({ .type = 1,
              .bits = 8,
              .width = 2,
              .height = 1,
              .mapLength = 2,
              .mapBits = 32,
              .map = text({ 1, 2, 3, 4, 5, 6, 7, 8 }),
              .data = text({ 1, 0 }) })
        == Pixels { packRgba(7, 6, 5), packRgba(3, 2, 1) });
}

TEST_CASE("TGA: the one attribute of 16 bits is alpha")
{
    const std::string data = text({ 0x5f, 0x84, 0x5f, 0x04 });
    const std::uint32_t opaque = packRgba(255 / 31, 2 * 255 / 31, 255);
    CHECK(decoded({ .bits = 16, .descriptor = 0x21, .width = 2, .height = 1, .data = data })
        == Pixels { opaque, opaque & 0xffffff });
    CHECK(decoded({ .bits = 16, .width = 2, .height = 1, .data = data }) == Pixels { opaque, opaque });
}

TEST_CASE("TGA: attributes that are 0 everywhere are no alpha")
{
    CHECK(decoded({ .bits = 32, .descriptor = 0x28, .width = 2, .height = 1, .data = text({ 1, 2, 3, 0, 4, 5, 6, 0 }) })
        == Pixels { packRgba(3, 2, 1), packRgba(6, 5, 4) });
    CHECK(decoded({ .bits = 32, .descriptor = 0x28, .width = 2, .height = 1, .data = text({ 1, 2, 3, 0, 4, 5, 6, 1 }) })
        == Pixels { packRgba(3, 2, 1, 0), packRgba(6, 5, 4, 1) });
    CHECK(decoded({ .type = 3, .bits = 16, .descriptor = 0x28, .width = 1, .height = 1, .data = text({ 7, 0 }) })
        == Pixels { packRgba(7, 7, 7) });
}

TEST_CASE("TGA: an extension area says what attributes are, whatever the descriptor has")
{
    const auto withArea = [](unsigned descriptor, int type) {
        const Tga tga { .bits = 32,
            .descriptor = descriptor,
            .width = 2,
            .height = 1,
            .data = text({ 20, 40, 60, 128, 1, 2, 3, 255 }) };
        File file;
        file.add(tga.bytes());
        const auto at = static_cast<std::uint32_t>(file.bytes.size());
        std::string area(495, '\0');
        area[0] = static_cast<char>(495 % 256);
        area[1] = static_cast<char>(495 / 256);
        area[494] = static_cast<char>(type);
        return file.add(area).u32(at).u32(0).add(std::string("TRUEVISION-XFILE.\0", 18)).bytes;
    };
    const auto pixels = [](const std::string& bytes) { return fromTop(decodeTga(bytesOf(bytes), {})); };
    const Pixels opaque { packRgba(60, 40, 20), packRgba(3, 2, 1) },
        alpha { packRgba(60, 40, 20, 128), packRgba(3, 2, 1) },
        divided { packRgba(120, 80, 40, 128), packRgba(3, 2, 1) };
    for (const unsigned descriptor : { 0x20u, 0x28u }) {
        CAPTURE(descriptor);
        for (const int none : { 0, 1, 2 })
            CHECK(pixels(withArea(descriptor, none)) == opaque);
        CHECK(pixels(withArea(descriptor, 3)) == alpha);
        CHECK(pixels(withArea(descriptor, 4)) == divided);
    }
    // A footer without an area, and one whose area lies beyond the file, say nothing.
    for (const std::uint32_t at : { 0u, 1u, 400u, 0xffffffffu }) {
        std::string bytes = withArea(0x28, 0);
        bytes.replace(bytes.size() - 26, 4, File().u32(at).bytes);
        CHECK(pixels(bytes) == alpha);
    }
    checkNoDamagedByteCrashes(withArea(0x28, 4), decodeTga);
}

TEST_CASE("TGA: runs, also beyond the end of a row, but not of the picture")
{
    const Pixels expected = { four[0], four[0], four[0], four[1] };
    CHECK(decoded({ .type = 10, .data = text({ 0x82, 1, 2, 3, 0, 4, 5, 6 }) }) == expected);
    CHECK(decoded({ .type = 10, .data = text({ 0, 1, 2, 3, 0x81, 1, 2, 3, 0x80, 4, 5, 6 }) }) == expected);
    CHECK(decoded({ .type = 10, .data = text({ 3 }) + fourBgr }) == four);
    CHECK(decoded({ .type = 11, .bits = 8, .data = text({ 0x83, 9 }) }) == Pixels(4, packRgba(9, 9, 9)));
    CHECK(decoded({ .type = 9,
              .bits = 8,
              .mapLength = 1,
              .mapBits = 24,
              .map = text({ 1, 2, 3 }),
              .data = text({ 0x83, 0 }) })
        == Pixels(4, four[0]));
    CHECK(failureOf(Tga { .type = 10, .data = text({ 0x84, 1, 2, 3 }) }.bytes(), decodeTga)
        == "a run of pixels goes beyond the picture");
}

TEST_CASE("TGA: headers that contradict themselves are no TGA")
{
    const auto isOne = [](const Tga& tga) { return isTga(bytesOf(tga.bytes())); };
    CHECK(isOne({ .data = fourBgr }));
    CHECK_FALSE(isOne({ .type = 0 }));
    CHECK_FALSE(isOne({ .type = 4 }));
    CHECK_FALSE(isOne({ .type = 8 }));
    CHECK_FALSE(isOne({ .type = 32 }));
    CHECK_FALSE(isOne({ .bits = 8 }));
    CHECK_FALSE(isOne({ .type = 1, .bits = 8 }));
    CHECK_FALSE(isOne({ .type = 1, .bits = 24, .mapLength = 1, .mapBits = 24 }));
    CHECK_FALSE(isOne({ .type = 3, .bits = 24 }));
    CHECK_FALSE(isOne({ .width = 0 }));
    CHECK_FALSE(isOne({ .height = 0 }));
    CHECK_FALSE(isOne({ .descriptor = 0x60 }));
    CHECK_FALSE(isOne({ .mapLength = 1, .mapBits = 7 }));
    CHECK_FALSE(isTga({}));
    CHECK(failureOf("", decodeTga) != "");
}

TEST_CASE("TGA: missing data are an error at every byte, and no damaged byte crashes")
{
    const Tga files[] = { { .id = "x", .data = fourBgr },
        { .type = 10, .data = text({ 0x81, 1, 2, 3, 1, 4, 5, 6, 7, 8, 9 }) },
        { .type = 9,
            .bits = 8,
            .mapLength = 2,
            .mapBits = 32,
            .map = text({ 1, 2, 3, 4, 5, 6, 7, 8 }),
            .data = text({ 0x81, 1, 1, 0, 1 }) } };
    for (const Tga& file : files) {
        checkEveryTruncationFails(file.bytes(), decodeTga);
        checkNoDamagedByteCrashes(file.bytes(), decodeTga);
    }
}
