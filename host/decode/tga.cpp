#include "host/decode/tga.h"

#include <algorithm>
#include <array>

namespace wedge::decode {

namespace {

struct Header {
    unsigned idBytes, mapType, imageType, mapFirst, mapLength, mapBits;
    Size size;
    unsigned bits, descriptor;

    explicit Header(ByteReader& in)
    {
        idBytes = in.byte();
        mapType = in.byte();
        imageType = in.byte();
        mapFirst = in.u16();
        mapLength = in.u16();
        mapBits = in.byte();
        in.take(4); // where on a screen it was
        size.width = in.u16();
        size.height = in.u16();
        bits = in.byte();
        descriptor = in.byte();
    }
    bool runs() const { return imageType >= 8; }
    bool mapped() const { return imageType % 8 == 1; }
    bool grey() const { return imageType % 8 == 3; }
    unsigned mapEntryBytes() const { return (mapBits + 7) / 8; }
    /// Of each pixel, or of each colour of the map.
    unsigned attributeBits() const { return descriptor & 15; }

    bool consistent() const
    {
        const auto isColour = [](unsigned depth) { return depth == 15 || depth == 16 || depth == 24 || depth == 32; };
        if (mapType > 1 || imageType > 11 || imageType % 8 < 1 || imageType % 8 > 3)
            return false;
        if (size.width < 1 || size.height < 1 || descriptor >= 64) // two bits that once meant interleaved rows
            return false;
        if (mapType == 0 ? (mapLength != 0 || mapped()) : !isColour(mapBits))
            return false;
        if (mapped())
            return mapLength > 0 && (bits == 8 || bits == 16);
        return grey() ? bits == 8 || bits == 16 : isColour(bits);
    }
};

/// What the attribute bits of the pixels are (the specification's field 24, and what stands where there is none).
enum class Attributes { None, Alpha, Premultiplied };

/// The extension area's attributes type, where the file ends in a footer that tells of one, else by the descriptor.
Attributes attributesOf(Bytes bytes, const Header& header)
{
    constexpr std::size_t footerBytes = 26, typeAt = 494, extensionBytes = 495;
    constexpr std::string_view signature("TRUEVISION-XFILE.\0", 18);
    const Attributes stated = header.attributeBits() > 0 ? Attributes::Alpha : Attributes::None;
    if (bytes.size() < 18 + footerBytes || !startsWith(bytes.last(signature.size()), signature))
        return stated;
    const std::uint32_t at = ByteReader(bytes.last(footerBytes)).u32();
    if (at < 18 || bytes.size() < extensionBytes || at > bytes.size() - extensionBytes)
        return stated; // 0 where there is none
    ByteReader area(bytes.subspan(at));
    if (area.u16() < extensionBytes)
        return stated;
    switch (bytes[at + typeAt]) {
    case 3:
        return Attributes::Alpha;
    case 4:
        return Attributes::Premultiplied;
    default: // none, or such as are to be ignored or only kept
        return Attributes::None;
    }
}

/// The colour that was multiplied with its alpha.
std::uint32_t divided(std::uint32_t rgba)
{
    const unsigned alpha = rgba >> 24;
    if (alpha == 0)
        return rgba;
    const auto channel = [&](unsigned shift) {
        return std::min(255u, ((rgba >> shift & 255) * 255 + alpha / 2) / alpha);
    };
    return packRgba(channel(0), channel(8), channel(16), alpha);
}

/// Of 16 bits the uppermost is the alpha, if any.
std::uint32_t colour(const std::uint8_t* p, unsigned bits, Attributes attributes)
{
    const bool hasAlpha = attributes != Attributes::None;
    if (bits > 16) {
        const std::uint32_t rgba = packRgba(p[2], p[1], p[0], bits == 32 && hasAlpha ? p[3] : 255);
        return attributes == Attributes::Premultiplied ? divided(rgba) : rgba;
    }
    const unsigned value = p[0] | p[1] << 8;
    const auto channel = [&](unsigned shift) { return (value >> shift & 31) * 255 / 31; };
    return packRgba(channel(10), channel(5), channel(0), bits == 16 && hasAlpha && value < 0x8000 ? 0 : 255);
}

/// The pixels of the file in its own order.
class Pixels {
public:
    Pixels(ByteReader& in, const Header& header, Attributes attributes)
        : in_(in)
        , header_(header)
        , attributes_(attributes)
        , bytes_((header.bits + 7) / 8)
    {
        const Bytes map = in.take(std::size_t { header.mapLength } * header.mapEntryBytes());
        if (header.mapped()) {
            for (unsigned i = 0; i < header.mapLength; ++i)
                map_.push_back(
                    colour(map.data() + std::size_t { i } * header.mapEntryBytes(), header.mapBits, attributes));
        }
    }
    std::uint32_t next()
    {
        if (!header_.runs())
            return read();
        if (left_ == 0) {
            const unsigned packet = in_.byte();
            left_ = packet % 128 + 1;
            repeats_ = packet >= 128;
            if (repeats_)
                repeated_ = read();
        }
        --left_;
        return repeats_ ? repeated_ : read();
    }
    bool betweenPackets() const { return left_ == 0; }

private:
    std::uint32_t read()
    {
        const std::uint8_t* p = in_.take(bytes_).data();
        if (header_.mapped()) {
            const unsigned index = (p[0] | (bytes_ == 2 ? p[1] << 8 : 0)) - header_.mapFirst;
            if (index >= map_.size()) // also one before the first: it has wrapped around
                throw Failure("a pixel has a colour that its colour map lacks");
            return map_[index];
        }
        if (header_.grey()) {
            const bool hasAlpha = bytes_ == 2 && attributes_ != Attributes::None;
            const std::uint32_t rgba = packRgba(p[0], p[0], p[0], hasAlpha ? p[1] : 255);
            return attributes_ == Attributes::Premultiplied ? divided(rgba) : rgba;
        }
        return colour(p, header_.bits, attributes_);
    }

    ByteReader& in_;
    const Header& header_;
    Attributes attributes_;
    std::size_t bytes_;
    std::vector<std::uint32_t> map_;
    unsigned left_ = 0;
    bool repeats_ = false;
    std::uint32_t repeated_ = 0;
};

} // namespace

bool isTga(Bytes bytes)
{
    ByteReader in(bytes);
    return bytes.size() >= 18 && Header(in).consistent();
}

Picture decodeTga(Bytes bytes, const Limits& limits)
{
    ByteReader in(bytes);
    const Header header(in);
    if (!header.consistent())
        throw Failure("its header is of no TGA that is read");
    limits.admit(header.size, bytes.size());
    in.take(header.idBytes);
    Pixels pixels(in, header, attributesOf(bytes, header));
    const std::size_t need = static_cast<std::size_t>(header.size.pixels()) * ((header.bits + 7) / 8);
    if (!header.runs() && in.left() < need)
        throw Failure("it ends before the picture does");
    Picture picture(header.size);
    const bool fromTop = header.descriptor & 32, fromRight = header.descriptor & 16;
    for (int y = 0; y < header.size.height; ++y) {
        std::uint32_t* row = fromTop ? picture.rowFromTop(y) : picture.rowFromBottom(y);
        for (int x = 0; x < header.size.width; ++x)
            row[x] = pixels.next();
        if (fromRight)
            std::reverse(row, row + header.size.width);
    }
    if (!pixels.betweenPackets())
        throw Failure("a run of pixels goes beyond the picture");
    makeOpaqueIfEmpty(picture);
    return picture;
}

} // namespace wedge::decode
