#include "host/decode/png.h"
#include "tests/decode_support.h"

#include <algorithm>
#include <png.h>
#include <zlib.h>

using namespace wedge::decode;
using namespace wedge::decode::test;

namespace {

std::string chunk(const std::string& type, const std::string& data)
{
    const std::string body = type + data;
    const auto sum = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
    const auto bigEndian = [](std::size_t v) {
        return text({ static_cast<int>(v >> 24 & 255), static_cast<int>(v >> 16 & 255), static_cast<int>(v >> 8 & 255),
            static_cast<int>(v & 255) });
    };
    return bigEndian(data.size()) + body + bigEndian(sum);
}

std::string deflated(const std::string& raw)
{
    std::string out(compressBound(static_cast<uLong>(raw.size())), '\0');
    uLongf size = static_cast<uLongf>(out.size());
    compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
        static_cast<uLong>(raw.size()), 9);
    return out.substr(0, size);
}

struct Png {
    int width = 2, height = 1, depth = 8, colour = PNG_COLOR_TYPE_RGB;
    std::string before = "", rows = "", after = "";

    std::string bytes() const
    {
        const auto high = [](int v) { return v >> 8 & 255; };
        return text({ 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' })
            + chunk("IHDR",
                text({ 0, width >> 16 & 255, high(width), width & 255, 0, height >> 16 & 255, high(height),
                    height & 255, depth, colour, 0, 0, 0 }))
            + before + chunk("IDAT", deflated(rows)) + after + chunk("IEND", "");
    }
};

/// Encodes RGBA rows from the top with libpng, interlaced.
std::string interlaced(int width, int height, std::vector<png_byte> rgba)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    std::string out;
    png_set_write_fn(
        png, &out,
        [](png_structp p, png_bytep data, png_size_t size) {
            static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), size);
        },
        [](png_structp) {});
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGBA,
        PNG_INTERLACE_ADAM7, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    std::vector<png_bytep> rows(static_cast<std::size_t>(height));
    for (std::size_t y = 0; y < rows.size(); ++y)
        rows[y] = rgba.data() + 4 * y * static_cast<std::size_t>(width);
    png_set_rows(png, info, rows.data());
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &info);
    return out;
}

Pixels decoded(const Png& png) { return fromTop(decodePng(bytesOf(png.bytes()), {})); }

const std::string palette = chunk("PLTE", text({ 1, 2, 3, 4, 5, 6 }));

} // namespace

TEST_CASE("PNG: every kind becomes RGBA of 8 bits, as encoded")
{
    const std::uint32_t one = packRgba(1, 2, 3), two = packRgba(4, 5, 6);
    CHECK(decoded({ .rows = text({ 0, 1, 2, 3, 4, 5, 6 }) }) == Pixels { one, two });
    CHECK(decoded({ .depth = 16, .rows = text({ 0, 1, 99, 2, 99, 3, 99, 4, 255, 5, 255, 6, 255 }) })
        == Pixels { one, two });
    CHECK(decoded({ .colour = PNG_COLOR_TYPE_RGBA, .rows = text({ 0, 1, 2, 3, 7, 4, 5, 6, 0 }) })
        == Pixels { packRgba(1, 2, 3, 7), packRgba(4, 5, 6, 0) });
    CHECK(decoded({ .colour = PNG_COLOR_TYPE_GRAY, .rows = text({ 0, 9, 200 }) })
        == Pixels { packRgba(9, 9, 9), packRgba(200, 200, 200) });
    CHECK(decoded({ .depth = 1, .colour = PNG_COLOR_TYPE_GRAY, .rows = text({ 0, 0x40 }) })
        == Pixels { packRgba(0, 0, 0), packRgba(255, 255, 255) });
    CHECK(decoded({ .colour = PNG_COLOR_TYPE_GRAY_ALPHA, .rows = text({ 0, 9, 1, 200, 2 }) })
        == Pixels { packRgba(9, 9, 9, 1), packRgba(200, 200, 200, 2) });
    CHECK(decoded({ .colour = PNG_COLOR_TYPE_PALETTE, .before = palette, .rows = text({ 0, 1, 0 }) })
        == Pixels { two, one });
    CHECK(decoded({ .depth = 1,
              .colour = PNG_COLOR_TYPE_PALETTE,
              .before = palette + chunk("tRNS", text({ 50 })),
              .rows = text({ 0, 0x40 }) })
        == Pixels { packRgba(1, 2, 3, 50), two });
    CHECK(decoded({ .before = chunk("tRNS", text({ 0, 1, 0, 2, 0, 3 })), .rows = text({ 0, 1, 2, 3, 4, 5, 6 }) })
        == Pixels { packRgba(1, 2, 3, 0), two });
}

