#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "host/scene/mesh.h"
#include "host/scene/obj_elements.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// Where a face of an OBJ text stands and what it belongs to.
struct ObjFace {
    std::size_t line = 0;
    std::uint32_t material = 0, object = 0;
};

/// Whether single precision tells the points of the faces apart: what it rounds off is next to nothing of the mesh's
/// size and small against that of each face, and against how narrow it is. Otherwise the mesh lies too far from its
/// origin.
bool fitsSinglePrecision(const ObjElements& elements);

/// The triangles of the faces, of which there is one for each of elements.faceCorners; without palette. objectNames: of
/// ObjFace::object; those without a triangle are left out. file: for warnings of faces of which something is lost.
Mesh triangulated(ObjElements elements, const std::vector<ObjFace>& faces, const std::vector<std::string>& objectNames,
    const std::string& file, Warnings& warnings);

} // namespace wedge::scene
