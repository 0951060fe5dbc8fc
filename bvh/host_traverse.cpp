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

/// The triangle test of kernels/intersect.h for one lane, in the same floats.
bool hitsLane(const shared::TriangleBlock& block, unsigned lane, const Ray& ray, Hit& hit)
{
    const Vec3 e1 = shared::vec3(block.e1x[lane], block.e1y[lane], block.e1z[lane]);
    const Vec3 e2 = shared::vec3(block.e2x[lane], block.e2y[lane], block.e2z[lane]);
    const Vec3 c = vecSub(shared::vec3(block.v0x[lane], block.v0y[lane], block.v0z[lane]), ray.origin);
    const Vec3 r = vecCross(c, ray.direction), normal = vecCross(e1, e2);
    const float volume = vecDot(normal, ray.direction);
    const float sign = std::copysign(1.0f, volume), size = std::fabs(volume);
    const float u = sign * vecDot(r, e2), v = -sign * vecDot(r, e1), w = sign * vecDot(normal, c);
    if (!(u >= 0 && v >= 0 && u + v <= size && size > 0))
        return false;
    const float inverse = 1.0f / size, t = w * inverse;
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
