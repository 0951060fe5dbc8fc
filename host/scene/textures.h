#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace wedge::scene {

/// Decodes an 8-bit image (PNG, JPEG, TGA, BMP, ...) with row 0 at the bottom. Throws Error when the file is missing,
/// not an image, or has a side of more than 32768 pixels.
Texture readTexture(const std::filesystem::path& path);

/// The textures of a scene, each file once.
class TextureSet {
public:
    /// The index of the file's texture in textures(). Throws as readTexture.
    int add(const std::filesystem::path& path);

    std::vector<Texture> take() { return std::move(textures_); }

private:
    std::vector<Texture> textures_;
    std::map<std::string, int> indices_;
};

} // namespace wedge::scene
