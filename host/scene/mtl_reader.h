#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/scene.h"
#include "host/scene/textures.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// Reads a Wavefront material library: Kd, Ks, Ns, Ke and map_Kd, map_Ks, map_Ns, map_Ke. Textures that cannot be read
/// leave the plain colour and a warning, as do values out of range; what else would change the look is warned of once a
/// library. Throws Error when the file cannot be read or has no materials.
std::vector<Material> readMtl(const std::filesystem::path& path, TextureSet& textures, Warnings& warnings);

/// The same for a text. path: for messages, and where its textures are relative to.
std::vector<Material> parseMtl(
    std::string_view text, const std::filesystem::path& path, TextureSet& textures, Warnings& warnings);

/// Warns when some materials reflect more light than they get.
void warnOfEnergy(const std::vector<Material>& materials, const std::string& where, Warnings& warnings);

} // namespace wedge::scene
