#pragma once

#include "bvh/moving.h"
#include "tests/bvh_rays.h"

#include <array>
#include <set>

/// Meshes that move, and what must hold of a hierarchy over one.
namespace wedge::test {

/// A mesh when the shutter opens, and where its vertices are when it closes.
struct MovingMesh {
    TestMesh open;
    std::vector<float> close;

    bvh::MovingBvh build(const bvh::Config& config = {}) const { return bvh::buildMoving(open.view(), close, config); }

    /// The mesh at a time, rounded to floats as the kernels round.
    TestMesh at(float time) const
    {
        TestMesh out = open;
        for (std::size_t i = 0; i < close.size(); i++) {
            const bool valid =
                std::fabs(open.positions[i]) <= bvh::maxCoordinate && std::fabs(close[i]) <= bvh::maxCoordinate;
            const float displacement = close[i] - open.positions[i], moved = displacement * time;
            out.positions[i] = valid ? open.positions[i] + moved : std::numeric_limits<float>::quiet_NaN();
        }
        return out;
    }

    Vec3 vertexAt(std::size_t triangle, std::size_t corner, float time) const
    {
        float p[3];
        for (std::size_t axis = 0; axis < 3; axis++) {
            const std::size_t i = 3 * std::size_t { open.indices[3 * triangle + corner] } + axis;
            p[axis] = open.positions[i] + (close[i] - open.positions[i]) * time;
        }
        return vec3(p[0], p[1], p[2]);
    }
};

inline MovingMesh moving(TestMesh open, std::vector<float> close) { return { std::move(open), std::move(close) }; }

/// place(i, p): where vertex i, at p when the shutter opens, is when it closes.
template <typename Place>
MovingMesh withClose(const TestMesh& open, const Place& place)
{
    std::vector<float> close;
    for (std::size_t i = 0; i < open.positions.size() / 3; i++) {
        const Vec3 p = place(i, vec3(open.positions[3 * i], open.positions[3 * i + 1], open.positions[3 * i + 2]));
        close.insert(close.end(), { p.x, p.y, p.z });
    }
    return { open, close };
}

inline MovingMesh drifting(const TestMesh& mesh, Vec3 by)
{
    return withClose(mesh, [&](std::size_t, Vec3 p) { return vecAdd(p, by); });
}

/// Half of the triangles stand still, the others each go their own way.
inline MovingMesh scattering(const TestMesh& mesh, float distance)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> u(-1.0f, 1.0f);
    Vec3 by = vec3(0, 0, 0);
    MovingMesh out = withClose(mesh, [&](std::size_t i, Vec3 p) {
        if (i % 3 == 0)
            by = vecScale(vec3(u(random), u(random), u(random)), i % 2 ? distance : 0);
        return vecAdd(p, by);
    });
    out.open.name += ", scattering";
    return out;
}

/// Motions that a builder or a traversal may stumble over.
inline std::vector<MovingMesh> movingMeshes()
{
    std::vector<MovingMesh> out;
    for (const TestMesh& mesh : nastyMeshes())
        out.push_back(mesh.name == "huge" ? drifting(mesh, vec3(1e17f, 0, -1e17f))
                : mesh.name == "tiny"     ? drifting(mesh, vec3(1e-20f, 2e-20f, 0))
                                          : drifting(mesh, vec3(0.3f, -0.5f, 0.1f)));
    out.push_back(scattering(soup(1000, 0.2f), 1));
    out.push_back(scattering(soup(300, 0.1f), 1e4f)); // 100,000 times their size
    const TestMesh some = soup(200, 0.5f, 9);
    const auto add = [&](const std::string& name, const TestMesh& mesh, const auto& place) {
        out.push_back(withClose(mesh, place));
        out.back().open.name = name;
    };
    add("half of it to a point", some, [](std::size_t i, Vec3 p) { return i / 3 % 2 ? vec3(0.1f, 0.2f, 0.3f) : p; });
    const auto toLine = [](std::size_t, Vec3 p) { return vec3(p.x, 0.5f, 0.25f); };
    add("to a line", some, toLine);
    TestMesh line = some;
    line.positions = out.back().close;
    add("from a line", line, [&](std::size_t i, Vec3) {
        return vec3(some.positions[3 * i], some.positions[3 * i + 1], some.positions[3 * i + 2]);
    });
    add("inside out", some, [](std::size_t, Vec3 p) { return vecScale(p, -1); });
    // By a right angle, on straight paths instead of the circle's.
    add("turning", waves(16), [](std::size_t, Vec3 p) { return vec3(-p.z, p.y, p.x); });
    return out;
}

