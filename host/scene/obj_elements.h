#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "host/scene/mesh.h"

namespace wedge::scene {

/// Vertices and faces of an OBJ text.
struct ObjElements {
    std::vector<glm::dvec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::dvec2> texcoords;
    std::vector<MeshCorner> corners; ///< of all faces, one after the other
    std::vector<std::uint32_t> faceCorners; ///< how many each face has
};

/// How many there are.
struct ObjCounts {
    std::size_t positions = 0, texcoords = 0, normals = 0, faces = 0, corners = 0;
    bool operator==(const ObjCounts&) const = default;
};

/// Hands statements of vertices and faces, word by word, to tinyobjloader, as lines that no version of it misreads.
/// Words are checked before they come here: numbers are numbers, and indices are in range.
class ObjElementReader {
public:
    void begin(std::string_view keyword);
    /// A number of the statement: value is what the word stands for.
    void number(std::string_view word, double value);
    void corner(std::string_view word);
    void end();
    /// Takes back what was said since begin().
    void drop() { lines_.resize(begin_); }

    /// Of all statements that were ended.
    const ObjCounts& counts() const { return counts_; }

    bool isFull() const { return lines_.size() >= fullBlock; }
    /// Reads what is there. Returns what is read by now, which are counts() if the library lost nothing.
    ObjCounts read();

    /// What was read.
    ObjElements take() { return std::move(elements_); }

private:
    static constexpr std::size_t fullBlock = std::size_t { 1 } << 20; ///< bytes

    std::string lines_; ///< that wait for read()
    std::size_t begin_ = 0; ///< of the statement in lines_
    std::size_t corners_ = 0; ///< of the statement
    ObjCounts counts_;
    ObjElements elements_;
};

} // namespace wedge::scene
