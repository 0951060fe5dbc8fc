#include "host/scene/obj_parser.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "host/error.h"
#include "host/scene/name_list.h"
#include "host/scene/obj_elements.h"
#include "host/scene/obj_faces.h"
#include "host/scene/paths.h"
#include "host/scene/statements.h"

namespace wedge::scene {
namespace {

constexpr std::size_t maxCorners = 10'000;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Statements that have nothing to render: lines, points, curves, smoothing groups and how they are shown.
constexpr std::array<std::string_view, 29> withoutEffect { "l", "p", "s", "mg", "vp", "deg", "bmat", "step", "cstype",
    "curv", "curv2", "parm", "trim", "hole", "scrv", "sp", "end", "con", "bevel", "c_interp", "d_interp", "lod",
    "shadow_obj", "trace_obj", "ctech", "stech", "usemap", "maplib", "texmap" };

/// Walks the text; one call of a member reads one statement. Vertices and faces are checked here, so that a message
/// names line and value, and go to tinyobjloader as lines that it cannot misread.
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
        while (statements_.next()) {
            statement(statements_.word());
            if (elements_.isFull())
                readElements();
        }
        readElements();
        checkFaces();
        warnOfWhole();
        ObjText out;
        out.mesh = triangulated(elements_.take(), faces_, objects_.take(), file_, warnings_);
        out.materialNames = materials_.take();
        out.libraries = libraries_.take();
        std::vector<std::uint32_t>& used = out.mesh.materials;
        std::replace(used.begin(), used.end(), none, static_cast<std::uint32_t>(out.materialNames.size()));
        std::vector<std::string>& names = out.mesh.objectNames;
        std::replace(names.begin(), names.end(), std::string(), std::string("unnamed"));
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

    void statement(std::string_view keyword)
    {
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
            useMaterial(unquoted(statements_.rest()));
        else if (keyword == "mtllib")
            addLibrary(statements_.rest());
        else if (!keyword.empty() && keyword.front() != '#')
            otherStatement(keyword);
    }

    /// Of what is known in capitals, of what has no effect, and of what nobody knows, which is told once.
    void otherStatement(std::string_view keyword)
    {
        const std::string lower = lowerCase(std::string(keyword.substr(0, longestKeyword)));
        if (lower != keyword.substr(0, longestKeyword) && isUsed(lower))
            statement(lower);
        else if (std::ranges::count(withoutEffect, lower) == 0 && unknown_++ == 0)
            firstUnknown_ = { statements_.line(), lower };
    }

    static bool isUsed(std::string_view lower)
    {
        constexpr std::array<std::string_view, 8> used { "v", "vn", "vt", "f", "g", "o", "usemtl", "mtllib" };
        return std::ranges::count(used, lower) > 0;
    }

    void vertex()
    {
        elements_.begin("v");
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = statements_.word();
            if (word.empty() || word.front() == '#')
                fail("vertex has fewer than 3 coordinates", std::to_string(axis), "export the mesh again");
            double value = 0.0;
            const NumberKind kind = parseNumber(word, value);
            if (kind == NumberKind::NotFinite)
                fail("vertex coordinate is not a finite number", word, "repair the mesh");
            if (kind == NumberKind::Unreadable)
                fail("vertex coordinate is not a number", word, "repair the mesh");
            elements_.number(word, value);
        }
        elements_.end();
        if (hasColour() && colours_++ == 0)
            firstColour_ = statements_.line();
    }

    /// Whether three numbers follow a vertex' coordinates; one is a weight, which polygons do not have.
    bool hasColour()
    {
        for (int channel = 0; channel < 3; ++channel) {
            double value = 0.0;
            if (parseNumber(statements_.word(), value) == NumberKind::Unreadable)
                return false;
        }
        return true;
    }

    void normal()
    {
        elements_.begin("vn");
        bool good = true;
        for (int axis = 0; axis < 3; ++axis)
            good = appendNumber(axis == 0 ? "vn" : "", statements_.word()) && good;
        badNormals_ += !good;
        if (!good)
            putZeros("vn", 3);
        elements_.end();
    }

    void texcoord()
    {
        elements_.begin("vt");
        bool good = appendNumber("vt", statements_.word());
        const std::string_view second = statements_.word(); // optional
        if (!second.empty() && second.front() != '#')
            good = appendNumber("", second) && good;
        badTexcoords_ += !good;
        if (!good)
            putZeros("vt", 2);
        elements_.end();
    }

