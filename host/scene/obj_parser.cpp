#include "host/scene/obj_parser.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>

#include "host/error.h"
#include "host/scene/name_list.h"
#include "host/scene/orientation.h"
#include "host/scene/statements.h"
#include "host/scene/triangulate.h"

namespace wedge::scene {
namespace {

constexpr std::size_t maxCorners = 10'000;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Walks the text; one call of a member reads one statement.
class Parser {
public:
    Parser(std::string_view text, const std::string& file, Warnings& warnings)
        : statements_(text)
        , file_(file)
        , warnings_(warnings)
    {
    }

    ObjText run()
    {
        while (statements_.next())
            statement();
        checkFaces();
        warnOfWhole();
        ObjText out;
        out.materialNames = materials_.take();
        out.libraries = libraries_.take();
        std::replace(
            mesh_.materials.begin(), mesh_.materials.end(), none, static_cast<std::uint32_t>(out.materialNames.size()));
        mesh_.objectNames = objects_.take();
        std::replace(mesh_.objectNames.begin(), mesh_.objectNames.end(), std::string(), std::string("unnamed"));
        out.mesh = std::move(mesh_);
        return out;
    }

private:
    [[noreturn]] void fail(const std::string& what, std::string_view value, const std::string& remedy) const
    {
        throw Error(
            fmt::format("mesh file {}:{}: {}", file_, statements_.line(), what), fmt::format("'{}'", value), remedy);
    }

    void warn(std::string_view kind, std::size_t line, const std::string& text)
    {
        warnings_.add(kind, fmt::format("mesh file {}:{}: {}", file_, line, text));
    }

    void statement()
    {
        const std::string_view keyword = statements_.word();
        if (keyword == "v")
            vertex();
        else if (keyword == "vn")
            normal();
        else if (keyword == "vt")
            texcoord();
        else if (keyword == "f")
            face();
        else if (keyword == "g" || keyword == "o")
            beginObject(statements_.rest());
        else if (keyword == "usemtl")
            useMaterial(statements_.rest());
        else if (keyword == "mtllib")
            addLibrary(statements_.rest());
    }

    void vertex()
    {
        glm::vec3 position;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = statements_.word();
            if (word.empty() || word.front() == '#')
                fail("vertex has fewer than 3 coordinates", std::to_string(axis), "export the mesh again");
            const NumberKind kind = parseNumber(word, position[axis]);
            if (kind == NumberKind::NotFinite)
                fail("vertex coordinate is not a finite number", word, "repair the mesh");
            if (kind == NumberKind::Unreadable)
                fail("vertex coordinate is not a number", word, "repair the mesh");
        }
        mesh_.positions.push_back(position);
    }

    void normal()
    {
        glm::vec3 normal;
        bool good = true;
        for (int axis = 0; axis < 3; ++axis)
            good = readOrZero(axis == 0 ? "vn" : "", normal[axis]) && good;
        badNormals_ += !good;
        mesh_.normals.push_back(good ? normal : glm::vec3(0.0f));
    }

    void texcoord()
    {
        glm::vec2 at(0.0f);
        bool good = readOrZero("vt", at.x);
        const std::string_view second = statements_.word(); // optional
        if (!second.empty() && second.front() != '#')
            good = parseNumber(second, at.y) == NumberKind::Good && good;
        badTexcoords_ += !good;
        mesh_.texcoords.push_back(good ? at : glm::vec2(0.0f));
    }

    /// keyword: of a statement that needs a number here, else empty. Returns false for what is no finite number.
    bool readOrZero(const char* keyword, float& value)
    {
        const std::string_view word = statements_.word();
        if (word.empty() && *keyword != '\0')
            fail("line has no numbers", keyword, "export the mesh again");
        return parseNumber(word, value) == NumberKind::Good;
    }

    void beginObject(std::string_view name)
    {
        objectName_ = name;
        object_ = none;
    }

    void useMaterial(std::string_view name)
    {
        if (!name.empty())
            material_ = materials_.add(name);
    }

    void addLibrary(std::string_view line)
    {
        if (!line.empty())
            libraries_.add(line);
    }

    void face()
    {
        face_.clear();
        for (std::string_view word = statements_.word(); !word.empty() && word.front() != '#';
             word = statements_.word())
            face_.push_back(corner(word));
        if (face_.size() > maxCorners)
            fail("face has too many corners", std::to_string(face_.size()), "triangulate the mesh");
        if (face_.size() < 3) {
            if (++droppedFaces_ == 1)
                firstDropped_ = statements_.line();
            return;
        }
        ++faces_;
        if (face_.size() == 3)
            triangle();
        else
            polygon();
    }

    const glm::vec3& position(std::size_t corner) const
    {
        return mesh_.positions[static_cast<std::size_t>(face_[corner].position)];
    }

    /// One without area stays: a shape may unfold it.
    void triangle()
    {
        if (onOneLine(position(0), position(1), position(2))) {
            ++mesh_.flat;
            warnOfFlat();
        }
        addTriangle({ 0, 1, 2 });
    }

