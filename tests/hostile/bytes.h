// Files of a few bytes, built from what their formats are made of.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace wedge::hostile {

/// Numbers as bytes, the lowest first or last.
std::string little16(unsigned value);
std::string little32(std::uint32_t value);
std::string big32(std::uint32_t value);

/// A chunk of a PNG with its length and checksum.
std::string pngChunk(const std::string& type, const std::string& data);
/// The beginning of a PNG: signature and header.
std::string pngHead(std::uint32_t width, std::uint32_t height, int depth, int colour, int interlace = 0);
/// Data as PNG keeps it.
std::string deflated(const std::string& data);

/// An attribute of an EXR, of its own size or of another that it claims.
std::string exrAttribute(const std::string& name, const std::string& type, const std::string& value);
std::string exrAttribute(
    const std::string& name, const std::string& type, const std::string& value, std::uint32_t claimed);
/// A channel in the list of channels. type: 0 UINT, 1 HALF, 2 FLOAT.
std::string exrChannel(const std::string& name, std::uint32_t type = 1, std::uint32_t sampling = 1);

/// What an EXR's header is made of.
struct ExrParts {
    std::uint32_t version = 2; ///< and flags
    std::string channels = exrChannel("B") + exrChannel("G") + exrChannel("R");
    unsigned char compression = 0;
    std::vector<std::uint32_t> dataWindow = { 0, 0, 1, 1 }, displayWindow = { 0, 0, 1, 1 };
    std::string more; ///< attributes
    std::string body; ///< behind the header
};
std::string exr(const ExrParts& parts);

/// A Radiance HDR: its resolution as text, and what comes behind.
std::string hdr(const std::string& resolution, const std::string& body);

/// Headers of a TGA, a BMP of 24 bits and a JPEG of one component.
std::string tga(int type, unsigned width, unsigned height, int bits, const std::string& body);
std::string bmp(
    std::uint32_t width, std::uint32_t height, unsigned bits, std::uint32_t compression, const std::string& body);
std::string jpeg(unsigned width, unsigned height, const std::string& body);

} // namespace wedge::hostile
