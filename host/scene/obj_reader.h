#pragma once

#include <filesystem>

#include "host/scene/mesh.h"
#include "host/scene/textures.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// Reads a Wavefront OBJ file and its material libraries, or `library` in place of these where it is not empty.
/// Materials that are not found become grey, with a warning. Throws Error for whatever parseObj finds wrong and for
/// files that cannot be read; of libraries, only `library` must be readable.
Mesh readObj(const std::filesystem::path& path, TextureSet& textures, Warnings& warnings,
    const std::filesystem::path& library = {});

/// The triangles of such a file alone: without palette, and without a word about what may be wrong with them.
Mesh readObjShape(const std::filesystem::path& path);

} // namespace wedge::scene
