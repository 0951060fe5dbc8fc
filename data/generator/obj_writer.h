#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::generator {

/// Builds the text of an OBJ file. Numbers have 6 significant digits.
class ObjWriter {
public:
    /// Begins an object with one material; the triangles that follow are its.
    void object(const std::string& name, const std::string& material);
    /// Of the triangles that follow, which stay in the object.
    void material(const std::string& name);

    /// Adds a vertex without or with a normal and a texture coordinate; returns what triangle() takes.
    std::size_t vertex(const glm::dvec3& position);
    std::size_t vertex(const glm::dvec3& position, const glm::dvec3& normal);
    std::size_t vertex(const glm::dvec3& position, const glm::dvec3& normal, const glm::dvec2& texcoord);

    /// Corners counter-clockwise seen from outside.
    void triangle(std::size_t a, std::size_t b, std::size_t c);
    /// Two triangles, split along a-c.
    void quad(std::size_t a, std::size_t b, std::size_t c, std::size_t d);

    std::size_t triangles() const { return triangles_; }
    const std::string& text() const { return text_; }

private:
    std::string corner(std::size_t vertex) const;

    std::string text_;
    std::size_t vertices_ = 0, triangles_ = 0;
    std::size_t normals_ = 0, texcoords_ = 0;
    std::vector<std::size_t> normalOf_, texcoordOf_; ///< 0 = none, else the 1-based one of each vertex
};

/// Writes a file whole. Throws Error when it cannot.
void writeText(const std::filesystem::path& path, const std::string& text);

} // namespace wedge::generator
