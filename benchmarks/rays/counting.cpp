#include "benchmarks/rays/counting.h"

#include <algorithm>
#include <cmath>

namespace wedge::benchmark {
namespace {

/// The ray in the hierarchy's unit.
struct ScaledRay {
    float origin[3], direction[3], inverse[3], tMin, tMax;

    ScaledRay(const bvh::Ray& ray, float unit)
        : origin { ray.origin.x * unit, ray.origin.y * unit, ray.origin.z * unit }
        , direction { ray.direction.x * unit, ray.direction.y * unit, ray.direction.z * unit }
        , tMin(ray.tMin)
        , tMax(ray.tMax)
    {
        for (int axis = 0; axis < 3; ++axis)
            inverse[axis] = 1 / (direction[axis] == 0 ? 1e-30f : direction[axis]);
    }
};

struct Entry {
    std::uint32_t reference;
    float t;
};

/// The children that the ray enters before its end, nearest last.
unsigned enterChildren(const shared::BvhNode& node, const ScaledRay& ray, Entry* out)
{
    const float* lo[3] = { node.loX, node.loY, node.loZ };
    const float* hi[3] = { node.hiX, node.hiY, node.hiZ };
    unsigned count = 0;
    for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; ++slot) {
        float enter = ray.tMin, leave = ray.tMax;
        for (int axis = 0; axis < 3; ++axis) {
            const float a = (lo[axis][slot] - ray.origin[axis]) * ray.inverse[axis];
            const float b = (hi[axis][slot] - ray.origin[axis]) * ray.inverse[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        // Empty slots hold boxes that are inside out, which the minimum and maximum above would turn.
        if (!(enter <= leave) || node.loX[slot] > node.hiX[slot])
            continue;
        unsigned place = count++;
        for (; place > 0 && out[place - 1].t < enter; --place)
            out[place] = out[place - 1];
        out[place] = { node.child[slot], enter };
    }
    return count;
}

/// Shortens the ray to the nearest of the block's triangles that it hits; whether there is one.
bool hitBlock(const shared::TriangleBlock& b, ScaledRay& ray)
{
    bool any = false;
    const shared::Vec3 origin = shared::vec3(ray.origin[0], ray.origin[1], ray.origin[2]);
    const shared::Vec3 direction = shared::vec3(ray.direction[0], ray.direction[1], ray.direction[2]);
    for (unsigned i = 0; i < WEDGE_BLOCK_SIZE; ++i) {
        const shared::Vec3 v0 = shared::vec3(b.v0x[i], b.v0y[i], b.v0z[i]);
        const shared::Vec3 e1 = vecSub(shared::vec3(b.v1x[i], b.v1y[i], b.v1z[i]), v0);
        const shared::Vec3 e2 = vecSub(shared::vec3(b.v2x[i], b.v2y[i], b.v2z[i]), v0);
        const shared::Vec3 p = vecCross(direction, e2), s = vecSub(origin, v0), q = vecCross(s, e1);
        const float inverse = 1 / vecDot(e1, p), u = vecDot(s, p) * inverse, v = vecDot(direction, q) * inverse;
        const float t = vecDot(e2, q) * inverse;
        if (u >= 0 && v >= 0 && u + v <= 1 && t > ray.tMin && t < ray.tMax) {
            ray.tMax = t;
            any = true;
        }
    }
    return any;
}

void count(const bvh::Bvh& bvh, ScaledRay ray, bool anyHit, TraversalCounts& counts)
{
    std::vector<Entry> stack { { 0, 0 } };
    while (!stack.empty()) {
        const Entry current = stack.back();
        stack.pop_back();
        if (current.t > ray.tMax)
            continue;
        if (current.reference & WEDGE_BVH_LEAF) {
            const std::uint32_t first = (current.reference & ~WEDGE_BVH_LEAF) >> 3;
            for (std::uint32_t block = first; block < first + (current.reference & 7u); ++block) {
                ++counts.blocks;
                if (hitBlock(bvh.blocks[block], ray) && anyHit)
                    return;
            }
            continue;
        }
        ++counts.nodes;
        Entry children[WEDGE_BVH_WIDTH];
        const unsigned entered = enterChildren(bvh.nodes[current.reference], ray, children);
        stack.insert(stack.end(), children, children + entered);
    }
}

} // namespace

TraversalCounts countTraversal(const bvh::Bvh& bvh, const RaySet& set, std::size_t sample)
{
    const std::size_t step = std::max<std::size_t>(1, set.live / std::max<std::size_t>(1, sample));
    TraversalCounts sum;
    std::size_t live = 0, counted = 0;
    for (const bvh::Ray& ray : set.rays)
        if (isLive(ray) && live++ % step == 0) {
            count(bvh, ScaledRay(ray, bvh.nodes[0].unit), set.anyHit, sum);
            ++counted;
        }
    const double n = static_cast<double>(std::max<std::size_t>(1, counted));
    return { sum.nodes / n, sum.blocks / n };
}

double portCycles(const TraversalCounts& counts)
{
    return (counts.nodes * nodeOperations + counts.blocks * blockOperations) / operationsPerCycle;
}

} // namespace wedge::benchmark
