#include "host/decode/jpeg.h"
#include "tests/decode_support.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <jpeglib.h>

using namespace wedge::decode;
using namespace wedge::decode::test;

namespace {

struct Jpeg {
    int width = 19, height = 13;
    J_COLOR_SPACE from = JCS_RGB, stored = JCS_YCbCr;
    int sampling = 1;
    bool progressive = false, arithmetic = false, adobe = true;
    int restart = 0;
    std::vector<jpeg_scan_info> scans = {};
};

/// A smooth ramp, so that what quantisation loses is little.
int ramp(int x, int y, int channel) { return 40 + 4 * x + 3 * y + 20 * channel; }

std::string encoded(const Jpeg& wanted)
{
    const int channels = wanted.from == JCS_RGB ? 3 : wanted.from == JCS_CMYK ? 4 : 1;
    jpeg_compress_struct jpeg {};
    jpeg_error_mgr errors {};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &data, &size);
    jpeg.image_width = static_cast<JDIMENSION>(wanted.width);
    jpeg.image_height = static_cast<JDIMENSION>(wanted.height);
    jpeg.input_components = channels;
    jpeg.in_color_space = wanted.from;
    jpeg_set_defaults(&jpeg);
    jpeg_set_colorspace(&jpeg, wanted.stored);
    jpeg_set_quality(&jpeg, 95, TRUE);
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = wanted.sampling;
    jpeg.arith_code = wanted.arithmetic;
    jpeg.restart_interval = static_cast<unsigned>(wanted.restart);
    if (!wanted.adobe)
        jpeg.write_Adobe_marker = FALSE;
    if (wanted.progressive)
        jpeg_simple_progression(&jpeg);
    if (!wanted.scans.empty()) {
        jpeg.scan_info = wanted.scans.data();
        jpeg.num_scans = static_cast<int>(wanted.scans.size());
    }
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<JSAMPLE> row(static_cast<std::size_t>(wanted.width * channels));
    for (int y = 0; y < wanted.height; ++y) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            const int at = static_cast<int>(i);
            row[i] = static_cast<JSAMPLE>(std::min(ramp(at / channels % 32, y % 16, at % channels), 255));
        }
        JSAMPROW pointer = row.data();
        jpeg_write_scanlines(&jpeg, &pointer, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    const std::string out(reinterpret_cast<char*>(data), size);
    std::free(data);
    return out;
}

/// The greatest difference of a channel from what `expected(x, y, channel)` says.
template <class Expected>
int greatestError(const std::string& bytes, Expected&& expected)
{
    Picture picture = decodeJpeg(bytesOf(bytes), {});
    const Size expectedSize { 19, 13 };
    CHECK(picture.size == expectedSize);
    int worst = 0;
    for (int y = 0; y < picture.size.height; ++y) {
        for (int x = 0; x < picture.size.width; ++x) {
            const std::uint32_t pixel = picture.rowFromTop(y)[x];
            CHECK((pixel | 0xffffff) == 0xffffffff);
            for (int c = 0; c < 3; ++c)
                worst = std::max(worst, std::abs(static_cast<int>(pixel >> 8 * c & 255) - expected(x, y, c)));
        }
    }
    return worst;
}

} // namespace

TEST_CASE("JPEG: baseline and progressive, grey, RGB and YCbCr of every sampling")
{
    for (const bool progressive : { false, true }) {
        CAPTURE(progressive);
        for (const int sampling : { 1, 2 })
            CHECK(greatestError(encoded({ .sampling = sampling, .progressive = progressive }), ramp) <= 6);
        CHECK(greatestError(encoded({ .stored = JCS_RGB, .progressive = progressive }), ramp) <= 6);
        const Jpeg grey { .from = JCS_GRAYSCALE, .stored = JCS_GRAYSCALE, .progressive = progressive, .restart = 1 };
        CHECK(greatestError(encoded(grey), [](int x, int y, int) { return ramp(x, y, 0); }) <= 6);
    }
}

