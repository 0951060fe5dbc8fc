#include "host/scene/obj_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "host/scene/extent.h"
#include "host/scene/name_list.h"
#include "host/scene/orientation.h"
#include "host/scene/single_precision.h"
#include "host/scene/triangulate.h"

namespace wedge::scene {
namespace {

/// Farther from the origin than so many times its size, a mesh has lost more than 1e-5 of it to single precision.
constexpr double farInSizes = 128.0;
/// And a face smaller than this part of its distance has lost more than a hundredth of it.
constexpr double leastFace = 1.0 / (1 << 17);
/// Of all area this part may be of faces that are so narrow: exact meshes have slivers.
constexpr double mostNarrow = 1e-4;

/// Textures repeat, so that coordinates as far out as a surveyor's places may be brought back by whole numbers, before
/// single precision takes what is left of them.
std::vector<glm::vec2> repeated(const std::vector<glm::dvec2>& texcoords)
{
    constexpr double farOut = 4096.0;
    glm::dvec2 least(std::numeric_limits<double>::max()), largest(0.0);
    for (const glm::dvec2& t : texcoords) {
        least = glm::min(least, t);
        largest = glm::max(largest, glm::abs(t));
    }
    const glm::dvec2 by(largest.x > farOut ? std::floor(least.x) : 0.0, largest.y > farOut ? std::floor(least.y) : 0.0);
    std::vector<glm::vec2> out;
    out.reserve(texcoords.size());
    for (const glm::dvec2& t : texcoords)
        out.emplace_back(t - by);
    return out;
}

/// Adds the triangles of one face after the other to a mesh.
class FaceSplitter {
public:
    FaceSplitter(ObjElements elements, const std::string& file, Warnings& warnings)
        : file_(file)
        , warnings_(warnings)
        , corners_(std::move(elements.corners))
    {
        mesh_.positions = std::move(elements.positions);
        mesh_.normals = std::move(elements.normals);
        mesh_.texcoords = repeated(elements.texcoords);
    }

    void roundPositions()
    {
        for (glm::dvec3& p : mesh_.positions)
            p = inSingle(p);
    }

    /// The next face, of so many corners.
    void add(const ObjFace& face, std::size_t count, std::uint32_t object)
    {
        current_ = &face;
        object_ = object;
        face_ = std::span(corners_).subspan(at_, count);
        at_ += count;
        if (count == 3)
            triangle();
        else
            polygon();
    }

    std::size_t triangles() const { return mesh_.triangles(); }
    Mesh& mesh() { return mesh_; }

private:
    const glm::dvec3& position(std::size_t corner) const
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
            warn("faces that cross themselves",
                fmt::format(
                    "face of {} corners crosses itself or is folded; parts may be missing or doubled", face_.size()));
        for (const auto& triangle : triangulator_.triangles())
            addTriangle(triangle);
    }

    void warn(std::string_view kind, const std::string& text)
    {
        warnings_.add(kind, fmt::format("mesh file {}:{}: {}", file_, current_->line, text));
    }

    void warnOfFlat() { warn("faces without area", fmt::format("face of {} corners has no area", face_.size())); }

    void addTriangle(const std::array<std::uint32_t, 3>& corners)
    {
        for (const std::uint32_t corner : corners)
            mesh_.corners.push_back(face_[corner]);
        mesh_.materials.push_back(current_->material);
        mesh_.objects.push_back(object_);
    }

    const std::string& file_;
    Warnings& warnings_;
    std::vector<MeshCorner> corners_;
    Mesh mesh_;
    Triangulator triangulator_;
    std::vector<glm::dvec3> outline_;
    const ObjFace* current_ = nullptr;
    std::uint32_t object_ = 0;
    std::span<const MeshCorner> face_;
    std::size_t at_ = 0; ///< in corners_, of the next face
};

} // namespace

bool fitsSinglePrecision(const ObjElements& elements)
{
    Extent all;
    double area = 0.0, narrowArea = 0.0; // doubled
    std::size_t at = 0;
    for (const std::uint32_t count : elements.faceCorners) {
        const auto corner = [&](std::size_t i) -> const glm::dvec3& {
            return elements.positions[static_cast<std::size_t>(elements.corners[at + i].position)];
        };
        Extent face;
        glm::dvec3 normal(0.0);
        for (std::size_t i = 0; i < count; ++i) {
            face.add(corner(i));
            if (i >= 2)
                normal += glm::cross(corner(i - 1) - corner(0), corner(i) - corner(0));
        }
        at += count;
        const double least = leastFace * face.distance(), faceArea = glm::length(normal);
        if (face.size() > 0.0 && face.size() < least)
            return false;
        area += faceArea;
        narrowArea += faceArea < least * face.size() ? faceArea : 0.0;
        all.add(face.lo);
        all.add(face.hi);
    }
    return narrowArea <= mostNarrow * area && !(all.size() > 0.0 && farInSizes * all.size() < all.distance());
}

Mesh triangulated(ObjElements elements, const std::vector<ObjFace>& faces, const std::vector<std::string>& objectNames,
    const std::string& file, Warnings& warnings)
{
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    const bool isSingle = fitsSinglePrecision(elements);
    const std::vector<std::uint32_t> counts = std::move(elements.faceCorners);
    FaceSplitter splitter(std::move(elements), file, warnings);
    splitter.mesh().isSingle = isSingle;
    if (isSingle)
        splitter.roundPositions();
    NameList names;
    std::vector<std::uint32_t> known(objectNames.size(), none);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        std::uint32_t& object = known[faces[i].object];
        const std::size_t before = splitter.triangles();
        splitter.add(faces[i], counts[i], object == none ? static_cast<std::uint32_t>(names.size()) : object);
        if (object == none && splitter.triangles() > before)
            object = names.add(objectNames[faces[i].object]);
    }
    splitter.mesh().objectNames = names.take();
    return std::move(splitter.mesh());
}

} // namespace wedge::scene
