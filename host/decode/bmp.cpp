#include "host/decode/bmp.h"

#include "host/decode/bmp_runs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <string>

namespace wedge::decode {

namespace {

enum Compression : std::uint32_t { Plain = 0, Runs8 = 1, Runs4 = 2, Masks = 3, AlphaMasks = 6 };

struct Header {
    std::size_t dataAt = 0;
    std::uint32_t bytes = 0; // of this header, which tells its version
    Size size;
    bool fromTop = false;
    unsigned bits = 0;
    std::uint32_t compression = Plain;
    std::uint32_t colours = 0; // of the palette, 0: as many as there can be
    std::array<std::uint32_t, 4> masks {}; // red, green, blue, alpha

    bool runs() const { return compression == Runs8 || compression == Runs4; }
    bool mapped() const { return bits <= 8; }
};

void readOldSize(ByteReader& in, Header& header)
{
    header.size = { in.u16(), in.u16() };
    in.take(2); // planes
    header.bits = in.u16();
}

void readSize(ByteReader& in, Header& header)
{
    const auto width = static_cast<std::int32_t>(in.u32());
    const auto height = static_cast<std::int32_t>(in.u32());
    if (height == std::numeric_limits<std::int32_t>::min())
        throw Failure("its height is out of range");
    header.fromTop = height < 0;
    header.size = { width, height < 0 ? -height : height };
    in.take(2); // planes
    header.bits = in.u16();
    header.compression = in.u32();
    in.take(12); // bytes of the pixels, pixels a metre
    header.colours = in.u32();
    in.take(4); // colours that matter
}

void readMasks(ByteReader& in, Header& header)
{
    const bool own = header.compression == Masks || header.compression == AlphaMasks;
    const bool inHeader = header.bytes >= 52 && header.bytes != 64;
    if (own || inHeader) {
        const std::size_t count = inHeader ? (header.bytes >= 56 ? 4 : 3) : (header.compression == AlphaMasks ? 4 : 3);
        for (std::size_t i = 0; i < count; ++i)
            header.masks[i] = in.u32();
    }
    if (own)
        return;
    if (header.bits == 16)
        header.masks = { 0x7c00, 0x3e0, 0x1f, 0 };
    else
        header.masks = { 0xff0000, 0xff00, 0xff, 0xff000000 };
}

void check(const Header& h)
{
    const bool masked = h.compression == Masks || h.compression == AlphaMasks;
    const bool known = h.compression == Plain
        ? h.bits == 1 || h.bits == 4 || h.bits == 8 || h.bits == 16 || h.bits == 24 || h.bits == 32
        : h.compression == Runs8 ? h.bits == 8
        : h.compression == Runs4 ? h.bits == 4
                                 : masked && (h.bits == 16 || h.bits == 32) && h.bytes != 64;
    if (!known)
        throw Failure("its pixels are of a kind (" + std::to_string(h.bits) + " bits, compression "
                + std::to_string(h.compression) + ") that is not read",
            "save it as PNG or JPEG");
    if (h.runs() && h.fromTop)
        throw Failure("it has runs of pixels from the top, which only go from the bottom");
}

Header readHeader(ByteReader& in)
{
    Header header;
    in.take(10); // "BM", bytes of the file, reserved
    header.dataAt = in.u32();
    header.bytes = in.u32();
    constexpr std::array<std::uint32_t, 7> versions = { 12, 40, 52, 56, 64, 108, 124 };
    if (std::find(versions.begin(), versions.end(), header.bytes) == versions.end())
        throw Failure("its header of " + std::to_string(header.bytes) + " bytes is of a kind that is not read",
            "save it as PNG or JPEG");
    header.bytes == 12 ? readOldSize(in, header) : readSize(in, header);
    check(header);
    const std::size_t end = 14 + std::size_t { header.bytes };
    if (!header.mapped())
        readMasks(in, header);
    if (in.position() < end)
        in.take(end - in.position());
    return header;
}

std::vector<std::uint32_t> readPalette(ByteReader& in, const Header& header)
{
    const std::size_t entry = header.bytes == 12 ? 3 : 4;
    const std::size_t most = std::size_t { 1 } << header.bits;
    const std::size_t stated = header.colours == 0 ? most : std::min<std::size_t>(header.colours, most);
    if (header.dataAt < in.position())
        throw Failure("its pixels begin inside its header");
    std::vector<std::uint32_t> palette(std::min(stated, (header.dataAt - in.position()) / entry));
    for (std::uint32_t& colour : palette) {
        const Bytes p = in.take(entry);
        colour = packRgba(p[2], p[1], p[0]);
    }
    return palette;
}

/// One channel of pixels with masks, as 8 bits.
class MaskedChannel {
public:
    explicit MaskedChannel(std::uint32_t mask)
        : mask_(mask)
        , shift_(mask == 0 ? 0 : std::countr_zero(mask))
        , bits_(std::popcount(mask))
    {
        if (mask != 0 && (mask >> shift_ & ((mask >> shift_) + 1)) != 0)
            throw Failure("one of its masks has a gap", "save it as PNG or JPEG");
    }
    unsigned of(std::uint32_t pixel) const
    {
        std::uint32_t value = (pixel & mask_) >> shift_;
        if (bits_ >= 8)
            return value >> (bits_ - 8);
        // Its bits over and over, so that all ones become 255.
        value <<= 8 - bits_;
        std::uint32_t filled = value;
        for (int has = bits_; has > 0 && has < 8; has += bits_)
            filled |= value >> has;
        return filled;
    }

private:
    std::uint32_t mask_;
    int shift_, bits_;
};

class MaskedPixels {
public:
    explicit MaskedPixels(const Header& header)
        : red_(header.masks[0])
        , green_(header.masks[1])
        , blue_(header.masks[2])
        , alpha_(header.masks[3])
        , opaque_(header.masks[3] == 0)
    {
        if (std::count(header.masks.begin(), header.masks.begin() + 3, 0u) != 0)
            throw Failure("it has no mask for one of its colours");
    }
    std::uint32_t colour(std::uint32_t pixel) const
    {
        return packRgba(red_.of(pixel), green_.of(pixel), blue_.of(pixel), opaque_ ? 255 : alpha_.of(pixel));
    }

private:
    MaskedChannel red_, green_, blue_, alpha_;
    bool opaque_;
};

void decodeMappedRow(
    const std::uint8_t* in, const Header& header, std::span<const std::uint32_t> palette, std::span<std::uint32_t> row)
{
    const unsigned perByte = 8 / header.bits;
    for (std::size_t x = 0; x < row.size(); ++x) {
        const unsigned shift = 8 - header.bits - header.bits * static_cast<unsigned>(x % perByte);
        const unsigned index = in[x / perByte] >> shift & ((1u << header.bits) - 1);
        if (index >= palette.size())
            throw Failure("a pixel has a colour that its palette lacks");
        row[x] = palette[index];
    }
}

void decodeRow(const std::uint8_t* in, unsigned bytes, const MaskedPixels& masks, std::span<std::uint32_t> row)
{
    for (std::uint32_t& pixel : row) {
        if (bytes == 3) {
            pixel = packRgba(in[2], in[1], in[0]);
        } else {
            std::uint32_t value = in[0] | std::uint32_t { in[1] } << 8;
            if (bytes == 4)
                value |= std::uint32_t { in[2] } << 16 | std::uint32_t { in[3] } << 24;
            pixel = masks.colour(value);
        }
        in += bytes;
    }
}

} // namespace

Picture decodeBmp(Bytes bytes, const Limits& limits)
{
    ByteReader in(bytes);
    const Header header = readHeader(in);
    limits.admit(header.size, bytes.size());
    const std::vector<std::uint32_t> palette = header.mapped() ? readPalette(in, header) : std::vector<std::uint32_t>();
    if (header.dataAt < in.position())
        throw Failure("its pixels begin inside its header");
    in.take(header.dataAt - in.position());
    const std::size_t width = static_cast<std::size_t>(header.size.width);
    const std::size_t stride = (width * header.bits + 31) / 32 * 4;
    if (!header.runs() && in.left() / stride < static_cast<std::size_t>(header.size.height))
        throw Failure("it ends before the picture does");
    if (header.mapped() && palette.empty())
        throw Failure("it has no palette");
    Picture picture(header.size);
    if (header.runs()) {
        std::fill(picture.rgba.begin(), picture.rgba.end(), palette[0]);
        decodeBmpRuns(in, header.bits, palette, picture);
        return picture;
    }
    std::optional<MaskedPixels> masks;
    if (!header.mapped())
        masks.emplace(header);
    for (int y = 0; y < header.size.height; ++y) {
        const std::uint8_t* data = in.take(stride).data();
        const std::span row(header.fromTop ? picture.rowFromTop(y) : picture.rowFromBottom(y), width);
        if (header.mapped())
            decodeMappedRow(data, header, palette, row);
        else
            decodeRow(data, header.bits / 8, *masks, row);
    }
    if (header.bits == 32 && header.compression == Plain)
        makeOpaqueIfEmpty(picture);
    return picture;
}

} // namespace wedge::decode