TEST_CASE("JPEG: inks, of which Adobe's programs store what is left of the light")
{
    const auto light = [](int x, int y, int c) { return ramp(x, y, c) * ramp(x, y, 3) / 255; };
    const auto ink = [](int x, int y, int c) { return (255 - ramp(x, y, c)) * (255 - ramp(x, y, 3)) / 255; };
    CHECK(greatestError(encoded({ .from = JCS_CMYK, .stored = JCS_CMYK }), light) <= 6);
    CHECK(greatestError(encoded({ .from = JCS_CMYK, .stored = JCS_YCCK }), light) <= 6);
    CHECK(greatestError(encoded({ .from = JCS_CMYK, .stored = JCS_CMYK, .adobe = false }), ink) <= 6);
}

TEST_CASE("JPEG: what stands between the markers does not matter")
{
    const std::string whole = encoded({});
    const std::string between = whole.substr(0, 2) + "junk" + whole.substr(2);
    CHECK(failureOf(between, decodeJpeg) == "");
    CHECK(failureOf(whole + "more", decodeJpeg) == "");
}

TEST_CASE("JPEG: what is not read")
{
    CHECK(failureOf(encoded({ .arithmetic = true }), decodeJpeg) == "it is packed by arithmetic coding");
    CHECK(failureOf("", decodeJpeg) != "");
    CHECK(failureOf("\xff\xd8\xff", decodeJpeg) != "");
}

TEST_CASE("JPEG: missing data are an error at every byte, and no damaged byte crashes")
{
    for (const bool progressive : { false, true }) {
        CAPTURE(progressive);
        const std::string whole = encoded({ .sampling = 2, .progressive = progressive });
        checkEveryTruncationFails(whole, decodeJpeg);
        checkNoDamagedByteCrashes(whole, decodeJpeg);
    }
}

TEST_CASE("JPEG: sizes that lie, and what would take libjpeg too much memory or time")
{
    std::string wide = encoded({});
    const std::size_t frame = wide.find(text({ 0xff, 0xc0 }));
    REQUIRE(frame != std::string::npos);
    const auto claim = [&](unsigned side) {
        for (const std::size_t at : { frame + 5, frame + 7 }) {
            wide[at] = static_cast<char>(side >> 8);
            wide[at + 1] = static_cast<char>(side & 255);
        }
        return failureOf(wide, decodeJpeg);
    };
    CHECK(claim(65500) == "it has 65500x65500 pixels, at most 32768 a side are read");
    CHECK(claim(32768) == "it has 32768x32768 pixels, at most 67108864 are read");
    CHECK(claim(8192).find("it claims 8192x8192 pixels in ") == 0);

    std::string large = encoded({ .progressive = true });
    const std::size_t at = large.find(text({ 0xff, 0xc2 })) + 5;
    large.replace(at, 4, text({ 0x15, 0x18, 0x15, 0x18 })); // 5400 x 5400
    large.append(40000, ' ');
    CHECK(failureOf(large, decodeJpeg, { .unquestioned = 1 << 25 })
        == "it is progressive and would take 166 MiB to decode");

    // DC, then an AC coefficient again and again, a bit better each time: a legal file of any number of scans.
    std::vector<jpeg_scan_info> scans = { { 1, { 0, 0, 0, 0 }, 0, 0, 0, 0 } };
    for (int k = 1; k < 64; ++k)
        scans.push_back({ 1, { 0, 0, 0, 0 }, k, k, 0, 1 });
    const Jpeg many { .from = JCS_GRAYSCALE, .stored = JCS_GRAYSCALE, .scans = scans };
    CHECK(failureOf(encoded(many), decodeJpeg) == "");
    Jpeg tooMany = many;
    tooMany.scans.push_back({ 1, { 0, 0, 0, 0 }, 1, 1, 1, 0 });
    CHECK(failureOf(encoded(tooMany), decodeJpeg) == "it has more than 64 scans");
}
