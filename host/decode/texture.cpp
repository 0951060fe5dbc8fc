#include "host/decode/texture.h"

#include "host/decode/bmp.h"
#include "host/decode/hdr.h"
#include "host/decode/jpeg.h"
#include "host/decode/png.h"
#include "host/decode/tga.h"

namespace wedge::decode {

namespace {

/// The name of a format that is known but not read, or an empty string.
std::string_view unreadFormat(Bytes bytes)
{
    using namespace std::string_view_literals;
    struct Signature {
        std::string_view start, name;
    };
    constexpr Signature signatures[] = { { "GIF8", "GIF" }, { "8BPS", "Photoshop" }, { "II*\0"sv, "TIFF" },
        { "MM\0*"sv, "TIFF" }, { "RIFF", "WebP" }, { "v/1\x01", "EXR" }, { "DDS ", "DDS" },
        { "\x53\x80\xF6\x34", "PIC" }, { "\xABKTX", "KTX" } };
    for (const Signature& signature : signatures) {
        if (startsWith(bytes, signature.start))
            return signature.name;
    }
    const bool netpbm = bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '7'
        && (bytes[2] == '\n' || bytes[2] == ' ' || bytes[2] == '\r' || bytes[2] == '\t' || bytes[2] == '#');
    return netpbm ? "PBM, PGM or PPM" : "";
}

} // namespace

Picture decodeTextureFor(TextureUse use, Bytes bytes, const Limits& limits)
{
    if (startsWith(bytes, "\x89PNG"))
        return decodePngFor(use, bytes, limits);
    if (startsWith(bytes, "\xff\xd8\xff"))
        return decodeJpeg(bytes, limits);
    if (startsWith(bytes, "BM"))
        return decodeBmp(bytes, limits);
    if (startsWith(bytes, "#?"))
        return decodeHdrFor(use, bytes, limits);
    const std::string unread(unreadFormat(bytes));
    if (!unread.empty())
        throw Failure(unread + " is no format that is read", "save it as PNG or JPEG");
    if (isTga(bytes))
        return decodeTga(bytes, limits);
    throw Failure(bytes.empty() ? "it is empty" : "its format is not known", "save it as PNG or JPEG");
}

Picture decodeTexture(Bytes bytes, const Limits& limits)
{
    return decodeTextureFor(TextureUse::Colours, bytes, limits);
}

} // namespace wedge::decode