    void polygon()
    {
        outline_.clear();
        for (std::size_t i = 0; i < face_.size(); ++i)
            outline_.push_back(position(i));
        const Split split = triangulator_.split(outline_);
        if (split == Split::NoArea)
            warnOfFlat();
        else if (split == Split::Crossed)
            warn("faces that cross themselves", statements_.line(),
                fmt::format(
                    "face of {} corners crosses itself or is folded; parts may be missing or doubled", face_.size()));
        for (const auto& triangle : triangulator_.triangles())
            addTriangle(triangle);
    }

    void warnOfFlat()
    {
        warn("faces without area", statements_.line(),
            fmt::format("face of {} corners has no area and cannot be seen", face_.size()));
    }

    void addTriangle(const std::array<std::uint32_t, 3>& corners)
    {
        if (object_ == none)
            object_ = objects_.add(objectName_);
        for (const std::uint32_t corner : corners)
            mesh_.corners.push_back(face_[corner]);
        mesh_.materials.push_back(material_);
        mesh_.objects.push_back(object_);
    }

    MeshCorner corner(std::string_view word) const
    {
        const std::size_t counts[] = { mesh_.positions.size(), mesh_.texcoords.size(), mesh_.normals.size() };
        const char* const names[] = { "vertex", "texture coordinate", "normal" };
        int indices[] = { -1, -1, -1 };
        std::string_view rest = word;
        for (std::size_t part = 0; part < 3; ++part) {
            const std::size_t slash = std::min(rest.find('/'), rest.size());
            const std::string_view number = rest.substr(0, slash);
            if (!number.empty() || part == 0)
                indices[part] = index(word, number, counts[part], names[part]);
            if (slash == rest.size())
                return { indices[0], indices[1], indices[2] };
            rest.remove_prefix(slash + 1);
        }
        fail("face corner has more than 3 indices", word, "write it as vertex/texture/normal");
    }

    /// Counted from 0.
    int index(std::string_view word, std::string_view number, std::size_t count, const char* name) const
    {
        if (number.starts_with('+'))
            number.remove_prefix(1);
        long long value = 0;
        const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), value);
        if (code == std::errc::invalid_argument || end != number.data() + number.size())
            fail("face corner is not an index", word, "write it as vertex/texture/normal");
        const long long limit = static_cast<long long>(count);
        if (code != std::errc {} || value == 0 || value > limit || value < -limit)
            fail(fmt::format("face has a wrong {} index", name), word,
                count == 0 ? fmt::format("define a {} before it", name)
                           : fmt::format("use 1 to {} or -{} to -1, what is defined before this line", count, count));
        return static_cast<int>(value > 0 ? value - 1 : limit + value);
    }

    void checkFaces() const
    {
        if (faces_ == 0 && droppedFaces_ > 0)
            throw Error(fmt::format("mesh file {}:{}: no face has 3 corners", file_, firstDropped_),
                fmt::format("{} face(s) of fewer", droppedFaces_), "export the mesh again");
        if (faces_ == 0)
            throw Error(fmt::format("mesh file {} has no faces", file_),
                statements_.line() == 0 ? "it is empty" : "no line begins with f",
                "export the mesh as a Wavefront OBJ file with faces");
    }

    void warnOfWhole()
    {
        const std::string where = "mesh file " + file_;
        if (droppedFaces_ > 0)
            warn("faces of fewer than 3 corners", firstDropped_,
                fmt::format("{} face(s) of fewer than 3 corners left out", droppedFaces_));
        if (badNormals_ > 0)
            warnings_.add("normals",
                fmt::format(
                    "{}: {} normal(s) are no finite numbers, geometric normals are used there", where, badNormals_));
        if (badTexcoords_ > 0)
            warnings_.add("texture coordinates",
                fmt::format("{}: {} texture coordinate(s) are no finite numbers, 0 is used", where, badTexcoords_));
    }

    StatementReader statements_;
    const std::string& file_;
    Warnings& warnings_;
    Mesh mesh_;
    NameList objects_, materials_, libraries_;
    std::string objectName_;
    std::uint32_t object_ = none, material_ = none; ///< of the faces that follow; an object is known from its first on
    Triangulator triangulator_;
    std::vector<MeshCorner> face_;
    std::vector<glm::vec3> outline_;
    std::size_t faces_ = 0, droppedFaces_ = 0, firstDropped_ = 0;
    std::size_t badNormals_ = 0, badTexcoords_ = 0;
};

} // namespace

ObjText parseObj(std::string_view text, const std::string& file, Warnings& warnings)
{
    if (text.find('\0') != std::string_view::npos)
        throw Error("mesh file " + file + " holds binary data", "a byte of value 0",
            "export the mesh as a Wavefront OBJ text file");
    return Parser(text, file, warnings).run();
}

} // namespace wedge::scene
