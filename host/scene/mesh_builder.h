#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "host/scene/obj_reader.h"
#include "host/scene/scene.h"

namespace wedge::scene {

/// A mesh whose vertices are shared where position, normal and texture coordinate are.
struct IndexedMesh {
    std::vector<glm::vec3> positions, normals; ///< a zero normal = use the geometric one
    std::vector<glm::vec2> texcoords;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> materials, objects; ///< a triangle, into the scene's materials and `objectNames`
    std::vector<std::string> objectNames;
};

/// materialBase: index in the scene of the mesh's first material.
IndexedMesh indexMesh(const Mesh& mesh, std::uint32_t materialBase);

/// Adds a transformed copy to the scene, its objects under new ids, named "<prefix><object>". A mirroring transform
/// swaps the order of corners, so that the outside stays outside. material: the scene's material for all triangles,
/// or -1 for each its own. where: begins the message of the Error for a copy with coordinates beyond 1e12.
void addInstance(Geometry& geometry, const IndexedMesh& mesh, const glm::dmat4& transform, int material,
    const std::string& prefix, const std::string& where);

} // namespace wedge::scene
