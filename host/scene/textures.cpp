#include "host/scene/textures.h"

#include <algorithm>
#include <new>

#include <fmt/format.h>

#include "host/decode/texture.h"
#include "host/file.h"

namespace wedge::scene {
namespace {

constexpr std::uintmax_t maxTextureFile = std::uintmax_t { 256 } << 20; // read whole

} // namespace

bool looksLikeNormals(const Texture& texture)
{
    const auto isNormal = [](std::uint32_t rgba) {
        const std::uint32_t r = rgba & 255u, g = (rgba >> 8) & 255u, b = (rgba >> 16) & 255u;
        const auto coordinate = [](std::uint32_t byte) { return static_cast<float>(byte) / 127.5f - 1.0f; };
        const float length = glm::length(glm::vec3(coordinate(r), coordinate(g), coordinate(b)));
        return b > r && b > g && length > 0.8f && length < 1.2f;
    };
    const auto count = std::ranges::count_if(texture.rgba, isNormal);
    return static_cast<std::size_t>(count) * 10 >= texture.rgba.size() * 9;
}

decode::Picture TextureSet::decoded(const std::filesystem::path& path, decode::TextureUse use)
{
    constexpr std::int64_t sceneFactor = 16, pixelsPerByte = 64;
    const std::string bytes = readFile(path, "texture file", maxTextureFile);
    const auto fileBytes = static_cast<std::int64_t>(bytes.size());
    decode::Limits limits;
    limits.pixels = maxPixels_;
    limits.unquestioned = std::max(limits.unquestioned, maxPixels_ / 8); // who allows more, trusts the files
    const std::int64_t allowed =
        std::min(sceneFactor * maxPixels_, std::max(maxPixels_, pixelsPerByte * (bytes_ + fileBytes)));
    limits.together = std::max<std::int64_t>(0, allowed - pixels_);
    limits.admitted = &pixels_;
    limits.remedy = "scale the image down, or raise --max-texture-pixels";
    try {
        decode::Picture picture = decode::decodeTextureFor(use, decode::bytesOf(bytes), limits);
        bytes_ += fileBytes;
        return picture;
    } catch (const std::bad_alloc&) {
        throw Error("texture file cannot be decoded (host memory is exhausted)", path.string(), "scale the image down");
    } catch (const decode::Failure& failure) {
        throw Error(
            fmt::format("texture file cannot be decoded ({})", failure.what()), path.string(), failure.remedy());
    }
}

void TextureSet::read(const std::filesystem::path& path, decode::TextureUse use, Known& known)
{
    const auto tell = [&](bool ofAllUses, const std::variant<int, Error>& answer) {
        for (std::size_t i = 0; i < known.size(); ++i)
            if (ofAllUses || i == static_cast<std::size_t>(use))
                known[i] = answer;
    };
    try {
        decode::Picture picture = decoded(path, use);
        const bool hasAlpha = std::ranges::any_of(picture.rgba, [](std::uint32_t t) { return t >> 24 != 255; });
        textures_.push_back(
            { path.string(), picture.size.width, picture.size.height, std::move(picture.rgba), hasAlpha });
        tell(picture.sameForAllUses, static_cast<int>(textures_.size()) - 1);
    } catch (const Error& error) {
        tell(true, error);
    }
}

int TextureSet::add(const std::filesystem::path& path, decode::TextureUse use)
{
    std::error_code code;
    const std::filesystem::path canonical = std::filesystem::canonical(path, code);
    Known& known = known_[(code ? path.lexically_normal() : canonical).string()];
    auto& answer = known[static_cast<std::size_t>(use)];
    if (!answer)
        read(path, use, known);
    if (const Error* error = std::get_if<Error>(&*answer))
        throw Error(*error);
    return std::get<int>(*answer);
}

} // namespace wedge::scene
