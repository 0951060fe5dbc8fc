#pragma once

#include "bvh/host_traverse.h"
#include "tests/bvh_meshes.h"

#include <algorithm>
#include <utility>

/// Rays against every triangle of a mesh, in double: what any traversal is measured by.
namespace wedge::test {

using bvh::Ray;
using shared::Hit;
using shared::vec3;
using shared::Vec3;

struct Vec3d {
    double x, y, z;
};
inline Vec3d toDouble(Vec3 v) { return { v.x, v.y, v.z }; }
inline Vec3d operator-(Vec3d a, Vec3d b) { return { a.x - b.x, a.y - b.y, a.z - b.z }; }
inline double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3d cross(Vec3d a, Vec3d b) { return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x }; }
inline double length(Vec3d a) { return std::sqrt(dot(a, a)); }

/// One triangle against one ray in double, with bounds of what rounding to floats may do to the answer.
struct ExactHit {
    double t = 0, u = 0, v = 0;
    double tError = 0, uError = 0; ///< uError bounds that of v and 1 - u - v too
    bool possible = false; ///< a float computation may call this a hit
    bool certain = false; ///< and this it must
};

inline ExactHit intersectExactly(const TestMesh& mesh, std::size_t triangle, const Ray& ray)
{
    Vec3d vertices[3];
    for (std::size_t corner = 0; corner < 3; corner++) {
        const float* p = &mesh.positions[3 * std::size_t { mesh.indices[3 * triangle + corner] }];
        for (int axis = 0; axis < 3; axis++)
            if (!(std::fabs(p[axis]) <= bvh::maxCoordinate))
                return {};
        vertices[corner] = { p[0], p[1], p[2] };
    }
    const Vec3d e1 = vertices[1] - vertices[0], e2 = vertices[2] - vertices[0];
    const Vec3d c = vertices[0] - toDouble(ray.origin), d = toDouble(ray.direction), n = cross(e1, e2);
    const double size = dot(n, d), edges = length(e1) * length(e2);
    // Half an ulp an operation, of which no term sees more than about ten.
    constexpr double roundings = 10 * 6e-8;
    if (length(n) <= 2 * bvh::degenerateSine * edges && !(length(n) > bvh::degenerateSine * edges * 1.01))
        return {};
    const double sizeError = roundings * edges * length(d);
    const bool edgeOn = std::fabs(size) <= 4 * sizeError;
    ExactHit hit;
    hit.t = dot(n, c) / size;
    hit.u = dot(cross(c, d), e2) / size;
    hit.v = -dot(cross(c, d), e1) / size;
    hit.tError = (roundings * edges * length(c) + std::fabs(hit.t) * sizeError) / std::fabs(size);
    hit.uError = (roundings * length(c) * length(d) * (length(e1) + length(e2)) + sizeError) / std::fabs(size);
    const double inside = std::min({ hit.u, hit.v, 1 - hit.u - hit.v });
    const double tMin = std::max(0.0f, ray.tMin), tMax = ray.tMax;
    hit.possible =
        edgeOn || (inside >= -2 * hit.uError && hit.t > tMin - 2 * hit.tError && hit.t < tMax + 2 * hit.tError);
    hit.certain = !edgeOn && inside > hit.uError && hit.t > tMin + hit.tError && hit.t < tMax - hit.tError;
    return hit;
}

/// Whether t of a hit is more than rounding: not so where the ray lies within the triangle's plane, as near as floats
/// can tell. Such a hit may be at any t, beyond its own box too, and then it depends on the order of the search.
inline bool isDetermined(const TestMesh& mesh, const Ray& ray, const Hit& hit)
{
    if (hit.triangle == WEDGE_NO_TRIANGLE)
        return true;
    const ExactHit exact = intersectExactly(mesh, hit.triangle, ray);
    return exact.tError <= 1e-4 * std::fabs(exact.t);
}

/// Compares what a traversal found with every triangle of the mesh. Returns "" or what is wrong.
inline std::string findFault(const TestMesh& mesh, const Ray& ray, const Hit& hit, bool occluded)
{
    double nearest = std::numeric_limits<double>::infinity(), nearestError = 0;
    bool possible = false;
    for (std::size_t i = 0; i < mesh.triangles(); i++) {
        const ExactHit exact = intersectExactly(mesh, i, ray);
        possible |= exact.possible;
        if (exact.certain && exact.t < nearest) {
            nearest = exact.t;
            nearestError = exact.tError;
        }
    }
    const bool certain = std::isfinite(nearest), found = hit.triangle != WEDGE_NO_TRIANGLE;
    if (certain && !found)
        return "misses a hit";
    if (certain && !occluded)
        return "any-hit misses a hit";
    if (!possible && (found || occluded))
        return "hits nothing that is there";
    if (!found)
        return hit.t == ray.tMax && hit.u == 0 && hit.v == 0 ? "" : "a miss is not written as one";
    if (hit.triangle >= mesh.triangles())
        return "hits a triangle that does not exist";
    if (!(hit.t > std::max(0.0f, ray.tMin) && hit.t < ray.tMax))
        return "t is outside the interval";
    const ExactHit exact = intersectExactly(mesh, hit.triangle, ray);
    if (!exact.possible)
        return "reports a triangle that the ray does not hit";
    if (hit.t > nearest + nearestError + exact.tError)
        return "is not the nearest";
    if (std::fabs(hit.t - exact.t) > exact.tError || std::fabs(hit.u - exact.u) > exact.uError
        || std::fabs(hit.v - exact.v) > exact.uError)
        return exact.certain ? "t, u or v is wrong" : "";
    return "";
}

} // namespace wedge::test
