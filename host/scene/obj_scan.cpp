#include "host/scene/obj_scan.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "host/error.h"

namespace wedge::scene {
namespace {

constexpr std::size_t maxCorners = 10'000; // tinyobjloader's triangulation takes quadratic time

enum class Number { Good, NotFinite, Unreadable };

bool isSpace(char c) { return c == ' ' || c == '\t'; }

Number parseNumber(std::string_view token)
{
    if (!token.empty() && token.front() == '+')
        token.remove_prefix(1);
    double value = 0.0;
    const auto [end, code] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (code == std::errc::result_out_of_range) {
        const std::size_t exponent = token.find_first_of("eE");
        const bool tiny = exponent != std::string_view::npos && token.substr(exponent + 1).starts_with('-');
        return tiny ? Number::Good : Number::NotFinite;
    }
    if (code != std::errc {} || end != token.data() + token.size())
        return Number::Unreadable;
    const bool fits = std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
    return fits ? Number::Good : Number::NotFinite; // also false for NaN
}

/// Walks the text's lines; one call of a member checks one statement.
class Scanner {
public:
    Scanner(std::string& text, const std::string& file)
        : text_(text)
        , file_(file)
    {
    }

    ObjScan run()
    {
        std::size_t begin = 0;
        while (begin < text_.size()) {
            std::size_t end = begin;
            std::size_t extraLines = 0;
            for (; end < text_.size() && text_[end] != '\n' && text_[end] != '\r'; ++end)
                extraLines += joinContinuedLine(end);
            statement(begin, end);
            line_ += 1 + extraLines;
            const bool crlf = end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n';
            begin = end + (crlf ? 2 : 1);
        }
        return std::move(scan_);
    }

private:
    [[noreturn]] void fail(const std::string& what, std::string_view value, const std::string& remedy) const
    {
        throw Error(fmt::format("mesh file {}:{}: {}", file_, line_, what), fmt::format("'{}'", value), remedy);
    }

    /// A backslash before a line end becomes spaces, line end included; returns the number of line ends removed.
    std::size_t joinContinuedLine(std::size_t at)
    {
        if (text_[at] != '\\' || at + 1 >= text_.size())
            return 0;
        std::size_t length = 0;
        if (text_[at + 1] == '\n')
            length = 2;
        else if (text_[at + 1] == '\r')
            length = at + 2 < text_.size() && text_[at + 2] == '\n' ? 3 : 2;
        std::fill_n(text_.begin() + static_cast<std::ptrdiff_t>(at), length, ' ');
        return length > 0 ? 1 : 0;
    }

    /// The next token of [at, end), or an empty one.
    std::string_view next(std::size_t& at, std::size_t end) const
    {
        while (at < end && isSpace(text_[at]))
            ++at;
        const std::size_t begin = at;
        while (at < end && !isSpace(text_[at]))
            ++at;
        return std::string_view(text_).substr(begin, at - begin);
    }

    void statement(std::size_t begin, std::size_t end)
    {
        std::size_t at = begin;
        const std::string_view keyword = next(at, end);
        if (keyword.empty() || keyword.front() == '#')
            return;
        if (keyword == "v")
            vertex(at, end);
        else if (keyword == "vn")
            scan_.badNormals += attribute(at, end, 3, normals_);
        else if (keyword == "vt")
            scan_.badTexcoords += attribute(at, end, 1, texcoords_);
        else if (keyword == "f")
            face(at, end);
        else if (keyword == "usemtl")
            useMaterial(at, end);
        else if (keyword != "g" && keyword != "o") {
            if (keyword == "mtllib")
                library(at, end);
            text_[begin] = '#'; // lines, points, tags and everything unknown: nothing to render
        }
    }

    void vertex(std::size_t at, std::size_t end)
    {
        ++vertices_;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view token = next(at, end);
            if (token.empty() || token.front() == '#')
                fail("vertex has fewer than 3 coordinates", std::to_string(axis), "export the mesh again");
            const Number kind = parseNumber(token);
            if (kind == Number::NotFinite)
                fail("vertex coordinate is not a finite number", token, "repair the mesh");
            if (kind == Number::Unreadable)
                fail("vertex coordinate is not a number", token, "repair the mesh");
        }
    }

