#include "host/decode/png.h"

#include "host/decode/code_points.h"
#include "host/decode/srgb.h"

#include <cmath>
#include <csetjmp>
#include <cstring>

#include <png.h>

namespace wedge::decode {

// libpng leaves by longjmp, which skips destructors: what must be freed lives here, and the functions that call libpng
// hold nothing of their own.
struct PngReader::Decoder {
    Bytes bytes;
    std::size_t at = 0;
    png_structp png = nullptr;
    png_infop info = nullptr;
    char message[200] = "";
    std::uint32_t width = 0, height = 0;
    double gamma = 0.0;
    Primaries primaries = rec709;
    std::array<png_byte, 4> codePoints {}; ///< of cICP
    bool hasCodePoints = false;
    std::optional<ColourMatrix> matrix;
    int passes = 1;
    std::size_t rowBytes = 0;

    explicit Decoder(Bytes b)
        : bytes(b)
    {
    }
    ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    bool readHeader();
    void readColourSpace();
    void applyCodePoints();
    bool start(PngSamples samples);
    bool readRow(png_bytep row);
    bool finish();
    [[noreturn]] void fail() const { throw Failure(message[0] != '\0' ? message : "it cannot be decoded"); }

    static void leave(png_structp png, png_const_charp message)
    {
        char* to = static_cast<Decoder*>(png_get_error_ptr(png))->message;
        std::strncpy(to, message, sizeof(Decoder::message) - 1);
        png_longjmp(png, 1);
    }
    static void ignore(png_structp, png_const_charp) { }
    static void read(png_structp png, png_bytep to, std::size_t count)
    {
        auto* decoder = static_cast<Decoder*>(png_get_io_ptr(png));
        if (count > decoder->bytes.size() - decoder->at)
            png_error(png, "it ends before the picture does");
        std::memcpy(to, decoder->bytes.data() + decoder->at, count);
        decoder->at += count;
    }
};

namespace {

/// Chunks that the pixels do not depend on; text and profiles can be packed and large, so none of them is unpacked.
constexpr png_byte skipped[] = "bKGD\0eXIf\0hIST\0iCCP\0iTXt\0oFFs\0pCAL\0pHYs\0sBIT\0sCAL\0sPLT\0tEXt\0tIME\0zTXt";

/// Four code points of ITU-T H.273, which libpng knows since 1.6.45 alone.
constexpr png_byte codePointChunk[] = "cICP";

} // namespace

bool PngReader::Decoder::readHeader()
{
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, leave, ignore);
    info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr)
        return false;
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_read_fn(png, this, read);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX); // Limits has its own
    png_set_chunk_malloc_max(png, 1 << 20);
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, skipped, sizeof skipped / 5);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, codePointChunk, 1);
    png_read_info(png, info);
    width = png_get_image_width(png, info);
    height = png_get_image_height(png, info);
    readColourSpace();
    return true;
}

/// Called where libpng may leave.
void PngReader::Decoder::readColourSpace()
{
    png_unknown_chunkp kept = nullptr;
    const int count = png_get_unknown_chunks(png, info, &kept);
    for (int i = 0; i < count; ++i) {
        if (std::memcmp(kept[i].name, codePointChunk, 4) != 0 || (kept[i].location & PNG_AFTER_IDAT) != 0)
            continue;
        if (kept[i].size != codePoints.size())
            png_error(png, "its cICP chunk has not four bytes");
        std::memcpy(codePoints.data(), kept[i].data, codePoints.size());
        hasCodePoints = true;
    }
    int intent = 0;
    if (hasCodePoints || png_get_sRGB(png, info, &intent))
        return;
    double stated = 0.0;
    if (png_get_gAMA(png, info, &stated) && stated > 0.0 && std::abs(stated - 1.0 / 2.2) > 0.01)
        gamma = stated;
    Primaries p;
    if (png_get_cHRM(
            png, info, &p.white.x, &p.white.y, &p.red.x, &p.red.y, &p.green.x, &p.green.y, &p.blue.x, &p.blue.y))
        primaries = p;
}

void PngReader::Decoder::applyCodePoints()
{
    const CodePoints space(codePoints);
    primaries = space.primaries;
    gamma = space.gamma;
}

bool PngReader::Decoder::start(PngSamples samples)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    if (samples == PngSamples::Rgb16) {
        png_set_expand_16(png);
        png_set_strip_alpha(png);
    } else if (samples == PngSamples::Rgba16) {
        png_set_expand_16(png);
        png_set_add_alpha(png, 0xffff, PNG_FILLER_AFTER);
    } else {
        png_set_expand(png);
        png_set_strip_16(png);
        png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
    }
    png_set_gray_to_rgb(png);
    passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    rowBytes = png_get_rowbytes(png, info);
    return true;
}

bool PngReader::Decoder::readRow(png_bytep row)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_read_row(png, row, nullptr);
    return true;
}

bool PngReader::Decoder::finish()
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_read_end(png, nullptr);
    return true;
}

PngReader::PngReader(Bytes bytes)
    : decoder_(std::make_unique<Decoder>(bytes))
{
    if (bytes.empty())
        throw Failure("it is empty");
    if (!decoder_->readHeader())
        decoder_->fail();
    if (decoder_->hasCodePoints)
        decoder_->applyCodePoints();
    decoder_->matrix = matrixToRec709(decoder_->primaries);
}

PngReader::~PngReader() = default;

Size PngReader::size() const { return { static_cast<int>(decoder_->width), static_cast<int>(decoder_->height) }; }

double PngReader::gamma() const { return decoder_->gamma; }

const std::optional<ColourMatrix>& PngReader::matrix() const { return decoder_->matrix; }

std::vector<float> PngReader::linearValues() const
{
    std::vector<float> values(1 << 16);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float encoded = static_cast<float>(i) / 65535.0f;
        values[i] = gamma() == 0.0 ? decodeSrgb(encoded) : std::pow(encoded, static_cast<float>(1.0 / gamma()));
    }
    return values;
}

void PngReader::readRows(PngSamples samples, const std::function<void(const Row&)>& row)
{
    if (!decoder_->start(samples))
        decoder_->fail();
    const std::size_t bytesPerPixel = samples == PngSamples::Rgba8 ? 4 : samples == PngSamples::Rgb16 ? 6 : 8;
    if (decoder_->rowBytes != bytesPerPixel * decoder_->width)
        throw Failure("its pixels are of a kind that is not read");
    std::vector<png_byte> buffer(decoder_->rowBytes);
    const int height = size().height;
    const bool interlaced = decoder_->passes > 1;
    for (int pass = 0; pass < decoder_->passes; ++pass) {
        const int firstColumn = interlaced ? PNG_PASS_START_COL(pass) : 0;
        const int columnStep = interlaced ? 1 << PNG_PASS_COL_SHIFT(pass) : 1;
        const int firstRow = interlaced ? PNG_PASS_START_ROW(pass) : 0;
        const int rowStep = interlaced ? 1 << PNG_PASS_ROW_SHIFT(pass) : 1;
        for (int y = 0; y < height; ++y) {
            if (!decoder_->readRow(buffer.data())) // leaves pixels of other passes as they are
                decoder_->fail();
            if (y % rowStep == firstRow)
                row({ y, firstColumn, columnStep, buffer.data() });
        }
    }
    if (!decoder_->finish())
        decoder_->fail();
}

} // namespace wedge::decode
