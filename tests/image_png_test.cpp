#include "host/image/colour.h"
#include "host/image/png.h"
#include "host/image/read_image.h"

#include "host/error.h"
#include "tests/image_test_support.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <png.h>
#include <stdexcept>

using namespace wedge::image;
using namespace wedge::image::test;

namespace {

// Writes 2x1 pixels of that kind with libpng, sRGB unless a gamma is given.
void writeForeign(const std::string& path, int colourType, int depth, std::vector<png_byte> row,
    bool interlaced = false, double gamma = 0.0)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    std::FILE* file = std::fopen(path.c_str(), "wb");
    png_init_io(png, file);
    png_set_IHDR(png, info, 2, 1, depth, colourType, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
        PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    const png_color palette[] = { { 255, 0, 0 }, { 0, 128, 255 } };
    if (colourType == PNG_COLOR_TYPE_PALETTE)
        png_set_PLTE(png, info, palette, 2);
    if (gamma > 0.0)
        png_set_gAMA(png, info, gamma);
    png_bytep rows[] = { row.data() };
    png_set_rows(png, info, rows);
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

double linear(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

void checkValues(const RgbImage& image, const std::vector<double>& expected)
{
    CHECK(image.width == 2);
    CHECK(image.height == 1);
    REQUIRE(image.rgb.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(image.rgb[i] == doctest::Approx(expected[i]).epsilon(1e-5));
}

std::string readError(const std::string& path)
{
    try {
        readPng(path);
    } catch (const wedge::Error& error) {
        return error.what();
    }
    return "no error";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("the sRGB curve meets its standard and its inverse")
{
    CHECK(encodeSrgb(0.0f) == 0.0f);
    CHECK(encodeSrgb(1.0f) == doctest::Approx(1.0));
    CHECK(encodeSrgb(0.18f) == doctest::Approx(0.46135613));
    CHECK(encodeSrgb(0.002f) == doctest::Approx(0.02584));
    for (int i = 0; i <= 255; ++i) {
        const float encoded = static_cast<float>(i) / 255.0f;
        CHECK(encodeSrgb(decodeSrgb(encoded)) == doctest::Approx(encoded).epsilon(1e-5));
    }
}

TEST_CASE("every 8-bit level survives, and other values are off by half a level at most")
{
    const TempDirectory directory;
    RgbImage levels { 256, 1, {} };
    for (int i = 0; i < 256; ++i)
        levels.rgb.insert(levels.rgb.end(), 3, decodeSrgb(static_cast<float>(i) / 255.0f));
    writePng(directory / "a.png", levels);
    const RgbImage read = readPng(directory / "a.png");
    CHECK(read.width == 256);
    CHECK(read.height == 1);
    for (std::size_t i = 0; i < levels.rgb.size(); ++i)
        CHECK(read.rgb[i] == doctest::Approx(levels.rgb[i]).epsilon(1e-5));

    const RgbImage card = testCard(33, 21);
    writePng(directory / "b.png", card);
    const RgbImage back = readImage(directory / "b.png");
    REQUIRE(back.rgb.size() == card.rgb.size());
    for (std::size_t i = 0; i < card.rgb.size(); ++i)
        CHECK(std::abs(encodeSrgb(back.rgb[i]) - encodeSrgb(card.rgb[i])) < 0.5001f / 255.0f);
    CHECK(directory.entries() == 2);
}

TEST_CASE("values are clipped, not mapped, and exposure is in stops")
{
    const TempDirectory directory;
    const float infinity = std::numeric_limits<float>::infinity();
    const float notANumber = std::numeric_limits<float>::quiet_NaN();
    const RgbImage wild { 2, 1, { -1, 7, infinity, notANumber, -infinity, 0.25f } };
    writePng(directory / "a.png", wild);
    checkValues(readPng(directory / "a.png"), { 0, 1, 1, 0, 0, linear(137.0 / 255.0) });
    const RgbImage gray { 2, 1, { 0.5f, 0.25f, 0.125f, 2, 4, 8 } };
    writePng(directory / "b.png", gray, { .exposureStops = 1.0f });
    checkValues(readPng(directory / "b.png"), { 1, linear(188.0 / 255.0), linear(137.0 / 255.0), 1, 1, 1 });
    writePng(directory / "c.png", gray, { .exposureStops = -3.0f });
    CHECK(readPng(directory / "c.png").rgb[5] == 1.0f);
    CHECK(readPng(directory / "c.png").rgb[3] == doctest::Approx(linear(137.0 / 255.0)));
    CHECK_THROWS_AS(writePng(directory / "d.png", RgbImage {}), std::logic_error);
    CHECK(directory.entries() == 3);
}

TEST_CASE("PNGs of ours say so, to everyone")
{
    const TempDirectory directory;
    const std::string own = directory / "own.png", foreign = directory / "foreign.png";
    writePng(own, testCard(3, 2));
    writeForeign(foreign, PNG_COLOR_TYPE_GRAY, 8, { 128, 255 });
    CHECK(isOwnPng(own));
    CHECK_FALSE(isOwnPng(foreign));
    CHECK_FALSE(isOwnPng(directory.path()));
    CHECK_FALSE(isOwnPng(directory / "missing.png"));
    CHECK_FALSE(isOwnPng("/dev/zero"));
    writeBytes(foreign, readBytes(own).substr(0, 40));
    CHECK_FALSE(isOwnPng(foreign));

    // libpng passes over a chunk whose checksum is wrong.
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    std::FILE* file = std::fopen(own.c_str(), "rb");
    png_init_io(png, file);
    png_read_info(png, info);
    png_textp text = nullptr;
    REQUIRE(png_get_text(png, info, &text, nullptr) == 1);
    CHECK(std::string(text[0].key) == "Software");
    CHECK(std::string(text[0].text) == "wedge");
    png_destroy_read_struct(&png, &info, nullptr);
    std::fclose(file);
}

TEST_CASE("PNG of every kind is read as linear RGB")
{
    const TempDirectory directory;
    const std::string path = directory / "a.png";
    const double half = linear(128.0 / 255.0);
    writeForeign(path, PNG_COLOR_TYPE_GRAY, 8, { 128, 255 });
    checkValues(readPng(path), { half, half, half, 1, 1, 1 });
    writeForeign(path, PNG_COLOR_TYPE_GRAY, 1, { 0x40 });
    checkValues(readPng(path), { 0, 0, 0, 1, 1, 1 });
    writeForeign(path, PNG_COLOR_TYPE_GRAY_ALPHA, 8, { 128, 0, 255, 77 });
    checkValues(readPng(path), { half, half, half, 1, 1, 1 });
    for (const bool interlaced : { false, true }) {
        writeForeign(path, PNG_COLOR_TYPE_RGB, 8, { 0, 128, 255, 10, 20, 30 }, interlaced);
        checkValues(readPng(path), { 0, half, 1, linear(10 / 255.0), linear(20 / 255.0), linear(30 / 255.0) });
    }
    writeForeign(path, PNG_COLOR_TYPE_RGB_ALPHA, 8, { 0, 128, 255, 0, 10, 20, 30, 99 });
    checkValues(readPng(path), { 0, half, 1, linear(10 / 255.0), linear(20 / 255.0), linear(30 / 255.0) });
    writeForeign(path, PNG_COLOR_TYPE_PALETTE, 8, { 1, 0 });
    checkValues(readPng(path), { 0, half, 1, 1, 0, 0 });
    writeForeign(path, PNG_COLOR_TYPE_RGB, 16, { 0, 1, 128, 0, 255, 255, 1, 2, 3, 4, 5, 6 });
    checkValues(readPng(path),
        { linear(1 / 65535.0), linear(32768 / 65535.0), 1, linear(258 / 65535.0), linear(772 / 65535.0),
            linear(1286 / 65535.0) });
    writeForeign(path, PNG_COLOR_TYPE_GRAY, 16, { 128, 0, 0, 0 }, false, 1.0); // stated to be linear
    checkValues(readPng(path), { 32768 / 65535.0, 32768 / 65535.0, 32768 / 65535.0, 0, 0, 0 });
    writeForeign(path, PNG_COLOR_TYPE_GRAY, 8, { 128, 255 }, false, 1.0 / 2.2); // how files without sRGB say sRGB
    checkValues(readPng(path), { half, half, half, 1, 1, 1 });
}

TEST_CASE("PNG files that cannot be read give one line that says why")
{
    const TempDirectory directory;
    const std::string path = directory / "a.png";
    CHECK(readError(path) == "PNG image not found: " + path + ": check the path");
    CHECK(contains(readError(directory.path()), "PNG image is a folder"));
    writeBytes(path, "");
    CHECK(contains(readError(path), "it is empty"));
    writeBytes(path, "not a picture at all");
    CHECK(readError(path)
        == "cannot read PNG image (Not a PNG file): " + path + ": check that the file is whole and of its type");
    writePng(path, noisyCard(50, 40, 1.0, 1));
    const std::string whole = readBytes(path);
    for (std::size_t size = 1; size < whole.size(); size += 97) {
        CAPTURE(size);
        writeBytes(path, whole.substr(0, size));
        CHECK(contains(readError(path), path));
    }
    for (std::uint32_t i = 0; i < 300; ++i) { // checksums find every damaged byte that matters
        std::string damaged = whole;
        damaged[static_cast<std::size_t>(hashed(i, 0, 0, 1) * static_cast<double>(whole.size()))] ^= 0x55;
        writeBytes(path, damaged);
        CHECK(contains(readError(path), "cannot read PNG image"));
    }
}

TEST_CASE("Radiance HDR is read as it is")
{
    const TempDirectory directory;
    const std::string path = directory / "a.HDR";
    // Two pixels, mantissas and shared exponent: (m + 0.5 or 0) / 256 * 2^(e - 128) by the decoder's convention.
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    writeBytes(path, header + std::string("\x80\x40\x00\x81\xff\x80\x01\x8a", 8));
    checkValues(readImage(path), { 1.0, 0.5, 0.0, 1020.0, 512.0, 4.0 });
    writeBytes(path, "plain text");
    CHECK_THROWS_AS(readImage(path), wedge::Error);
    writeBytes(path, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 1000000\n");
    CHECK_THROWS_AS(readImage(path), wedge::Error);
}
