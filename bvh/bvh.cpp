#include "bvh/bvh.h"

#include "bvh/binary_tree.h"
#include "bvh/wide_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

namespace wedge::bvh {
namespace {

using detail::Reference;

/// One reference a triangle; lo[0] is NaN for those to skip.
Reference makeReference(const Mesh& mesh, std::uint32_t triangle)
{
    Reference reference { { 0, 0, 0 }, triangle, { 0, 0, 0 }, 0 };
    bool valid = true;
    for (std::size_t corner = 0; corner < 3; corner++) {
        const std::size_t vertex = mesh.indices[3 * std::size_t { triangle } + corner];
        assert(3 * vertex + 2 < mesh.positions.size());
        for (std::size_t axis = 0; axis < 3; axis++) {
            // Adding 0 makes -0 into 0: which of the two a minimum returns would depend on the order.
            const float x = mesh.positions[3 * vertex + axis] + 0.0f;
            valid &= std::fabs(x) <= maxCoordinate;
            reference.lo[axis] = corner == 0 ? x : std::min(reference.lo[axis], x);
            reference.hi[axis] = corner == 0 ? x : std::max(reference.hi[axis], x);
        }
    }
    if (!valid)
        reference.lo[0] = NAN;
    return reference;
}

std::vector<Reference> makeReferences(const Mesh& mesh)
{
    std::vector<Reference> references(mesh.indices.size() / 3);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, references.size(), 8192), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); i++)
            references[i] = makeReference(mesh, static_cast<std::uint32_t>(i));
    });
    std::erase_if(references, [](const Reference& reference) { return std::isnan(reference.lo[0]); });
    return references;
}

/// A root whose slots are all empty.
Bvh emptyBvh()
{
    shared::BvhNode root {};
    root.unit = 1;
    for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++) {
        root.loX[slot] = root.loY[slot] = root.loZ[slot] = 1e30f;
        root.hiX[slot] = root.hiY[slot] = root.hiZ[slot] = -1e30f;
        root.child[slot] = WEDGE_BVH_LEAF;
    }
    Bvh bvh;
    bvh.nodes.push_back(root);
    bvh.statistics.depth = 1;
    return bvh;
}

} // namespace

Bvh build(const Mesh& mesh, const Config& config)
{
    assert(mesh.indices.size() % 3 == 0 && mesh.positions.size() % 3 == 0);
    // A leaf refers to its first block with 28 bits, and a block holds at least one triangle.
    assert(mesh.indices.size() / 3 < (std::size_t { 1 } << 28));
    assert(config.traversalCost > 0 && config.bins >= 2 && config.bins <= maxBins);
    assert(config.maxLeafBlocks >= 1 && config.maxLeafBlocks <= WEDGE_BVH_MAX_LEAF_BLOCKS);

    const auto start = std::chrono::steady_clock::now();
    std::vector<Reference> references = makeReferences(mesh);
    Bvh bvh;
    if (references.empty()) {
        bvh = emptyBvh();
    } else {
        const auto tree = detail::buildBinaryTree(references, config);
        bvh = detail::collapse(tree.get(), references, mesh, config);
    }
    Statistics& statistics = bvh.statistics;
    statistics.nodes = bvh.nodes.size();
    statistics.blocks = bvh.blocks.size();
    statistics.skipped = mesh.indices.size() / 3 - references.size();
    statistics.bytes = bvh.nodes.size() * sizeof(shared::BvhNode) + bvh.blocks.size() * sizeof(shared::TriangleBlock);
    statistics.buildSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return bvh;
}

} // namespace wedge::bvh
