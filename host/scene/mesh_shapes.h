#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "host/scene/mesh_files.h"
#include "host/scene/toml_reader.h"

namespace wedge::scene {

/// The shapes that a deforming mesh takes over time, [[mesh.shape]].
class MeshShapes {
public:
    /// Reads them from a [[mesh]]. mesh: whose triangles they must have. finish: what is done to every shape once it
    /// is read, such as smoothing. Throws Error for times out of order, files that cannot be read, and other triangles.
    MeshShapes(TableReader& table, const Mesh& mesh, MeshFiles& files, const std::function<void(Mesh&)>& finish);

    bool empty() const { return times_.empty(); }

    /// The mesh with positions and normals of that time, linear between two shapes; materials, objects and texture
    /// coordinates are its own. The mesh itself without shapes.
    Mesh at(double time, const Mesh& mesh) const;

private:
    std::vector<double> times_;
    std::vector<std::shared_ptr<const Mesh>> shapes_; ///< those of one file are one
};

} // namespace wedge::scene
