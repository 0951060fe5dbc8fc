#include "host/scene/obj_elements.h"

#include <istream>
#include <iterator>
#include <streambuf>

#include <fmt/format.h>

// Compiled here, since the library of the package is of one precision, and its version is what the header says.
#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

namespace wedge::scene {
namespace {

/// Reads text where it lies.
class TextBuffer : public std::streambuf {
public:
    explicit TextBuffer(std::string_view text)
    {
        char* begin = const_cast<char*>(text.data()); // the interface's; nothing is written
        setg(begin, begin, begin + text.size());
    }
};

ObjElements& elementsOf(void* user) { return *static_cast<ObjElements*>(user); }

void addPosition(void* user, double x, double y, double z, double) { elementsOf(user).positions.emplace_back(x, y, z); }

void addNormal(void* user, double x, double y, double z) { elementsOf(user).normals.emplace_back(x, y, z); }

void addTexcoord(void* user, double u, double v, double) { elementsOf(user).texcoords.emplace_back(u, v); }

/// Counted from 0; the file's is counted from 1, or from -1 backwards, and 0 where there is none.
int indexFrom(int stated, std::size_t count) { return stated >= 0 ? stated - 1 : static_cast<int>(count) + stated; }

void addFace(void* user, tinyobj::index_t* indices, int count)
{
    ObjElements& out = elementsOf(user);
    for (int i = 0; i < count; ++i)
        out.corners.push_back({ indexFrom(indices[i].vertex_index, out.positions.size()),
            indexFrom(indices[i].texcoord_index, out.texcoords.size()),
            indexFrom(indices[i].normal_index, out.normals.size()) });
    out.faceCorners.push_back(static_cast<std::uint32_t>(count));
}

} // namespace

void ObjElementReader::begin(std::string_view keyword)
{
    begin_ = lines_.size();
    corners_ = 0;
    lines_ += keyword;
}

void ObjElementReader::number(std::string_view word, double value)
{
    // Powers of ten and rows of digits overflow in the library where their product is a number.
    constexpr std::size_t mostDigits = 24;
    if (word.starts_with('+'))
        word.remove_prefix(1);
    lines_ += ' ';
    if (word.size() <= mostDigits && word.find_first_of("eE") == std::string_view::npos)
        lines_ += word;
    else
        fmt::format_to(std::back_inserter(lines_), "{}", value);
}

void ObjElementReader::corner(std::string_view word)
{
    word.remove_suffix(word.size() - word.find_last_not_of('/') - 1); // of an index that is left out
    lines_ += ' ';
    lines_ += word;
    ++corners_;
}

void ObjElementReader::end()
{
    const std::string_view keyword = std::string_view(lines_).substr(begin_, 2);
    if (keyword == "f ") {
        ++counts_.faces;
        counts_.corners += corners_;
    } else {
        ++(keyword == "vn" ? counts_.normals : keyword == "vt" ? counts_.texcoords : counts_.positions);
    }
    lines_ += '\n';
}

ObjCounts ObjElementReader::read()
{
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = addPosition;
    callbacks.normal_cb = addNormal;
    callbacks.texcoord_cb = addTexcoord;
    callbacks.index_cb = addFace;
    TextBuffer buffer(lines_);
    std::istream stream(&buffer);
    tinyobj::LoadObjWithCallback(stream, callbacks, &elements_);
    lines_.clear();
    return { elements_.positions.size(), elements_.texcoords.size(), elements_.normals.size(),
        elements_.faceCorners.size(), elements_.corners.size() };
}

} // namespace wedge::scene