    /// In place of what a statement says.
    void putZeros(const char* keyword, int count)
    {
        elements_.drop();
        elements_.begin(keyword);
        for (int i = 0; i < count; ++i)
            elements_.number("0", 0.0);
    }

    /// keyword: of a statement that needs a number here, else empty. Returns false for what is no finite number.
    bool appendNumber(const char* keyword, std::string_view word)
    {
        if (word.empty() && *keyword != '\0')
            fail("line has no numbers", keyword, "export the mesh again");
        double value = 0.0;
        const bool good = parseNumber(word, value) == NumberKind::Good;
        elements_.number(good ? word : "0", value);
        return good;
    }

    void beginObject(std::string_view name)
    {
        objectName_ = name;
        object_ = none;
    }

    void useMaterial(std::string_view name)
    {
        if (name.empty())
            warn("faces without material", statements_.line(), "usemtl names no material, the one before goes on");
        else
            material_ = materials_.add(name);
    }

    void addLibrary(std::string_view line)
    {
        if (!line.empty())
            libraries_.add(line);
    }

    void face()
    {
        elements_.begin("f");
        std::size_t corners = 0;
        for (std::string_view word = statements_.word(); !word.empty() && word.front() != '#';
             word = statements_.word()) {
            checkCorner(word);
            elements_.corner(word);
            ++corners;
        }
        if (corners > maxCorners)
            fail("face has too many corners", std::to_string(corners), "triangulate the mesh");
        if (corners < 3) {
            elements_.drop();
            if (++droppedFaces_ == 1)
                firstDropped_ = statements_.line();
            return;
        }
        elements_.end();
        if (object_ == none)
            object_ = objects_.add(objectName_);
        faces_.push_back({ statements_.line(), material_, object_ });
    }

    void checkCorner(std::string_view word) const
    {
        const ObjCounts& all = elements_.counts();
        const std::size_t counts[] = { all.positions, all.texcoords, all.normals };
        const char* const names[] = { "vertex", "texture coordinate", "normal" };
        std::string_view rest = word;
        for (std::size_t part = 0; part < 3; ++part) {
            const std::size_t slash = std::min(rest.find('/'), rest.size());
            const std::string_view number = rest.substr(0, slash);
            if (!number.empty() || part == 0)
                checkIndex(word, number, counts[part], names[part]);
            if (slash == rest.size())
                return;
            rest.remove_prefix(slash + 1);
        }
        fail("face corner has more than 3 indices", word, "write it as vertex/texture/normal");
    }

    void checkIndex(std::string_view word, std::string_view number, std::size_t count, const char* name) const
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
    }

    /// Looks whether all came back: versions of the library differ.
    void readElements()
    {
        const ObjCounts read = elements_.read(), &all = elements_.counts();
        if (read == all)
            return;
        throw Error(fmt::format("mesh file {}:{}: tinyobjloader does not read all that stands before this line", file_,
                        statements_.line()),
            fmt::format("{} of {} vertices, {} of {} faces", read.positions, all.positions, read.faces, all.faces),
            "export the mesh again, and report this with the file");
    }

    void checkFaces() const
    {
        if (elements_.counts().faces == 0 && droppedFaces_ > 0)
            throw Error(fmt::format("mesh file {}:{}: no face has 3 corners", file_, firstDropped_),
                fmt::format("{} face(s) of fewer", droppedFaces_), "export the mesh again");
        if (elements_.counts().faces == 0)
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
        if (colours_ > 0)
            warn("colours of vertices", firstColour_,
                fmt::format("{} vertices have colours, which have no effect; use materials and textures", colours_));
        if (unknown_ > 0)
            warn("statements of mesh files without effect", firstUnknown_.first,
                fmt::format("statement '{}' is not read here and has no effect; it is the first of {}",
                    firstUnknown_.second, unknown_));
    }

    static constexpr std::size_t longestKeyword = 16;

    StatementReader statements_;
    const std::string& file_;
    Warnings& warnings_;
    ObjElementReader elements_;
    std::vector<ObjFace> faces_;
    NameList objects_, materials_, libraries_;
    std::string objectName_;
    std::uint32_t object_ = none, material_ = none; ///< of the faces that follow; an object is known from its first on
    std::size_t droppedFaces_ = 0, firstDropped_ = 0;
    std::size_t badNormals_ = 0, badTexcoords_ = 0, colours_ = 0, firstColour_ = 0;
    std::size_t unknown_ = 0;
    std::pair<std::size_t, std::string> firstUnknown_; ///< its line, and what it is
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