TEST_CASE("PNG: colours of another curve or other primaries become those of sRGB, numbers stay")
{
    const auto gamma = [](int hundredThousandths) {
        return chunk("gAMA",
            text({ 0, hundredThousandths >> 16 & 255, hundredThousandths >> 8 & 255, hundredThousandths & 255 }));
    };
    const auto both = [](const std::string& before) {
        const std::string bytes = Png { .colour = PNG_COLOR_TYPE_RGBA,
            .before = before,
            .rows = text({ 0, 0, 64, 255, 7, 128, 128, 128, 255 }) }
                                      .bytes();
        const Picture colours = decodePng(bytesOf(bytes), {});
        const Picture numbers = decodePngFor(TextureUse::Numbers, bytesOf(bytes), {});
        CHECK(fromTop(numbers) == Pixels { packRgba(0, 64, 255, 7), packRgba(128, 128, 128) });
        CHECK(colours.sameForAllUses == (fromTop(colours) == fromTop(numbers)));
        return fromTop(colours);
    };
    const Pixels stored { packRgba(0, 64, 255, 7), packRgba(128, 128, 128) },
        linear { packRgba(0, 137, 255, 7), packRgba(188, 188, 188) };
    CHECK(both("") == stored);
    CHECK(both(gamma(100000)) == linear);
    CHECK(both(gamma(45455)) == stored); // how files say sRGB
    CHECK(both(gamma(0)) == stored);
    CHECK(both(chunk("sRGB", text({ 0 })) + gamma(100000)) == stored);
    CHECK(both(gamma(55556))[1] == packRgba(146, 146, 146)); // an exponent of 1.8
    CHECK(both(chunk("cICP", text({ 1, 13, 0, 1 })) + gamma(100000)) == stored);
    CHECK(both(chunk("cICP", text({ 1, 8, 0, 1 }))) == linear);
    // Rec.2020 with the curve of sRGB: grey stays, and a blue is beyond sRGB's, which is clipped.
    const Pixels wide = both(chunk("cICP", text({ 9, 13, 0, 1 })));
    CHECK(wide[1] == stored[1]);
    CHECK(wide[0] == packRgba(0, 63, 255, 7));
    // 16 bits, linear: 0.001 is 8 bits' 3 by the curve, and would be 0 if it were rounded before.
    CHECK(decoded({ .width = 1, .depth = 16, .before = gamma(100000), .rows = text({ 0, 0, 66, 0, 66, 0, 66 }) })
        == Pixels { packRgba(3, 3, 3) });
    const auto failure = [](const std::string& before) {
        return failureOf(Png { .before = before, .rows = text({ 0, 1, 2, 3, 4, 5, 6 }) }.bytes(), decodePng);
    };
    CHECK(failure(chunk("cICP", text({ 9, 16, 0, 1 }))) == "its cICP chunk has a transfer curve (16) that is not read");
    CHECK(failure(chunk("cICP", text({ 9, 18, 0, 1 }))) == "its cICP chunk has a transfer curve (18) that is not read");
    CHECK(failure(chunk("cICP", text({ 3, 13, 0, 1 }))) == "its cICP chunk has primaries (3) that are not read");
    CHECK(failure(chunk("cICP", text({ 1, 13, 0, 0 }))) == "its cICP chunk says that it is no RGB of full range");
    CHECK(failure(chunk("cICP", text({ 1, 13 }))) == "its cICP chunk has not four bytes");
}

