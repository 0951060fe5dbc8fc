#include "host/image/atomic_file.h"
#include "host/image/colour.h"
#include "host/image/png.h"

#include "host/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <png.h>

namespace wedge::image {

namespace {

using namespace std::string_view_literals;

/// The chunk "Software: wedge": length, type, text, and the checksum of the last two.
constexpr std::string_view software = "\0\0\0\x0etEXtSoftware\0wedge\xb7\xe2\x2a\x27"sv;
constexpr std::size_t softwareAt = 8 + 25; // behind the signature and the header, which are of one size in all files

constexpr std::string_view inputsKey = "Inputs\0"sv;
constexpr std::size_t mostInputs = 1024; ///< bytes of text

/// A PNG's checksum.
std::uint32_t checksum(std::string_view bytes)
{
    std::uint32_t crc = 0xffffffffu;
    for (const unsigned char byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
        }
    }
    return ~crc;
}

std::string bigEndian(std::uint32_t number)
{
    std::string bytes;
    for (const int shift : { 24, 16, 8, 0 }) {
        bytes += static_cast<char>(number >> shift & 0xffu);
    }
    return bytes;
}

/// The chunk that says what a picture was made from.
std::string inputsChunk(const std::string& inputs)
{
    if (inputs.empty()) {
        return "";
    }
    const std::string text = std::string(inputsKey) + inputs.substr(0, mostInputs), typed = "tEXt" + text;
    return bigEndian(static_cast<std::uint32_t>(text.size())) + typed + bigEndian(checksum(typed));
}

std::vector<std::uint8_t> quantize(const RgbImage& image, const Look& look)
{
    const float scale = std::exp2(look.exposureStops);
    std::vector<std::uint8_t> bytes(image.rgb.size());
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        const std::array<float, 3> shown =
            applyView(look.view, { image.rgb[i] * scale, image.rgb[i + 1] * scale, image.rgb[i + 2] * scale });
        std::ranges::transform(shown, bytes.begin() + static_cast<std::ptrdiff_t>(i),
            [](float value) { return static_cast<std::uint8_t>(std::lround(255.0f * encodeSrgb(value))); });
    }
    return bytes;
}

} // namespace

void writePng(const std::string& path, const RgbImage& image, const Look& look, const std::string& inputs)
{
    requireConsistent(image);
    AtomicFile file(path);
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    const std::vector<std::uint8_t> bytes = quantize(image, look);
    std::string encoded(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
    png_alloc_size_t size = encoded.size();
    if (!png_image_write_to_memory(&png, encoded.data(), &size, 0, bytes.data(), 0, nullptr))
        throw Error(std::string("cannot encode PNG image (") + png.message + ")", path, "write a smaller image or EXR");
    file.write(std::string_view(encoded).substr(0, softwareAt));
    file.write(software);
    file.write(inputsChunk(inputs));
    file.write(std::string_view(encoded).substr(softwareAt, size - softwareAt));
    file.commit();
}

bool isOwnPng(const std::string& path)
{
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) { // opening a pipe would wait for its writer
        return false;
    }
    std::string start(softwareAt + software.size(), '\0');
    std::ifstream(path, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
    return start.starts_with("\x89PNG"sv) && start.ends_with(software);
}

std::string pngInputs(const std::string& path)
{
    if (!isOwnPng(path)) {
        return "";
    }
    constexpr std::size_t start = softwareAt + software.size();
    std::string bytes(start + 8 + inputsKey.size() + mostInputs, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    const std::string_view chunk = std::string_view(bytes).substr(std::min(start, bytes.size()));
    if (chunk.size() < 8 || chunk.substr(4, 4) != "tEXt" || !chunk.substr(8).starts_with(inputsKey)) {
        return "";
    }
    std::size_t length = 0;
    for (const unsigned char c : chunk.substr(0, 4)) {
        length = length << 8 | c;
    }
    return std::string(chunk.substr(8, length).substr(inputsKey.size()));
}

} // namespace wedge::image
