#include "host/image/colour.h"
#include "host/image/input_checks.h"
#include "host/image/png.h"

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <png.h>

namespace wedge::image {

namespace {

// libpng leaves by longjmp, which skips destructors: what must be freed lives here, and the functions that call libpng
// hold nothing of their own.
struct Decoder {
    std::FILE* file = nullptr;
    png_structp png = nullptr;
    png_infop info = nullptr;
    char message[200] = "";
    png_uint_32 width = 0;
    png_uint_32 height = 0;
    double gamma = 0.0; // of the encoding, 0 for sRGB

    explicit Decoder(const std::string& path)
        : file(std::fopen(path.c_str(), "rb"))
    {
    }
    ~Decoder()
    {
        png_destroy_read_struct(&png, &info, nullptr);
        if (file)
            std::fclose(file);
    }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
};

extern "C" void leaveWithMessage(png_structp png, png_const_charp message)
{
    char* to = static_cast<Decoder*>(png_get_error_ptr(png))->message;
    std::strncpy(to, message, sizeof(Decoder::message) - 1);
    png_longjmp(png, 1);
}

extern "C" void ignoreWarning(png_structp, png_const_charp) { }

// Reads up to the pixels and asks for three 16-bit samples per pixel, whatever the file holds.
bool readHeader(Decoder& decoder)
{
    decoder.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoder, leaveWithMessage, ignoreWarning);
    decoder.info = decoder.png ? png_create_info_struct(decoder.png) : nullptr;
    if (!decoder.info || !decoder.file)
        return false;
    if (setjmp(png_jmpbuf(decoder.png)))
        return false;
    png_init_io(decoder.png, decoder.file);
    png_set_user_limits(decoder.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(decoder.png, decoder.info);
    decoder.width = png_get_image_width(decoder.png, decoder.info);
    decoder.height = png_get_image_height(decoder.png, decoder.info);
    int intent = 0;
    double gamma = 0.0;
    if (!png_get_sRGB(decoder.png, decoder.info, &intent) && png_get_gAMA(decoder.png, decoder.info, &gamma)
        && gamma > 0.0 && std::abs(gamma - 1.0 / 2.2) > 0.01)
        decoder.gamma = gamma;
    png_set_expand_16(decoder.png);
    png_set_gray_to_rgb(decoder.png);
    png_set_strip_alpha(decoder.png);
    png_set_interlace_handling(decoder.png);
    png_read_update_info(decoder.png, decoder.info);
    return true;
}

bool readRows(Decoder& decoder, png_bytepp rows)
{
    if (setjmp(png_jmpbuf(decoder.png)))
        return false;
    png_read_image(decoder.png, rows);
    png_read_end(decoder.png, nullptr);
    return true;
}

float toLinear(float encoded, double gamma)
{
    return gamma == 0.0 ? decodeSrgb(encoded) : std::pow(encoded, static_cast<float>(1.0 / gamma));
}

} // namespace

RgbImage readPng(const std::string& path)
{
    requireReadableFile(path, "PNG image");
    Decoder decoder(path);
    if (!readHeader(decoder))
        failToRead(path, "PNG image", decoder.message[0] ? decoder.message : "it cannot be opened");
    requireDecodable(path, decoder.width, decoder.height, 18);
    const std::size_t rowBytes = std::size_t { decoder.width } * 6;
    std::vector<png_byte> bytes(rowBytes * decoder.height);
    std::vector<png_bytep> rows(decoder.height);
    for (std::size_t y = 0; y < rows.size(); ++y)
        rows[y] = bytes.data() + y * rowBytes;
    if (!readRows(decoder, rows.data()))
        failToRead(path, "PNG image", decoder.message);

    RgbImage image { static_cast<int>(decoder.width), static_cast<int>(decoder.height), {} };
    image.rgb.resize(bytes.size() / 2);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const int sample = bytes[2 * i] << 8 | bytes[2 * i + 1]; // PNG is big-endian
        image.rgb[i] = toLinear(static_cast<float>(sample) / 65535.0f, decoder.gamma);
    }
    return image;
}

} // namespace wedge::image
