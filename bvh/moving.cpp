#include "bvh/moving.h"

#include "bvh/chunks.h"
#include "bvh/moving_box.h"
#include "bvh/reference.h"
#include "bvh/triangle_blocks.h"
#include "bvh/wide_node.h"

#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>

namespace wedge::bvh {
namespace {

using namespace detail;
using shared::BvhNode;
using shared::MovingNode;
using shared::MovingTriangleBlock;
using shared::TriangleBlock;

/// Positions at a time; NaN where they are not valid at both ends.
std::vector<float> positionsAt(std::span<const float> open, std::span<const float> close, float time)
{
    std::vector<float> out(open.size());
    const Chunks chunks(open.size());
    chunks.forEach([&](std::size_t chunk) {
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++) {
            const bool valid = std::fabs(open[i]) <= maxCoordinate && std::fabs(close[i]) <= maxCoordinate;
            out[i] = valid ? open[i] * (1 - time) + close[i] * time : std::numeric_limits<float>::quiet_NaN();
        }
    });
    return out;
}

/// Where vertices are at the closing as kernels compute it: at the opening plus a displacement, both rounded.
std::vector<float> roundedClose(std::span<const float> open, std::span<const float> close)
{
    std::vector<float> out(open.size());
    for (std::size_t i = 0; i < out.size(); i++)
        out[i] = open[i] + (close[i] - open[i]);
    return out;
}

/// The nodes of a tree with the boxes that they have around all of the meshes, in their coordinates.
Array<BvhNode> fittedNodes(const Bvh& tree, std::initializer_list<Mesh> meshes)
{
    Array<BvhNode> nodes = tree.nodes;
    const Chunks chunks(nodes.size());
    const auto leafBox = [&](std::uint32_t leaf) {
        Box box = Box::empty();
        const std::uint32_t first = (leaf & ~WEDGE_BVH_LEAF) >> 3;
        for (std::uint32_t block = first; block < first + (leaf & 7u); block++)
            for (const std::uint32_t triangle : tree.blocks[block].triangle)
                if (triangle != WEDGE_NO_TRIANGLE)
                    for (const Mesh& mesh : meshes) {
                        bool valid;
                        box.grow(boxOf(mesh, triangle, valid));
                    }
        return box;
    };
    chunks.forEach([&](std::size_t chunk) {
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++)
            for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++)
                if (nodes[i].child[slot] & WEDGE_BVH_LEAF) {
                    const Box box = leafBox(nodes[i].child[slot]);
                    setBox(nodes[i], slot, box.lo, box.hi);
                }
    });
    // Children come after their parents.
    for (std::size_t i = nodes.size(); i-- > 0;)
        for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++) {
            if (nodes[i].child[slot] & WEDGE_BVH_LEAF)
                continue;
            Box box = Box::empty();
            for (unsigned below = 0; below < WEDGE_BVH_WIDTH; below++)
                box.grow(slotBox(nodes[nodes[i].child[slot]], below));
            setBox(nodes[i], slot, box.lo, box.hi);
        }
    return nodes;
}

/// The box of all that is below a node.
Box nodeBox(const BvhNode& node)
{
    Box box = Box::empty();
    for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++)
        box.grow(slotBox(node, slot));
    return box;
}

/// The box with room for the roundings of kernels at all times. A vertex is between where it is at both ends whatever
/// the rounding, since that is monotonous, and so beyond no plane that stands still. Of one that moves, with u = 2^-24
/// and the largest coordinate m, a vertex' displacement is rounded by 2um at most, its product with the time by 2um and
/// the sum by um; the plane's product and sum by as much.
MovingBox widened(MovingBox box)
{
    const Float4 size = maxOf(maxOf(maxOf(box.open.hi, -box.open.lo), maxOf(box.close.hi, -box.close.lo)),
        maxOf(maxOf(box.open.lo, -box.open.hi), maxOf(box.close.lo, -box.close.hi)));
    const Float4 room = size * 6e-7f, none = {};
    const Float4 low = box.open.lo != box.close.lo ? room : none, high = box.open.hi != box.close.hi ? room : none;
    return { { box.open.lo - low, box.open.hi + high }, { box.close.lo - low, box.close.hi + high } };
}

Array<MovingNode> movingNodes(const Array<BvhNode>& open, const Array<BvhNode>& close, float unit)
{
    Array<MovingNode> nodes(open.size());
    const Chunks chunks(nodes.size());
    const auto scaled = [&](const Box& box) { return Box { box.lo * unit, box.hi * unit }; };
    chunks.forEach([&](std::size_t chunk) {
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++) {
            nodes[i] = {};
            for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++) {
                const std::uint32_t child = open[i].child[slot];
                nodes[i].child[slot] = child;
                setBox(nodes[i], slot,
                    child == WEDGE_BVH_LEAF
                        ? MovingBox::empty()
                        : widened({ scaled(slotBox(open[i], slot)), scaled(slotBox(close[i], slot)) }));
            }
        }
    });
    nodes[0].unit = unit;
    return nodes;
}

/// A triangle's vertices in the hierarchy's units, when the shutter opens, and how far each moves.
struct MovingTriangle {
    float open[3][3], move[3][3];

    MovingTriangle(const Mesh& mesh, std::span<const float> close, std::uint32_t triangle, float unit)
    {
        for (std::size_t corner = 0; corner < 3; corner++)
            for (std::size_t axis = 0; axis < 3; axis++) {
                const std::size_t i = 3 * std::size_t { mesh.indices[3 * std::size_t { triangle } + corner] } + axis;
                open[corner][axis] = mesh.positions[i] * unit;
                move[corner][axis] = close[i] * unit - open[corner][axis];
            }
    }

