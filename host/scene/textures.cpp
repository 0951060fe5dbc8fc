#include "host/scene/textures.h"

#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <stb/stb_image.h>

#include "host/error.h"
#include "host/scene/paths.h"

namespace wedge::scene {
namespace {

constexpr int maxTextureSide = 32768;
constexpr std::uintmax_t maxTextureFile = std::uintmax_t { 1 } << 30;

} // namespace

Texture readTexture(const std::filesystem::path& path)
{
    const std::string bytes = readFile(path, "texture file", maxTextureFile);
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    Texture texture;
    texture.path = path.string();
    int channels = 0;
    if (stbi_info_from_memory(data, size, &texture.width, &texture.height, &channels) == 0)
        throw Error("texture file cannot be decoded", fmt::format("{} ({})", path.string(), stbi_failure_reason()),
            "save it as PNG or JPEG");
    if (texture.width < 1 || texture.height < 1 || texture.width > maxTextureSide || texture.height > maxTextureSide)
        throw Error(fmt::format("texture file {} has a side outside 1 to {} pixels", path.string(), maxTextureSide),
            fmt::format("{}x{}", texture.width, texture.height), "scale the image down");
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, size, &texture.width, &texture.height, &channels, 4), stbi_image_free);
    if (pixels == nullptr)
        throw Error("texture file cannot be decoded", fmt::format("{} ({})", path.string(), stbi_failure_reason()),
            "save it as PNG or JPEG");
    const std::size_t width = static_cast<std::size_t>(texture.width);
    const std::size_t height = static_cast<std::size_t>(texture.height);
    texture.rgba.resize(width * height);
    for (std::size_t row = 0; row < height; ++row) { // image files begin at the top
        const stbi_uc* source = pixels.get() + (height - 1 - row) * width * 4;
        for (std::size_t x = 0; x < width; ++x) {
            const stbi_uc* p = source + 4 * x;
            texture.rgba[row * width + x] =
                p[0] | std::uint32_t { p[1] } << 8 | std::uint32_t { p[2] } << 16 | std::uint32_t { p[3] } << 24;
        }
    }
    return texture;
}

int TextureSet::add(const std::filesystem::path& path)
{
    const std::string key = path.lexically_normal().string();
    const auto known = indices_.find(key);
    if (known != indices_.end())
        return known->second;
    textures_.push_back(readTexture(path));
    const int index = static_cast<int>(textures_.size()) - 1;
    indices_.emplace(key, index);
    return index;
}

} // namespace wedge::scene
