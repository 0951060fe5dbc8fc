#pragma once

#include "bvh/host_traverse.h"
#include "tests/bvh_meshes.h"

#include <algorithm>
#include <utility>

/// Rays that a traversal may stumble over, all seeded.
namespace wedge::test {

using bvh::Ray;
using shared::Hit;
using shared::vec3;
using shared::Vec3;

constexpr float infinity = std::numeric_limits<float>::infinity();

/// The box of all that is valid in a mesh.
inline std::pair<Vec3, Vec3> boundsOf(const TestMesh& mesh)
{
    float lo[3] = { 1e38f, 1e38f, 1e38f }, hi[3] = { -1e38f, -1e38f, -1e38f };
    for (std::size_t i = 0; i < mesh.positions.size(); i++)
        if (std::fabs(mesh.positions[i]) <= bvh::maxCoordinate) {
            lo[i % 3] = std::min(lo[i % 3], mesh.positions[i]);
            hi[i % 3] = std::max(hi[i % 3], mesh.positions[i]);
        }
    return { vec3(lo[0], lo[1], lo[2]), vec3(hi[0], hi[1], hi[2]) };
}

/// A point on a random triangle; a quarter of them on vertices and edges, which onEdge tells.
inline Vec3 pointOn(const TestMesh& mesh, std::mt19937& random, bool* onEdge = nullptr)
{
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    float a = uniform(random), b = uniform(random) * (1 - a);
    const unsigned place = random() % 8;
    a = place == 0 ? 0.0f : a;
    b = place <= 1 ? 0.0f : b;
    if (onEdge)
        *onEdge = place <= 1;
    const std::size_t triangle = random() % mesh.triangles();
    const auto coordinate = [&](std::size_t axis) {
        const auto at = [&](std::size_t corner) {
            return mesh.positions[3 * std::size_t { mesh.indices[3 * triangle + corner] } + axis];
        };
        return at(0) + a * (at(1) - at(0)) + b * (at(2) - at(0));
    };
    return vec3(coordinate(0), coordinate(1), coordinate(2));
}

/// Rays through and at a mesh, with directions of any length and intervals of all sorts.
inline std::vector<Ray> randomRays(const TestMesh& mesh, std::size_t count, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-0.7f, 1.7f);
    const auto [lo, hi] = mesh.triangles() ? boundsOf(mesh) : std::pair(vec3(-1, -1, -1), vec3(1, 1, 1));
    const auto nearMesh = [&, lo = lo, hi = hi] {
        return vec3(lo.x + (hi.x - lo.x) * uniform(random), lo.y + (hi.y - lo.y) * uniform(random),
            lo.z + (hi.z - lo.z) * uniform(random));
    };
    std::vector<Ray> rays;
    while (rays.size() < count) {
        const Vec3 origin = nearMesh();
        const Vec3 target = rays.size() % 2 && mesh.triangles() ? pointOn(mesh, random) : nearMesh();
        const float stretch = std::ldexp(1.0f, static_cast<int>(random() % 21) - 10);
        Ray ray { origin, 0, vecScale(vecSub(target, origin), stretch), infinity };
        if (rays.size() % 3 == 0)
            ray.tMax = 0.999f / stretch; // a shadow ray
        if (rays.size() % 7 == 0)
            ray.tMin = 0.5f / stretch;
        rays.push_back(ray);
    }
    return rays;
}

/// Along the axes, with zeros of both signs, from and through coordinates that triangles and boxes have.
inline std::vector<Ray> axisRays(const TestMesh& mesh, std::size_t count)
{
    std::mt19937 random(11);
    const auto coordinate = [&](std::size_t axis) {
        for (int attempt = 0; attempt < 50 && !mesh.positions.empty(); attempt++) {
            const float x = mesh.positions[3 * (random() % (mesh.positions.size() / 3)) + axis];
            if (std::fabs(x) <= bvh::maxCoordinate)
                return x;
        }
        return 0.0f;
    };
    const auto [lo, hi] = mesh.triangles() ? boundsOf(mesh) : std::pair(vec3(-1, -1, -1), vec3(1, 1, 1));
    const float from[3] = { lo.x - (hi.x - lo.x), lo.y - (hi.y - lo.y), lo.z - (hi.z - lo.z) };
    const float size[3] = { hi.x - lo.x, hi.y - lo.y, hi.z - lo.z };
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; i++) {
        float o[3] = { coordinate(0), coordinate(1), coordinate(2) };
        float d[3] = { i & 8 ? -0.0f : 0.0f, i & 16 ? -0.0f : 0.0f, i & 32 ? -0.0f : 0.0f };
        const std::size_t axis = i % 3;
        d[axis] = size[axis] > 0 ? size[axis] : 1.0f;
        o[axis] = from[axis];
        if (i & 4)
            d[(axis + 1) % 3] = d[axis]; // along a diagonal of two axes
        rays.push_back({ vec3(o[0], o[1], o[2]), 0, vec3(d[0], d[1], d[2]), infinity });
    }
    return rays;
}