inline std::vector<float> randomTimes(std::size_t count, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::vector<float> times;
    for (std::size_t i = 0; i < count; i++)
        times.push_back(i % 16 == 0 ? 0.0f : i % 16 == 1 ? 1.0f : uniform(random));
    return times;
}

/// Walks wide or narrow nodes over the blocks of a hierarchy, and asks of every box that the triangles below are within
/// it at many times, in double.
template <typename Node>
class MotionChecker {
public:
    MotionChecker(const bvh::MovingBvh& hierarchy, std::span<const Node> nodes, const MovingMesh& mesh)
        : hierarchy_(hierarchy)
        , nodes_(nodes)
        , mesh_(mesh)
        , unit_(nodes[0].unit)
    {
    }

    std::vector<std::string> run()
    {
        visit(0);
        for (std::size_t i = 0; i < mesh_.open.triangles(); i++)
            if (isValid(i) != (seen_.count(i) == 1))
                problems_.push_back(
                    "triangle is there and should not be, or the other way round: " + std::to_string(i));
        if (seen_.size() != hierarchy_.statistics.triangles)
            problems_.emplace_back("the statistics have another number of triangles");
        problems_.resize(std::min<std::size_t>(problems_.size(), 10));
        return problems_;
    }

private:
    static constexpr std::array<double, 6> times { 0, 0.01, 1.0 / 3, 0.5, 0.9, 1 };

    struct Extent {
        std::array<std::array<double, 3>, times.size()> lo, hi;
    };

    double at(std::size_t triangle, std::size_t corner, std::size_t axis, double time) const
    {
        const std::size_t i = 3 * std::size_t { mesh_.open.indices[3 * triangle + corner] } + axis;
        return (double { mesh_.open.positions[i] } * (1 - time) + double { mesh_.close[i] } * time) * double { unit_ };
    }

    bool isValid(std::size_t triangle) const
    {
        for (std::size_t corner = 0; corner < 3; corner++)
            for (std::size_t axis = 0; axis < 3; axis++)
                for (const double end : { 0.0, 1.0 })
                    if (!(std::fabs(at(triangle, corner, axis, end) / double { unit_ })
                            <= double { bvh::maxCoordinate }))
                        return false;
        return true;
    }

    static void grow(Extent& extent, const Extent& other)
    {
        for (std::size_t k = 0; k < times.size(); k++)
            for (std::size_t axis = 0; axis < 3; axis++) {
                extent.lo[k][axis] = std::min(extent.lo[k][axis], other.lo[k][axis]);
                extent.hi[k][axis] = std::max(extent.hi[k][axis], other.hi[k][axis]);
            }
    }

    static Extent none()
    {
        Extent extent;
        for (std::size_t k = 0; k < times.size(); k++) {
            extent.lo[k].fill(1e300);
            extent.hi[k].fill(-1e300);
        }
        return extent;
    }

