#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "host/scene/scene.h"
#include "host/scene/textures.h"

namespace wedge::scene {

/// Indices of one triangle corner; -1 = none. All others are in range.
struct MeshCorner {
    int position = 0, texcoord = -1, normal = -1;
};

/// A mesh file's triangles, in its own space.
struct Mesh {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> texcoords;
    std::vector<MeshCorner> corners; ///< 3 a triangle
    std::vector<std::uint32_t> materials, objects; ///< 1 a triangle: into `palette`, into `objectNames`
    std::vector<Material> palette; ///< the materials in use
    bool hasNameless = false; ///< some faces have no usemtl; the palette's last material, grey, is theirs
    std::vector<std::string> objectNames; ///< groups and objects (g, o) of the same name are one
};

/// Reads a Wavefront OBJ file and its material libraries, or `library` in place of these where it is not empty;
/// polygons become triangles. Materials that are not found become grey, with a warning. Throws Error for whatever
/// scanObj finds wrong and for files that cannot be read; of libraries, only `library` must be readable.
Mesh readObj(const std::filesystem::path& path, TextureSet& textures, std::vector<std::string>& warnings,
    const std::filesystem::path& library = {});

} // namespace wedge::scene
