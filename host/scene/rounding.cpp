#include "host/scene/rounding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

#include "host/scene/extent.h"
#include "host/scene/single_precision.h"

namespace wedge::scene {
namespace {

constexpr double mostOff = 0.05; ///< of an edge's length, or of a triangle's height
constexpr double mostTriangles = 0.01, mostArea = 0.001; ///< that may be off by more
constexpr const char* kind = "places far from the origin";
constexpr const char* remedy = "move all that is seen, with camera and lights, near the origin";

double largestOf(const glm::dvec3& v) { return std::max({ std::abs(v.x), std::abs(v.y), std::abs(v.z) }); }

/// How much of a copy is off.
struct Lost {
    std::size_t triangles = 0, narrow = 0; ///< by their edges, and by their heights
    double area = 0.0, ofArea = 0.0;
    double farthest = 0.0; ///< largest coordinate
};

Lost lostOf(const IndexedMesh& mesh, const glm::dmat4& placement)
{
    Lost lost;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        glm::dvec3 p[3];
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = glm::dvec3(placement * glm::dvec4(mesh.positions[mesh.indices[t + i]], 1.0));
        double longest = 0.0, off = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 &from = p[i], &to = p[(i + 1) % 3], edge = to - from;
            longest = std::max(longest, glm::length(edge));
            off = std::max(off, glm::length(inSingle(to) - inSingle(from) - edge));
            lost.farthest = std::max(lost.farthest, largestOf(from));
        }
        const double area = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
        lost.ofArea += area;
        lost.triangles += off > mostOff * longest && longest > 0.0 ? 1 : 0;
        if (off * longest > mostOff * area) { // slivers are many, but small
            ++lost.narrow;
            lost.area += area;
        }
    }
    return lost;
}

/// Of the box of the mesh's vertices.
double farthestOf(const IndexedMesh& mesh, const glm::dmat4& placement)
{
    Extent box;
    for (const glm::dvec3& p : mesh.positions)
        box.add(p);
    double farthest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p(
            corner & 1 ? box.lo.x : box.hi.x, corner & 2 ? box.lo.y : box.hi.y, corner & 4 ? box.lo.z : box.hi.z);
        farthest = std::max(farthest, largestOf(glm::dvec3(placement * glm::dvec4(p, 1.0))));
    }
    return farthest;
}

} // namespace

double spacingAt(double coordinate)
{
    const auto single = static_cast<float>(std::abs(coordinate));
    return double { std::nextafter(single, std::numeric_limits<float>::infinity()) } - double { single };
}

void warnOfRounding(const IndexedMesh& mesh, const glm::dmat4& placement, const std::string& where, Warnings& warnings)
{
    // Two ends of an edge are off by half a spacing each along each axis. A placement that turns and scales evenly
    // scales edges by the cube root of its determinant; others are looked at all the more.
    const double most = std::sqrt(3.0) * spacingAt(farthestOf(mesh, placement));
    const glm::dmat3 linear(placement);
    const double scale = std::min({ glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]) });
    if (most < mostOff * scale * mesh.leastHeight)
        return;
    const Lost lost = lostOf(mesh, placement);
    const std::size_t count = mesh.indices.size() / 3;
    const auto triangles = static_cast<double>(count);
    if (static_cast<double>(lost.triangles) <= mostTriangles * triangles && lost.area <= mostArea * lost.ofArea)
        return;
    warnings.add(kind,
        fmt::format("{}: single precision tells points {:.2g} m apart at coordinates of {:g} m, so that {} of {} "
                    "triangles lose their shape; {}",
            where, spacingAt(lost.farthest), lost.farthest, std::max(lost.triangles, lost.narrow),
            mesh.indices.size() / 3, remedy));
}

void warnOfRounding(const Scene& scene, Warnings& warnings)
{
    constexpr double ofScene = 2e-5;
    Bounds bounds = sceneBounds(scene);
    for (const PointLight& light : scene.pointLights) {
        bounds.lo = glm::min(bounds.lo, light.position);
        bounds.hi = glm::max(bounds.hi, light.position);
    }
    const double size = largestOf(glm::dvec3(bounds.hi) - glm::dvec3(bounds.lo));
    for (std::size_t i = 0; i < scene.pointLights.size(); ++i) {
        const double farthest = largestOf(glm::dvec3(scene.pointLights[i].position));
        if (spacingAt(farthest) > ofScene * size && size > 0.0)
            warnings.add(kind,
                fmt::format("scene {}: single precision tells points {:.2g} m apart at coordinates of {:g} m, where "
                            "point light {} is; {}",
                    scene.path, spacingAt(farthest), farthest, i + 1, remedy));
    }
}

void warnOfRounding(
    const glm::dvec3& place, double size, const std::string& where, const std::string& what, Warnings& warnings)
{
    if (largestOf(inSingle(place) - place) > size)
        warnings.add(kind,
            fmt::format(
                "{}: single precision tells points {:.2g} m apart at coordinates of {:g} m, where the {} is; {}", where,
                spacingAt(largestOf(place)), largestOf(place), what, remedy));
}

} // namespace wedge::scene
