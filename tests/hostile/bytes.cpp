#include "tests/hostile/bytes.h"

#include <stdexcept>

#include <zlib.h>

namespace wedge::hostile {
namespace {

std::string numbers(const std::vector<std::uint32_t>& values)
{
    std::string bytes;
    for (const std::uint32_t value : values) {
        bytes += little32(value);
    }
    return bytes;
}

std::string ended(const std::string& text) { return text + '\0'; }

std::string big16(unsigned value) { return { static_cast<char>(value >> 8), static_cast<char>(value) }; }

} // namespace

std::string little16(unsigned value) { return { static_cast<char>(value), static_cast<char>(value >> 8) }; }

std::string little32(std::uint32_t value) { return little16(value & 0xffff) + little16(value >> 16); }

std::string big32(std::uint32_t value) { return big16(value >> 16) + big16(value & 0xffff); }

std::string pngChunk(const std::string& type, const std::string& data)
{
    const std::string body = type + data;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big32(static_cast<std::uint32_t>(data.size())) + body + big32(static_cast<std::uint32_t>(sum));
}

std::string pngHead(std::uint32_t width, std::uint32_t height, int depth, int colour, int interlace)
{
    const std::string kind = { static_cast<char>(depth), static_cast<char>(colour), 0, 0,
        static_cast<char>(interlace) };
    return "\x89PNG\r\n\x1a\n" + pngChunk("IHDR", big32(width) + big32(height) + kind);
}

std::string deflated(const std::string& data)
{
    uLongf size = compressBound(data.size());
    std::string out(size, '\0');
    if (compress2(
            reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(data.data()), data.size(), 1)
        != Z_OK) {
        throw std::runtime_error("zlib");
    }
    return out.substr(0, size);
}

std::string exrAttribute(const std::string& name, const std::string& type, const std::string& value)
{
    return exrAttribute(name, type, value, static_cast<std::uint32_t>(value.size()));
}

std::string exrAttribute(
    const std::string& name, const std::string& type, const std::string& value, std::uint32_t claimed)
{
    return ended(name) + ended(type) + little32(claimed) + value;
}

std::string exrChannel(const std::string& name, std::uint32_t type, std::uint32_t sampling)
{
    return ended(name) + numbers({ type, 0, sampling, sampling });
}

std::string exr(const ExrParts& parts)
{
    constexpr std::uint32_t one = 0x3f800000; // 1.0f
    return "\x76\x2f\x31\x01" + little32(parts.version) + exrAttribute("channels", "chlist", ended(parts.channels))
        + exrAttribute("compression", "compression", std::string(1, static_cast<char>(parts.compression)))
        + exrAttribute("dataWindow", "box2i", numbers(parts.dataWindow))
        + exrAttribute("displayWindow", "box2i", numbers(parts.displayWindow))
        + exrAttribute("lineOrder", "lineOrder", std::string(1, '\0'))
        + exrAttribute("pixelAspectRatio", "float", little32(one))
        + exrAttribute("screenWindowCenter", "v2f", numbers({ 0, 0 }))
        + exrAttribute("screenWindowWidth", "float", little32(one)) + parts.more + ended("") + parts.body;
}

std::string hdr(const std::string& resolution, const std::string& body)
{
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n" + body;
}

std::string tga(int type, unsigned width, unsigned height, int bits, const std::string& body)
{
    return std::string { 0, 0, static_cast<char>(type) } + std::string(9, '\0') + little16(width) + little16(height)
        + static_cast<char>(bits) + '\0' + body;
}

std::string bmp(
    std::uint32_t width, std::uint32_t height, unsigned bits, std::uint32_t compression, const std::string& body)
{
    return "BM" + numbers({ 54, 0, 54, 40, width, height }) + little16(1) + little16(bits)
        + numbers({ compression, 0, 0, 0, 0, 0 }) + body;
}

std::string jpeg(unsigned width, unsigned height, const std::string& body)
{
    const std::string frame = std::string { 8 } + big16(height) + big16(width) + std::string { 1, 1, 0x11, 0 };
    return "\xff\xd8\xff\xc0" + big16(static_cast<unsigned>(frame.size() + 2)) + frame + body;
}

} // namespace wedge::hostile