TEST_CASE("PNG: chromaticities count as cICP's primaries do")
{
    const auto chromaticities = [](std::initializer_list<int> values) {
        std::string data;
        for (const int v : values)
            data += text({ v >> 24 & 255, v >> 16 & 255, v >> 8 & 255, v & 255 });
        return chunk("cHRM", data);
    };
    const auto decodedWith = [](const std::string& before) {
        return decoded({ .before = before, .rows = text({ 0, 200, 90, 100, 128, 128, 128 }) });
    };
    const std::string rec2020 = chromaticities({ 31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600 });
    const Pixels wide = decodedWith(rec2020);
    CHECK(wide == decodedWith(chunk("cICP", text({ 9, 13, 0, 1 }))));
    CHECK(wide[0] != packRgba(200, 90, 100));
    CHECK(wide[1] == packRgba(128, 128, 128));
    const Pixels stored { packRgba(200, 90, 100), packRgba(128, 128, 128) };
    CHECK(decodedWith(chunk("sRGB", text({ 0 })) + rec2020) == stored);
    CHECK(decodedWith(chromaticities({ 31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000 })) == stored);
    CHECK(decodedWith(chromaticities({ 0, 0, 0, 0, 0, 0, 0, 0 })) == stored); // libpng passes over it
}

TEST_CASE("PNG: interlaced pictures of every small size, each pixel in its place")
{
    for (int width = 1; width <= 10; ++width) {
        for (int height = 1; height <= 10; ++height) {
            std::vector<png_byte> rgba;
            Pixels expected;
            for (int i = 0; i < width * height; ++i) {
                const auto a = static_cast<png_byte>(i + 1), b = static_cast<png_byte>(200 - i);
                rgba.insert(rgba.end(), { a, b, 3, b });
                expected.push_back(packRgba(a, b, 3, b));
            }
            CAPTURE(width);
            CAPTURE(height);
            CHECK(fromTop(decodePng(bytesOf(interlaced(width, height, rgba)), {})) == expected);
        }
    }
}

TEST_CASE("PNG: text and profiles are skipped, however much they would unpack to, but not when damaged")
{
    const std::string huge = deflated(std::string(30 << 20, 'x'));
    Png png { .rows = text({ 0, 1, 2, 3, 4, 5, 6 }) };
    png.before = chunk("zTXt", std::string("a\0\0", 3) + huge) + chunk("iCCP", std::string("p\0\0", 3) + huge)
        + chunk("tEXt", std::string("a\0b", 3)) + chunk("quUX", "unknown");
    png.after = chunk("iTXt", std::string("a\0\1\0\0\0", 6) + huge);
    CHECK(decoded(png) == Pixels { packRgba(1, 2, 3), packRgba(4, 5, 6) });
    const std::string whole = png.bytes();
    for (const char* name : { "zTXt", "iCCP", "tEXt", "quUX", "iTXt" }) {
        CAPTURE(name);
        std::string damaged = whole;
        damaged[damaged.find(name) + 4] ^= 1; // the checksum no longer fits
        CHECK(failureOf(damaged, decodePng) != "");
    }
}

TEST_CASE("PNG: missing and damaged data are an error at every byte")
{
    const std::string plain =
        Png { .before = palette, .rows = text({ 0, 1, 2, 3, 4, 5, 6 }), .after = chunk("tEXt", "a") }.bytes();
    const std::string woven = interlaced(3, 3, std::vector<png_byte>(36, 77));
    for (const std::string& whole : { plain, woven }) {
        checkEveryTruncationFails(whole, decodePng);
        checkNoDamagedByteCrashes(whole, decodePng);
    }
    for (std::size_t at = 0; at < plain.size(); ++at) { // signature, lengths and checksums cover all
        CAPTURE(at);
        std::string damaged = plain;
        damaged[at] ^= 0x10;
        CHECK(failureOf(damaged, decodePng) != "");
    }
    CHECK(failureOf(Png { .rows = text({ 0, 1, 2, 3 }) }.bytes(), decodePng) != ""); // a whole file, too few pixels
}

TEST_CASE("PNG: sizes are held against the limits before a row is decoded")
{
    const auto failure = [](int width, int height) {
        return failureOf(
            Png { .width = width, .height = height, .depth = 1, .colour = PNG_COLOR_TYPE_GRAY }.bytes(), decodePng);
    };
    CHECK(failure(32768, 16383) == "it has 32768x16383 pixels, at most 67108864 are read");
    CHECK(failure(1 << 20, 1) == "it has 1048576x1 pixels, at most 32768 a side are read");
    CHECK(failure(8192, 8192).find("it claims 8192x8192 pixels in ") == 0);
}
