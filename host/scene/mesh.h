#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace wedge::scene {

/// Indices of one triangle corner; -1 = none. All others are in range.
struct MeshCorner {
    int position = 0, texcoord = -1, normal = -1;
};

/// A mesh file's triangles, in its own space.
struct Mesh {
    /// Of single precision where that tells the mesh's points apart, else as the file has them: a transform may move
    /// what is far from the origin to where single precision does.
    std::vector<glm::dvec3> positions;
    bool isSingle = true; ///< positions are of single precision
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> texcoords;
    std::vector<MeshCorner> corners; ///< 3 a triangle
    std::vector<std::uint32_t> materials, objects; ///< 1 a triangle: into `palette`, into `objectNames`
    std::vector<Material> palette; ///< the materials in use
    bool hasNameless = false; ///< some faces have no usemtl; the palette's last material, grey, is theirs
    std::vector<std::string> objectNames; ///< groups and objects (g, o) of the same name are one
    std::size_t flat = 0; ///< triangles without area: they cannot be seen, but a shape may unfold them

    std::size_t triangles() const { return corners.size() / 3; }
};

} // namespace wedge::scene
