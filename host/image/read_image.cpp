#include "host/image/read_image.h"

#include "host/image/exr.h"
#include "host/image/input_checks.h"
#include "host/image/png.h"

#include "host/error.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <stb/stb_image.h>

namespace wedge::image {

namespace {

RgbImage readHdr(const std::string& path)
{
    requireReadableFile(path, "HDR image");
    if (!stbi_is_hdr(path.c_str()))
        failToRead(path, "HDR image", "it is not Radiance HDR");
    int width = 0;
    int height = 0;
    int channels = 0;
    if (!stbi_info(path.c_str(), &width, &height, &channels))
        failToRead(path, "HDR image", stbi_failure_reason());
    requireDecodable(path, width, height, 12);
    const std::unique_ptr<float, decltype(&stbi_image_free)> data(
        stbi_loadf(path.c_str(), &width, &height, &channels, 3), stbi_image_free);
    if (!data)
        failToRead(path, "HDR image", stbi_failure_reason());
    const std::size_t count = static_cast<std::size_t>(width) * height * 3;
    return { width, height, std::vector<float>(data.get(), data.get() + count) };
}

} // namespace

RgbImage readImage(const std::string& path)
{
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
        [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    if (extension == ".exr")
        return beauty(readExr(path), path);
    if (extension == ".png")
        return readPng(path);
    if (extension == ".hdr")
        return readHdr(path);
    throw Error("image file of unknown format", path, "use .exr, .png or .hdr");
}

} // namespace wedge::image
