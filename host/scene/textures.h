#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "host/decode/picture.h"
#include "host/error.h"
#include "host/scene/scene.h"

namespace wedge::scene {

/// Whether a picture has directions of a normal map rather than heights: in nine of ten texels blue is the largest
/// channel, and the vector 2c - 1 of the channels c, 0 to 1, has a length of 0.8 to 1.2.
bool looksLikeNormals(const Texture& texture);

/// The textures of a scene, each file once (twice where it is used for colours and for numbers, and says that its
/// colours are not sRGB). What they may take together is bounded: 16 times what one image may have,
/// and beyond what one may have 64 pixels a byte of their files, so that many small files do not add up to gigabytes.
/// Those that fail after their size was let through count, too, and their bytes do not.
class TextureSet {
public:
    /// maxPixels: of one image.
    explicit TextureSet(std::int64_t maxPixels)
        : maxPixels_(maxPixels)
    {
    }

    /// The index in take() of a file's texture: PNG, JPEG, BMP, TGA or Radiance HDR. Throws Error when it is missing,
    /// no regular file, no image, damaged, or beyond the limits; for the same file again without reading it again, but
    /// where its texels are others for another use.
    int add(const std::filesystem::path& path, decode::TextureUse use = decode::TextureUse::Colours);

    const Texture& at(int index) const { return textures_[static_cast<std::size_t>(index)]; }

    std::vector<Texture> take() { return std::move(textures_); }

private:
    /// Of each use, where it is known.
    using Known = std::array<std::optional<std::variant<int, Error>>, 2>;
    void read(const std::filesystem::path& path, decode::TextureUse use, Known& known);
    decode::Picture decoded(const std::filesystem::path& path, decode::TextureUse use);

    std::int64_t maxPixels_;
    std::int64_t pixels_ = 0,
                 bytes_ = 0; ///< of all textures, also such as failed, and of the files of those that did not
    std::vector<Texture> textures_;
    std::map<std::string, Known> known_; ///< by path, without links
};

} // namespace wedge::scene