    /// Counts a normal or texture coordinate; one that cannot be read is blanked to zeros. Returns 1 for such a one.
    std::size_t attribute(std::size_t at, std::size_t end, int needed, std::size_t& count)
    {
        ++count;
        if (at == end)
            fail("line has no numbers", needed == 3 ? "vn" : "vt", "export the mesh again");
        const std::size_t begin = at;
        bool good = true;
        for (int i = 0; i < needed; ++i)
            good = good && parseNumber(next(at, end)) == Number::Good;
        if (needed == 1) { // v is optional, but must be a number where it is given
            const std::string_view second = next(at, end);
            good = good && (second.empty() || second.front() == '#' || parseNumber(second) == Number::Good);
        }
        if (!good) // tinyobjloader reads missing numbers as 0
            std::fill(text_.begin() + static_cast<std::ptrdiff_t>(begin),
                text_.begin() + static_cast<std::ptrdiff_t>(end), ' ');
        return good ? 0 : 1;
    }

    void face(std::size_t at, std::size_t end)
    {
        std::size_t corners = 0;
        for (;;) {
            const std::string_view token = next(at, end);
            if (token.empty())
                break;
            const std::size_t begin = static_cast<std::size_t>(token.data() - text_.data());
            if (token.front() == '#') {
                std::fill(text_.begin() + static_cast<std::ptrdiff_t>(begin),
                    text_.begin() + static_cast<std::ptrdiff_t>(end), ' ');
                break;
            }
            corner(token);
            for (std::size_t i = begin + token.size(); i > begin && text_[i - 1] == '/'; --i)
                text_[i - 1] = ' '; // "7/" and "7//" mean "7"
            ++corners;
        }
        if (corners > maxCorners)
            fail("face has too many corners", std::to_string(corners), "triangulate the mesh");
        if (corners >= 3) {
            ++scan_.faces;
        } else if (++scan_.droppedFaces == 1) {
            scan_.firstDroppedLine = line_;
        }
    }

    void corner(std::string_view token)
    {
        const std::size_t counts[] = { vertices_, texcoords_, normals_ };
        const char* const names[] = { "vertex", "texture coordinate", "normal" };
        std::string_view rest = token;
        for (std::size_t part = 0; part < 3; ++part) {
            const std::size_t slash = std::min(rest.find('/'), rest.size());
            const std::string_view number = rest.substr(0, slash);
            if (!number.empty() || part == 0)
                index(token, number, counts[part], names[part]);
            if (slash == rest.size())
                return;
            rest.remove_prefix(slash + 1);
        }
        fail("face corner has more than 3 indices", token, "write it as vertex/texture/normal");
    }

    void index(std::string_view token, std::string_view number, std::size_t count, const char* name) const
    {
        if (number.starts_with('+'))
            number.remove_prefix(1);
        long long value = 0;
        const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), value);
        if (code == std::errc::invalid_argument || end != number.data() + number.size())
            fail("face corner is not an index", token, "write it as vertex/texture/normal");
        const long long limit = static_cast<long long>(count);
        if (code != std::errc {} || value == 0 || value > limit || value < -limit)
            fail(fmt::format("face has a wrong {} index", name), token,
                count == 0 ? fmt::format("define a {} before it", name)
                           : fmt::format("use 1 to {} or -{} to -1, what is defined before this line", count, count));
    }

    void useMaterial(std::size_t at, std::size_t end)
    {
        while (at < end && isSpace(text_[at]))
            ++at;
        while (end > at && isSpace(text_[end - 1]))
            --end;
        addOnce(scan_.materials, text_.substr(at, end - at));
        for (std::size_t i = at; i < end; ++i) {
            if (isSpace(text_[i]))
                text_[i] = objNameSpace;
        }
    }

    void library(std::size_t at, std::size_t end)
    {
        while (at < end && isSpace(text_[at]))
            ++at;
        while (end > at && isSpace(text_[end - 1]))
            --end;
        addOnce(scan_.libraries, text_.substr(at, end - at));
    }

    static void addOnce(std::vector<std::string>& names, const std::string& name)
    {
        if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
            names.push_back(name);
    }

    std::string& text_;
    const std::string& file_;
    ObjScan scan_;
    std::size_t line_ = 1;
    std::size_t vertices_ = 0, normals_ = 0, texcoords_ = 0;
};

} // namespace

ObjScan scanObj(std::string& text, const std::string& file)
{
    if (text.find('\0') != std::string::npos)
        throw Error("mesh file " + file + " holds binary data", "a byte of value 0",
            "export the mesh as a Wavefront OBJ text file");
    ObjScan scan = Scanner(text, file).run();
    if (scan.faces == 0 && scan.droppedFaces > 0)
        throw Error(fmt::format("mesh file {}:{}: no face has 3 corners", file, scan.firstDroppedLine),
            fmt::format("{} face(s) of fewer", scan.droppedFaces), "export the mesh again");
    if (scan.faces == 0)
        throw Error(fmt::format("mesh file {} has no faces", file),
            text.empty() ? "it is empty" : "no line begins with f",
            "export the mesh as a Wavefront OBJ file with faces");
    return scan;
}

} // namespace wedge::scene
