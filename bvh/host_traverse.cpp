#include "bvh/host_traverse.h"

#include <algorithm>
#include <cmath>

namespace wedge::bvh {
namespace {

using shared::Hit;
using shared::Vec3;

/// Rounding may not lose a hit, so boxes are tested in double and widened by a few float roundings.
bool entersBox(const shared::BvhNode& node, unsigned slot, const Ray& ray, double tMax)
{
    const double origin[3] = { ray.origin.x, ray.origin.y, ray.origin.z };
    const double direction[3] = { ray.direction.x, ray.direction.y, ray.direction.z };
    const double lo[3] = { node.loX[slot], node.loY[slot], node.loZ[slot] };
    const double hi[3] = { node.hiX[slot], node.hiY[slot], node.hiZ[slot] };
    double enter = std::max(0.0f, ray.tMin), leave = tMax;
    for (int axis = 0; axis < 3; axis++) {
        const double slack = 1e-6 * std::max({ std::fabs(origin[axis]), std::fabs(lo[axis]), std::fabs(hi[axis]) });
        const double below = lo[axis] - slack - origin[axis], above = hi[axis] + slack - origin[axis];
        if (direction[axis] == 0) {
            if (below > 0 || above < 0)
                return false;
            continue;
        }
        const double a = below / direction[axis], b = above / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave * (1 + 1e-6);
}

/// v with its axes turned so that axis `last` comes last.
Vec3 turned(Vec3 v, int last)
{
    return last == 0 ? shared::vec3(v.y, v.z, v.x) : last == 1 ? shared::vec3(v.z, v.x, v.y) : v;
}

/// The triangle test of kernels/trace/intersect.h for one lane, in the same floats.
bool hitsLane(const shared::TriangleBlock& block, unsigned lane, const Ray& ray, Hit& hit)
{
    const float x = std::fabs(ray.direction.x), y = std::fabs(ray.direction.y), z = std::fabs(ray.direction.z);
    const int last = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const Vec3 direction = turned(ray.direction, last), origin = turned(ray.origin, last);
    const float shearX = direction.x / direction.z, shearY = direction.y / direction.z;
    const Vec3 v0 = turned(shared::vec3(block.v0x[lane], block.v0y[lane], block.v0z[lane]), last);
    const Vec3 v1 = turned(shared::vec3(block.v1x[lane], block.v1y[lane], block.v1z[lane]), last);
    const Vec3 v2 = turned(shared::vec3(block.v2x[lane], block.v2y[lane], block.v2z[lane]), last);
    const Vec3 a = vecSub(v0, origin), b = vecSub(v1, origin), c = vecSub(v2, origin);
    const float ax = a.x - shearX * a.z, ay = a.y - shearY * a.z;
    const float bx = b.x - shearX * b.z, by = b.y - shearY * b.z;
    const float cx = c.x - shearX * c.z, cy = c.y - shearY * c.z;
    const float u = ax * cy - ay * cx, v = bx * ay - by * ax, w = cx * by - cy * bx;
    const float sum = u + v + w;
    if (!((std::min({ u, v, w }) >= 0 || std::max({ u, v, w }) <= 0) && sum != 0))
        return false;
    const Vec3 normal = vecCross(vecSub(v1, v0), vecSub(v2, v0));
    const float t = vecDot(normal, a) / vecDot(normal, direction), inverse = 1.0f / sum;
    const std::uint32_t triangle = block.triangle[lane];
    const bool nearer = t < hit.t || (t == hit.t && triangle < hit.triangle);
    if (!(t > std::max(0.0f, ray.tMin) && t < ray.tMax && nearer))
        return false;
    hit = { t, u * inverse, v * inverse, triangle };
    return true;
}

bool isFinite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Hit traverse(const Bvh& bvh, Ray ray, bool any)
{
    Hit hit { ray.tMax, 0, 0, WEDGE_NO_TRIANGLE };
    if (!isFinite(ray.origin) || !isFinite(ray.direction) || !(ray.tMax > std::max(0.0f, ray.tMin)))
        return hit;
    const float unit = bvh.nodes[0].unit;
    ray.origin = vecScale(ray.origin, unit);
    ray.direction = vecScale(ray.direction, unit);
    std::vector<std::uint32_t> stack { 0 };
    while (!stack.empty()) {
        const std::uint32_t current = stack.back();
        stack.pop_back();
        if (current & WEDGE_BVH_LEAF) {
            const std::uint32_t first = (current & ~WEDGE_BVH_LEAF) >> 3;
            for (std::uint32_t block = first; block < first + (current & 7u); block++)
                for (unsigned lane = 0; lane < WEDGE_BLOCK_SIZE; lane++)
                    if (hitsLane(bvh.blocks[block], lane, ray, hit) && any)
                        return hit;
            continue;
        }
        const shared::BvhNode& node = bvh.nodes[current];
        for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++)
            if (entersBox(node, slot, ray, hit.t))
                stack.push_back(node.child[slot]);
    }
    return hit;
}

} // namespace

Hit closestHit(const Bvh& bvh, const Ray& ray) { return traverse(bvh, ray, false); }

bool anyHit(const Bvh& bvh, const Ray& ray) { return traverse(bvh, ray, true).triangle != WEDGE_NO_TRIANGLE; }

} // namespace wedge::bvh
