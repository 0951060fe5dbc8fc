#include "host/decode/jpeg.h"

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <string>

#include <jpeglib.h>

#include <jerror.h>

namespace wedge::decode {

namespace {

constexpr int mostScans = 64;

// libjpeg leaves by longjmp, which skips destructors: what must be freed lives here, and the functions that call
// libjpeg hold nothing of their own.
struct Decoder {
    jpeg_decompress_struct jpeg {};
    jpeg_error_mgr errors {};
    jpeg_progress_mgr progress {};
    std::jmp_buf leave;
    char message[JMSG_LENGTH_MAX] = "it cannot be decoded";

    Decoder()
    {
        jpeg.err = jpeg_std_error(&errors);
        errors.error_exit = fail;
        errors.emit_message = judge;
        errors.output_message = [](j_common_ptr) {};
        progress.progress_monitor = countScans;
        jpeg.client_data = this;
    }
    ~Decoder() { jpeg_destroy_decompress(&jpeg); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    bool readHeader(Bytes bytes);
    bool start();
    bool readRow(JSAMPROW row);
    bool finish();

    [[noreturn]] static void fail(j_common_ptr common)
    {
        auto* decoder = static_cast<Decoder*>(common->client_data);
        common->err->format_message(common, decoder->message);
        std::longjmp(decoder->leave, 1);
    }
    /// Of what libjpeg repairs, missing and damaged data count as errors; the others leave the picture whole.
    static void judge(j_common_ptr common, int level)
    {
        if (level >= 0)
            return;
        switch (common->err->msg_code) {
        case JWRN_ARITH_BAD_CODE:
        case JWRN_BOGUS_PROGRESSION:
        case JWRN_HIT_MARKER:
        case JWRN_HUFF_BAD_CODE:
        case JWRN_JPEG_EOF:
        case JWRN_MUST_RESYNC:
            fail(common);
        default:
            break;
        }
    }
    /// Each scan goes over the whole picture, and a few bytes are enough for one.
    static void countScans(j_common_ptr common)
    {
        auto* decoder = static_cast<Decoder*>(common->client_data);
        if (decoder->jpeg.input_scan_number > mostScans) {
            std::snprintf(decoder->message, sizeof decoder->message, "it has more than %d scans", mostScans);
            std::longjmp(decoder->leave, 1);
        }
    }
};

bool Decoder::readHeader(Bytes bytes)
{
    if (setjmp(leave))
        return false;
    jpeg_create_decompress(&jpeg);
    jpeg.progress = &progress;
    jpeg_mem_src(&jpeg, bytes.data(), static_cast<unsigned long>(bytes.size()));
    jpeg_read_header(&jpeg, TRUE);
    return true;
}

bool Decoder::start()
{
    if (setjmp(leave))
        return false;
    jpeg.out_color_space = jpeg.num_components == 4 ? JCS_CMYK : JCS_RGB;
    jpeg.dct_method = JDCT_ISLOW;
    jpeg_start_decompress(&jpeg);
    return true;
}

bool Decoder::readRow(JSAMPROW row)
{
    if (setjmp(leave))
        return false;
    jpeg_read_scanlines(&jpeg, &row, 1);
    return true;
}

bool Decoder::finish()
{
    if (setjmp(leave))
        return false;
    jpeg_finish_decompress(&jpeg);
    return true;
}

/// Bytes of the coefficients that libjpeg keeps where a picture comes in several scans; blocks are of 8x8, and their
/// number is rounded up to whole units of all components.
std::int64_t coefficientBytes(const jpeg_decompress_struct& jpeg)
{
    std::int64_t blocks = 0;
    const auto unitsOf = [](std::int64_t pixels, std::int64_t most) { return (pixels + 8 * most - 1) / (8 * most); };
    for (int i = 0; i < jpeg.num_components; ++i) {
        const jpeg_component_info& component = jpeg.comp_info[i];
        blocks += unitsOf(jpeg.image_width, jpeg.max_h_samp_factor) * component.h_samp_factor
            * unitsOf(jpeg.image_height, jpeg.max_v_samp_factor) * component.v_samp_factor;
    }
    return blocks * static_cast<std::int64_t>(sizeof(JBLOCK));
}

void check(Decoder& decoder, std::size_t fileBytes, const Limits& limits)
{
    constexpr JDIMENSION mostSide = 65535; // of the format
    constexpr std::int64_t mostCoefficients = std::int64_t { 128 } << 20, coefficientsPerByte = 64;
    const jpeg_decompress_struct& jpeg = decoder.jpeg;
    if (jpeg.image_width > mostSide || jpeg.image_height > mostSide)
        throw Failure("its size is out of range");
    limits.admit({ static_cast<int>(jpeg.image_width), static_cast<int>(jpeg.image_height) }, fileBytes);
    if (jpeg.arith_code)
        throw Failure("it is packed by arithmetic coding", "save it as PNG, or as a usual JPEG");
    if (jpeg.num_components != 1 && jpeg.num_components != 3 && jpeg.num_components != 4)
        throw Failure("it has " + std::to_string(jpeg.num_components) + " channels", "save it as PNG");
    const std::int64_t coefficients = coefficientBytes(jpeg);
    if (jpeg_has_multiple_scans(&decoder.jpeg) && coefficients > mostCoefficients
        && coefficients / coefficientsPerByte > static_cast<std::int64_t>(fileBytes))
        throw Failure("it is progressive and would take " + std::to_string(coefficients >> 20) + " MiB to decode",
            "save it as PNG, or as a JPEG that is not progressive");
}

/// Inks to light. Adobe's programs, which say that they wrote the file, store what is left of the light.
unsigned underInk(unsigned ink, unsigned black, bool inverted)
{
    const unsigned product = inverted ? ink * black : (255 - ink) * (255 - black);
    return (product + 127) / 255;
}

} // namespace

Picture decodeJpeg(Bytes bytes, const Limits& limits)
{
    Decoder decoder;
    if (!decoder.readHeader(bytes))
        throw Failure(decoder.message);
    check(decoder, bytes.size(), limits);
    const jpeg_decompress_struct& jpeg = decoder.jpeg;
    if (!decoder.start())
        throw Failure(decoder.message);
    Picture picture({ static_cast<int>(jpeg.image_width), static_cast<int>(jpeg.image_height) });
    const bool inks = jpeg.num_components == 4, inverted = jpeg.saw_Adobe_marker;
    std::vector<JSAMPLE> row(std::size_t { jpeg.image_width } * (inks ? 4 : 3));
    for (int y = 0; y < picture.size.height; ++y) {
        if (!decoder.readRow(row.data()))
            throw Failure(decoder.message);
        std::uint32_t* to = picture.rowFromTop(y);
        const JSAMPLE* p = row.data();
        for (int x = 0; x < picture.size.width; ++x, p += inks ? 4 : 3) {
            to[x] = inks ? packRgba(
                        underInk(p[0], p[3], inverted), underInk(p[1], p[3], inverted), underInk(p[2], p[3], inverted))
                         : packRgba(p[0], p[1], p[2]);
        }
    }
    if (!decoder.finish())
        throw Failure(decoder.message);
    return picture;
}

} // namespace wedge::decode
