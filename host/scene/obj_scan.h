#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace wedge::scene {

/// What a first look at an OBJ text found.
struct ObjScan {
    std::vector<std::string> libraries; ///< the mtllib lines' file names, in order
    std::vector<std::string> materials; ///< distinct usemtl names, in order of first use
    std::size_t faces = 0; ///< of at least 3 corners
    std::size_t droppedFaces = 0, firstDroppedLine = 0; ///< faces of fewer corners
    std::size_t badNormals = 0, badTexcoords = 0; ///< not finite or unreadable; read as zeros
};

/// In material names inside the text this stands for a space, so that they are one token to tinyobjloader.
constexpr char objNameSpace = '\x01';

/// Checks all vertices and faces of an OBJ text, line by line, and blanks what tinyobjloader 2.0rc10 would misread:
/// it takes unreadable numbers for 0, accepts indices out of range, drops what follows a space in a material name,
/// stops at comments behind faces, knows no continued lines, and reads only the first file of an mtllib line.
/// text: the file's contents, changed in place, its length and line structure kept. file: for messages.
/// Throws Error with file, line and value for the first vertex or face that is wrong, and for text that is not OBJ.
ObjScan scanObj(std::string& text, const std::string& file);

} // namespace wedge::scene
