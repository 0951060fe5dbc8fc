#include "bvh/refit.h"

#include "bvh/chunks.h"
#include "bvh/reference.h"
#include "bvh/triangle_blocks.h"
#include "bvh/wide_node.h"

#include <chrono>
#include <optional>

namespace wedge::bvh {
namespace {

using namespace detail;
using shared::BvhNode;
using shared::TriangleBlock;

/// Calls body with each triangle of a block.
template <typename Body>
void forEachTriangle(const TriangleBlock& block, const Body& body)
{
    for (const std::uint32_t triangle : block.triangle)
        if (triangle != WEDGE_NO_TRIANGLE)
            body(triangle);
}

/// The box of all triangles of the blocks; none if one is not valid.
std::optional<Box> boundsOf(std::span<const TriangleBlock> blocks, const Mesh& mesh)
{
    struct Part {
        Box box = Box::empty();
        bool valid = true;
    };
    const Chunks chunks(blocks.size());
    std::vector<Part> parts(chunks.count());
    chunks.forEach([&](std::size_t chunk) {
        Part part;
        for (std::size_t i = chunks.begin(chunk); i < chunks.end(chunk); i++)
            forEachTriangle(blocks[i], [&](std::uint32_t triangle) {
                bool valid;
                part.box.grow(boxOf(mesh, triangle, valid));
                part.valid &= valid;
            });
        parts[chunk] = part;
    });
    Box box = Box::empty();
    for (const Part& part : parts) {
        if (!part.valid)
            return std::nullopt;
        box.grow(part.box);
    }
    return box;
}

/// What a subtree comes to.
struct Fitted {
    Box box = Box::empty(); ///< in the mesh's coordinates
    double cost = 0; ///< area times cost, summed
    std::size_t degenerate = 0;
};

class Fitter {
public:
    Fitter(Bvh& bvh, const Mesh& mesh, float unit)
        : bvh_(bvh)
        , mesh_(mesh)
        , unit_(unit)
    {
    }

    /// Fits the node and all below it, which lie behind it up to end. A node's children come in the order of its slots.
    Fitted fitNode(std::uint32_t index, std::uint32_t end) const
    {
        constexpr std::uint32_t minParallelNodes = 32;
        BvhNode& node = bvh_.nodes[index];
        std::uint32_t ends[WEDGE_BVH_WIDTH];
        for (unsigned slot = WEDGE_BVH_WIDTH; slot-- > 0;) {
            ends[slot] = end;
            if (!(node.child[slot] & WEDGE_BVH_LEAF))
                end = node.child[slot];
        }
        Fitted fitted[WEDGE_BVH_WIDTH];
        const auto fitSlot = [&](unsigned slot) {
            const std::uint32_t child = node.child[slot];
            if (child == WEDGE_BVH_LEAF)
                return;
            fitted[slot] = child & WEDGE_BVH_LEAF ? fitLeaf(child) : fitNode(child, ends[slot]);
            setBox(node, slot, fitted[slot].box.lo * unit_, fitted[slot].box.hi * unit_);
        };
        if (ends[WEDGE_BVH_WIDTH - 1] - index >= minParallelNodes)
            tbb::parallel_for(0u, unsigned { WEDGE_BVH_WIDTH }, fitSlot);
        else
            for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++)
                fitSlot(slot);
        Fitted all;
        for (const Fitted& child : fitted) {
            all.box.grow(child.box);
            all.cost += child.cost;
            all.degenerate += child.degenerate;
        }
        all.cost += all.box.halfArea() * bvh_.statistics.traversalCost;
        return all;
    }

private:
    Fitted fitLeaf(std::uint32_t child) const
    {
        const std::uint32_t first = (child & ~WEDGE_BVH_LEAF) >> 3, count = child & 7u;
        std::uint32_t triangles[WEDGE_BVH_MAX_LEAF_BLOCKS * WEDGE_BLOCK_SIZE];
        std::size_t used = 0;
        Fitted fitted;
        for (std::uint32_t block = first; block < first + count; block++)
            forEachTriangle(bvh_.blocks[block], [&](std::uint32_t triangle) {
                bool valid;
                triangles[used++] = triangle;
                fitted.box.grow(boxOf(mesh_, triangle, valid));
            });
        fitted.cost = fitted.box.halfArea() * count;
        fitted.degenerate = fillBlocks({ triangles, used }, mesh_, unit_, &bvh_.blocks[first]);
        return fitted;
    }

    Bvh& bvh_;
    const Mesh& mesh_;
    float unit_;
};

} // namespace

bool refit(Bvh& bvh, const Mesh& mesh)
{
    const auto start = std::chrono::steady_clock::now();
    const std::optional<Box> bounds = boundsOf(bvh.blocks, mesh);
    if (!bounds)
        return false;
    if (bvh.blocks.empty())
        return true;
    const float unit = unitOf(*bounds);
    const Fitted fitted = Fitter(bvh, mesh, unit).fitNode(0, static_cast<std::uint32_t>(bvh.nodes.size()));
    bvh.nodes[0].unit = unit;
    const double area = fitted.box.halfArea();
    bvh.statistics.sahCost = area > 0 ? fitted.cost / area : 0;
    bvh.statistics.degenerate = fitted.degenerate;
    bvh.statistics.buildSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return true;
}

} // namespace wedge::bvh