    /// Vertices and planes as kernels compute them, in floats, with multiply-adds of planes fused or not.
    void checkRounded(const Node& node, std::size_t slot)
    {
        const std::uint32_t leaf = node.child[slot];
        const float* const planes[6] = { node.loX, node.hiX, node.loY, node.hiY, node.loZ, node.hiZ };
        const float* const moves[6] = { node.moveLoX, node.moveHiX, node.moveLoY, node.moveHiY, node.moveLoZ,
            node.moveHiZ };
        const std::size_t first = (leaf & ~WEDGE_BVH_LEAF) >> 3;
        for (std::size_t row = 0; row < 9 * WEDGE_BLOCK_SIZE * (leaf & 7u); row++) {
            const std::size_t vertex = row / WEDGE_BLOCK_SIZE % 9, lane = row % WEDGE_BLOCK_SIZE, axis = vertex % 3;
            const shared::MovingTriangleBlock& block = hierarchy_.blocks[first + row / (9 * WEDGE_BLOCK_SIZE)];
            if (block.triangle[lane] == WEDGE_NO_TRIANGLE)
                continue;
            const float open = (&block.v0x)[vertex][lane], move = (&block.move0x)[vertex][lane];
            const float time = uniform_(random_), moved = move * time, at = open + moved;
            for (const bool high : { false, true }) {
                const float plane = planes[2 * axis + high][slot], away = moves[2 * axis + high][slot];
                const float product = away * time, sum = plane + product, fused = std::fma(away, time, plane);
                if (high ? at > sum || at > fused : at < sum || at < fused)
                    problems_.push_back("a rounded vertex leaves its rounded box at block " + std::to_string(first));
            }
        }
    }

    Extent leafExtent(std::uint32_t leaf)
    {
        Extent extent = none();
        const std::size_t first = (leaf & ~WEDGE_BVH_LEAF) >> 3;
        for (std::size_t block = first; block < first + (leaf & 7u); block++)
            for (const std::uint32_t triangle : hierarchy_.blocks[block].triangle) {
                if (triangle == WEDGE_NO_TRIANGLE)
                    continue;
                if (!seen_.insert(triangle).second)
                    problems_.push_back("triangle is there twice: " + std::to_string(triangle));
                for (std::size_t k = 0; k < times.size(); k++)
                    for (std::size_t corner = 0; corner < 3; corner++)
                        for (std::size_t axis = 0; axis < 3; axis++) {
                            const double x = at(triangle, corner, axis, times[k]);
                            extent.lo[k][axis] = std::min(extent.lo[k][axis], x);
                            extent.hi[k][axis] = std::max(extent.hi[k][axis], x);
                        }
            }
        return extent;
    }

    Extent visit(std::size_t index)
    {
        const Node& node = nodes_[index];
        Extent all = none();
        for (std::size_t slot = 0; slot < std::size(node.child); slot++) {
            const std::uint32_t child = node.child[slot];
            if (child == WEDGE_BVH_LEAF)
                continue;
            if (child & WEDGE_BVH_LEAF)
                checkRounded(node, slot);
            const Extent below = child & WEDGE_BVH_LEAF ? leafExtent(child) : visit(child);
            const double lo[3] = { node.loX[slot], node.loY[slot], node.loZ[slot] };
            const double hi[3] = { node.hiX[slot], node.hiY[slot], node.hiZ[slot] };
            const double moveLo[3] = { node.moveLoX[slot], node.moveLoY[slot], node.moveLoZ[slot] };
            const double moveHi[3] = { node.moveHiX[slot], node.moveHiY[slot], node.moveHiZ[slot] };
            constexpr double rounding = 1e-15; // of the sums here; coordinates are at most 1
            for (std::size_t k = 0; k < times.size(); k++)
                for (std::size_t axis = 0; axis < 3; axis++)
                    if (below.lo[k][axis] < lo[axis] + moveLo[axis] * times[k] - rounding
                        || below.hi[k][axis] > hi[axis] + moveHi[axis] * times[k] + rounding)
                        problems_.push_back("a triangle leaves its box at node " + std::to_string(index) + " at time "
                            + std::to_string(times[k]));
            grow(all, below);
        }
        return all;
    }

    const bvh::MovingBvh& hierarchy_;
    std::span<const Node> nodes_;
    const MovingMesh& mesh_;
    float unit_;
    std::set<std::size_t> seen_;
    std::vector<std::string> problems_;
    std::mt19937 random_ { 53 };
    std::uniform_real_distribution<float> uniform_ { 0.0f, 1.0f };
};

/// What is wrong with a hierarchy's wide or narrow nodes, a line each; none if all is well.
template <typename Node>
std::vector<std::string> faultsOf(const bvh::MovingBvh& hierarchy, std::span<const Node> nodes, const MovingMesh& mesh)
{
    return MotionChecker<Node>(hierarchy, nodes, mesh).run();
}

} // namespace wedge::test