    /// Without area at both ends and halfway, and so at all times: its area's square is a polynomial of the second
    /// degree in each component.
    bool degenerate() const
    {
        for (const float time : { 0.0f, 0.5f, 1.0f }) {
            float edges[2][3];
            for (std::size_t axis = 0; axis < 3; axis++)
                for (std::size_t e = 0; e < 2; e++)
                    edges[e][axis] =
                        (open[e + 1][axis] + move[e + 1][axis] * time) - (open[0][axis] + move[0][axis] * time);
            if (!isDegenerate(edges[0], edges[1]))
                return false;
        }
        return true;
    }
};

void setLane(MovingTriangleBlock& block, unsigned lane, const MovingTriangle& triangle)
{
    float* const open[3][3] = { { block.v0x, block.v0y, block.v0z }, { block.v1x, block.v1y, block.v1z },
        { block.v2x, block.v2y, block.v2z } };
    float* const move[3][3] = { { block.move0x, block.move0y, block.move0z },
        { block.move1x, block.move1y, block.move1z }, { block.move2x, block.move2y, block.move2z } };
    for (std::size_t corner = 0; corner < 3; corner++)
        for (std::size_t axis = 0; axis < 3; axis++) {
            open[corner][axis][lane] = triangle.open[corner][axis];
            move[corner][axis][lane] = triangle.move[corner][axis];
        }
}

/// Fills the blocks of a tree. Degenerate triangles, which it counts, stay as they are: kernels leave out all that have
/// no area at a ray's time.
Array<MovingTriangleBlock> movingBlocks(
    const Bvh& tree, const Mesh& mesh, std::span<const float> close, float unit, std::size_t& degenerate)
{
    Array<MovingTriangleBlock> blocks(tree.blocks.size());
    const Chunks chunks(blocks.size());
    std::vector<std::size_t> counts(chunks.count());
    chunks.forEach([&](std::size_t chunk) {
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++) {
            blocks[i] = {};
            for (unsigned lane = 0; lane < WEDGE_BLOCK_SIZE; lane++) {
                const std::uint32_t triangle = tree.blocks[i].triangle[lane];
                blocks[i].triangle[lane] = triangle;
                if (triangle == WEDGE_NO_TRIANGLE)
                    continue;
                const MovingTriangle moving(mesh, close, triangle, unit);
                setLane(blocks[i], lane, moving);
                counts[chunk] += moving.degenerate();
            }
        }
    });
    for (const std::size_t count : counts)
        degenerate += count;
    return blocks;
}

/// Expected cost of a ray of any time that hits the root's box, in tests of one block.
double meanCost(const Array<MovingNode>& nodes, double traversalCost)
{
    double cost = 0;
    MovingBox root = MovingBox::empty();
    for (std::size_t i = 0; i < nodes.size(); i++)
        for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++) {
            const std::uint32_t child = nodes[i].child[slot];
            if (child == WEDGE_BVH_LEAF)
                continue;
            const MovingBox box = slotBox(nodes[i], slot);
            cost += box.halfArea() * (child & WEDGE_BVH_LEAF ? child & 7u : traversalCost);
            if (i == 0)
                root.grow(box);
        }
    const double area = root.halfArea();
    return area > 0 ? cost / area + traversalCost : 0;
}

/// The hierarchy with the tree of the triangles at a time.
MovingBvh buildAt(float time, const Mesh& mesh, std::span<const float> close, const Config& config)
{
    const std::vector<float> between = positionsAt(mesh.positions, close, time);
    const Bvh tree = build({ between, mesh.indices }, config);
    const std::vector<float> rounded = roundedClose(mesh.positions, close);
    const Array<BvhNode> open = fittedNodes(tree, { mesh });
    const Array<BvhNode> closed = fittedNodes(tree, { { close, mesh.indices }, { rounded, mesh.indices } });
    Box all = nodeBox(open[0]);
    all.grow(nodeBox(closed[0]));
    const float unit = tree.blocks.empty() ? 1.0f : unitOf(all);
    MovingBvh bvh;
    bvh.statistics = tree.statistics;
    bvh.statistics.degenerate = 0;
    bvh.nodes = movingNodes(open, closed, unit);
    bvh.blocks = movingBlocks(tree, mesh, close, unit, bvh.statistics.degenerate);
    bvh.statistics.sahCost = meanCost(bvh.nodes, config.traversalCost);
    bvh.statistics.bytes = bvh.nodes.size() * sizeof(MovingNode) + bvh.blocks.size() * sizeof(MovingTriangleBlock);
    return bvh;
}

} // namespace

MovingBvh buildMoving(const Mesh& mesh, std::span<const float> positionsAtClose, const Config& config)
{
    assert(positionsAtClose.size() == mesh.positions.size());
    const auto start = std::chrono::steady_clock::now();
    Config whole = config;
    whole.extraReferences = 0;
    MovingBvh best = buildAt(0.5f, mesh, positionsAtClose, whole);
    if (config.extraReferences > 0)
        for (const float time : { 0.0f, 1.0f }) {
            MovingBvh other = buildAt(time, mesh, positionsAtClose, whole);
            if (other.statistics.sahCost < best.statistics.sahCost)
                best = std::move(other);
        }
    best.statistics.buildSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return best;
}

} // namespace wedge::bvh
