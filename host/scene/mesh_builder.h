#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "host/scene/mesh.h"
#include "host/scene/scene.h"

namespace wedge::scene {

/// A mesh whose vertices are shared where position, normal and texture coordinate are.
struct IndexedMesh {
    std::vector<glm::dvec3> positions;
    bool isSingle = true; ///< as Mesh::isSingle
    double leastHeight = 0.0; ///< of the triangles with an area, over their longest edge
    std::vector<glm::vec3> normals; ///< a zero normal = use the geometric one
    std::vector<glm::vec2> texcoords;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> materials, objects; ///< a triangle, into the scene's materials and `objectNames`
    std::vector<std::string> objectNames;
    /// Empty unless the mesh deforms while the shutter is open.
    std::vector<glm::dvec3> positionsAtClose;
    std::vector<glm::vec3> normalsAtClose;
};

/// Where a copy of a mesh is.
struct Placement {
    glm::dmat4 atOpen { 1.0 }, atClose { 1.0 }; ///< the shutter
};

/// materialBase: index in the scene of the mesh's first material. atClose: the same triangles when the shutter closes,
/// or nullptr where they do not deform.
IndexedMesh indexMesh(const Mesh& mesh, std::uint32_t materialBase, const Mesh* atClose = nullptr);

/// Adds a transformed copy to the scene, its objects under new ids, named "<prefix><object>". A mirroring transform
/// swaps the order of corners, so that the outside stays outside. material: the scene's material for all triangles,
/// or -1 for each its own. Both determinants of the placement have one sign. Where the copy or one before it moves, the
/// geometry's vectors at close grow with it. where: begins the message of the Error for a copy with coordinates beyond
/// 1e12.
void addInstance(Geometry& geometry, const IndexedMesh& mesh, const Placement& placement, int material,
    const std::string& prefix, const std::string& where);

} // namespace wedge::scene