/// At vertices and at the middles of edges, from anywhere about.
inline std::vector<Ray> cornerRays(const TestMesh& mesh, std::size_t count)
{
    std::mt19937 random(31);
    const std::vector<Ray> from = randomRays(mesh, count, 32);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count && mesh.triangles(); i++) {
        const std::size_t triangle = random() % mesh.triangles(), corner = random() % 3;
        const auto at = [&](std::size_t c) {
            const float* p = &mesh.positions[3 * std::size_t { mesh.indices[3 * triangle + c % 3] }];
            return vec3(p[0], p[1], p[2]);
        };
        const Vec3 target = i % 2 ? at(corner) : vecScale(vecAdd(at(corner), at(corner + 1)), 0.5f);
        rays.push_back({ from[i].origin, 0, vecSub(target, from[i].origin), infinity });
    }
    return rays;
}

/// Within the plane of a triangle, or so little beside it that rounding decides.
inline std::vector<Ray> grazingRays(const TestMesh& mesh, std::size_t count)
{
    std::mt19937 random(37);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count && mesh.triangles(); i++) {
        const std::size_t triangle = random() % mesh.triangles();
        const auto at = [&](std::size_t c) {
            const float* p = &mesh.positions[3 * std::size_t { mesh.indices[3 * triangle + c] }];
            return vec3(p[0], p[1], p[2]);
        };
        const Vec3 e1 = vecSub(at(1), at(0)), e2 = vecSub(at(2), at(0));
        const Vec3 along = vecAdd(vecScale(e1, uniform(random)), vecScale(e2, uniform(random)));
        const Vec3 inside = vecAdd(at(0), vecAdd(vecScale(e1, 0.3f), vecScale(e2, 0.3f)));
        const float tilt = i % 3 == 0 ? 0.0f : std::ldexp(vecLength(e1), -static_cast<int>(random() % 26));
        const Vec3 beside = vecScale(vecNormalize(vecCross(e1, e2)), tilt);
        rays.push_back({ vecAdd(vecSub(inside, vecScale(along, 3)), beside), 0, along, infinity });
    }
    return rays;
}

/// Rays that are none: components that are not numbers, no direction, no interval. Each but for that is good.
inline std::vector<Ray> brokenRays(const Ray& good)
{
    constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
    std::vector<Ray> rays;
    for (const float bad : { notANumber, infinity, -infinity })
        for (int component = 0; component < 6; component++) {
            Ray ray = good;
            float* const parts[] = { &ray.origin.x, &ray.origin.y, &ray.origin.z, &ray.direction.x, &ray.direction.y,
                &ray.direction.z };
            *parts[component] = bad;
            rays.push_back(ray);
        }
    rays.push_back({ good.origin, 0, vec3(0, 0, 0), infinity });
    rays.push_back({ good.origin, 0, vec3(-0.0f, 0, -0.0f), infinity });
    rays.push_back({ good.origin, 1, good.direction, 1 });
    rays.push_back({ good.origin, 2, good.direction, 1 });
    rays.push_back({ good.origin, 0, good.direction, 0 });
    rays.push_back({ good.origin, -2, good.direction, -1 });
    rays.push_back({ good.origin, 0, good.direction, notANumber });
    rays.push_back({ good.origin, infinity, good.direction, infinity });
    return rays;
}

struct RaySet {
    std::string name;
    std::vector<Ray> rays;
};

/// Rays of all these kinds, count of each.
inline std::vector<RaySet> raySets(const TestMesh& mesh, std::size_t count)
{
    return { { "random", randomRays(mesh, count, 7) }, { "along axes", axisRays(mesh, count) },
        { "at edges and vertices", cornerRays(mesh, count) }, { "grazing", grazingRays(mesh, count) } };
}

} // namespace wedge::test
