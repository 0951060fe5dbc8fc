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

void writePng(const std::string& path, const RgbImage& image, const Look& look)
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

} // namespace wedge::image
