#include "data/generator/obj_writer.h"

#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "host/error.h"

namespace wedge::generator {

void ObjWriter::object(const std::string& name, const std::string& material)
{
    fmt::format_to(std::back_inserter(text_), "o {}\nusemtl {}\n", name, material);
}

void ObjWriter::material(const std::string& name) { fmt::format_to(std::back_inserter(text_), "usemtl {}\n", name); }

std::size_t ObjWriter::vertex(const glm::dvec3& p)
{
    fmt::format_to(std::back_inserter(text_), "v {:.6g} {:.6g} {:.6g}\n", p.x, p.y, p.z);
    normalOf_.push_back(0);
    texcoordOf_.push_back(0);
    return ++vertices_;
}

std::size_t ObjWriter::vertex(const glm::dvec3& p, const glm::dvec3& n)
{
    const std::size_t index = vertex(p);
    fmt::format_to(std::back_inserter(text_), "vn {:.6g} {:.6g} {:.6g}\n", n.x, n.y, n.z);
    normalOf_.back() = ++normals_;
    return index;
}

std::size_t ObjWriter::vertex(const glm::dvec3& p, const glm::dvec3& n, const glm::dvec2& t)
{
    const std::size_t index = vertex(p, n);
    fmt::format_to(std::back_inserter(text_), "vt {:.6g} {:.6g}\n", t.x, t.y);
    texcoordOf_.back() = ++texcoords_;
    return index;
}

std::string ObjWriter::corner(std::size_t vertex) const
{
    const std::size_t normal = normalOf_[vertex - 1], texcoord = texcoordOf_[vertex - 1];
    if (texcoord != 0)
        return fmt::format("{}/{}/{}", vertex, texcoord, normal);
    return normal == 0 ? fmt::format("{}", vertex) : fmt::format("{}//{}", vertex, normal);
}

void ObjWriter::triangle(std::size_t a, std::size_t b, std::size_t c)
{
    fmt::format_to(std::back_inserter(text_), "f {} {} {}\n", corner(a), corner(b), corner(c));
    ++triangles_;
}

void ObjWriter::quad(std::size_t a, std::size_t b, std::size_t c, std::size_t d)
{
    triangle(a, b, c);
    triangle(a, c, d);
}

void writeText(const std::filesystem::path& path, const std::string& text)
{
    std::ofstream stream(path, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream)
        throw Error("file cannot be written", path.string(), "check the folder's permissions and free space");
}

} // namespace wedge::generator
