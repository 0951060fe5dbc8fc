#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/scene/mesh.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// What an OBJ text says.
struct ObjText {
    Mesh mesh; ///< without palette: its materials index materialNames, or are as many as there are names: none
    std::vector<std::string> materialNames; ///< distinct usemtl names, in order of first use
    std::vector<std::string> libraries; ///< the mtllib lines, distinct, in order
};

/// Reads the statements v, vt, vn, f, g, o, usemtl and mtllib; all others have nothing to render. Polygons become
/// triangles. Names go to the end of their line, spaces and all.
///
/// file: for messages. Throws Error with file, line and value for the first vertex or face that is wrong, and for text
/// that is not OBJ. Warns of faces of which something is lost, of those without area, and of normals and texture
/// coordinates that are not finite.
ObjText parseObj(std::string_view text, const std::string& file, Warnings& warnings);

} // namespace wedge::scene
