#include "host/image/atomic_file.h"
#include "host/image/colour.h"
#include "host/image/png.h"

#include "host/error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <png.h>

namespace wedge::image {

namespace {

std::vector<std::uint8_t> quantize(const RgbImage& image, float exposureStops)
{
    const float scale = std::exp2(exposureStops);
    std::vector<std::uint8_t> bytes(image.rgb.size());
    std::transform(image.rgb.begin(), image.rgb.end(), bytes.begin(), [scale](float value) {
        return static_cast<std::uint8_t>(std::lround(255.0f * encodeSrgb(clipToDisplay(value * scale))));
    });
    return bytes;
}

} // namespace

void writePng(const std::string& path, const RgbImage& image, float exposureStops)
{
    requireConsistent(image);
    AtomicFile file(path);
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    const std::vector<std::uint8_t> bytes = quantize(image, exposureStops);
    std::string encoded(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
    png_alloc_size_t size = encoded.size();
    if (!png_image_write_to_memory(&png, encoded.data(), &size, 0, bytes.data(), 0, nullptr))
        throw Error(std::string("cannot encode PNG image (") + png.message + ")", path, "write a smaller image or EXR");
    file.write(std::string_view(encoded).substr(0, size));
    file.commit();
}

} // namespace wedge::image
