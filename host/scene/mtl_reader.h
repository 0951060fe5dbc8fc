#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/scene/scene.h"
#include "host/scene/textures.h"

namespace wedge::scene {

/// Reads a Wavefront material library: Kd, Ks, Ns, Ke and map_Kd, map_Ks, map_Ns, map_Ke; other entries are ignored.
/// Textures that cannot be read leave the plain colour and a warning, as do values out of range.
/// Throws Error when the file cannot be read.
std::vector<Material> readMtl(
    const std::filesystem::path& path, TextureSet& textures, std::vector<std::string>& warnings);

/// A warning when some materials reflect more light than they get, or an empty string.
std::string energyWarning(const std::vector<Material>& materials, const std::string& where);

} // namespace wedge::scene
