#pragma once

#include <cstddef>
#include <string>

#include "host/scene/mesh.h"

namespace wedge::scene {

/// Counts what a scene's meshes take before they are built, so that a small file cannot ask for more than there is.
class GeometryLimit {
public:
    /// Triangles of a scene, all copies and shapes counted.
    static constexpr std::size_t mostTriangles = std::size_t { 1 } << 26;

    /// copies: of the mesh, in the scene or while it is built. nameBytes: of what all copies together put before the
    /// name of an object.
    /// where: begins the message of the Error ("scene file a.toml:3:8").
    void add(const Mesh& mesh, std::size_t copies, std::size_t nameBytes, const std::string& where);

private:
    std::size_t triangles_ = 0;
    double bytes_ = 0.0;
};

} // namespace wedge::scene
