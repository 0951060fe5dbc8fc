#include "bvh/bvh.h"

#include "bvh/binary_tree.h"
#include "bvh/reinsertion.h"
#include "bvh/wide_tree.h"

#include <cassert>
#include <chrono>
#include <memory>

namespace wedge::bvh {
namespace {

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

/// The binary tree over the valid triangles of mesh, whose number it returns in valid; null if there are none.
std::unique_ptr<detail::BinaryTree> makeTree(const Mesh& mesh, const Config& config, std::size_t& valid)
{
    auto tree = std::make_unique<detail::BinaryTree>();
    if (config.mortonRuns) {
        detail::MortonRuns runs = detail::makeMortonRuns(mesh);
        valid = runs.triangles.size();
        if (valid > 0)
            detail::buildBinaryTree(std::move(runs), mesh, config, *tree);
    } else {
        const auto roomFor = [&](std::size_t triangles) {
            return static_cast<std::uint32_t>(
                static_cast<double>(triangles) * (1.0 + static_cast<double>(config.extraReferences)));
        };
        detail::ReferenceArrays references = detail::makeReferences(mesh, roomFor(mesh.indices.size() / 3));
        valid = references.count;
        if (valid > 0)
            detail::buildBinaryTree(std::move(references), roomFor(valid), mesh, config, *tree);
    }
    if (valid == 0)
        return nullptr;
    detail::reinsertSubtrees(*tree, config);
    return tree;
}

/// Of the trees with and without spatial splits the one that costs less: what a cut gains at one node it sometimes
/// loses below.
std::unique_ptr<detail::BinaryTree> cheaperTree(const Mesh& mesh, const Config& config, std::size_t& valid)
{
    Config whole = config;
    whole.extraReferences = 0;
    std::unique_ptr<detail::BinaryTree> uncut = makeTree(mesh, whole, valid), cut = makeTree(mesh, config, valid);
    return cut && cut->root.costs[0] < uncut->root.costs[0] ? std::move(cut) : std::move(uncut);
}

} // namespace

Bvh build(const Mesh& mesh, const Config& config)
{
    assert(mesh.indices.size() % 3 == 0 && mesh.positions.size() % 3 == 0);
    // A leaf refers to its first block with 28 bits, and a block holds at least one triangle.
    assert(
        static_cast<double>(mesh.indices.size() / 3) * (1.0 + static_cast<double>(config.extraReferences)) < 1 << 28);
    assert(config.traversalCost > 0 && config.bins >= 2 && config.bins <= maxBins);
    assert(config.maxLeafBlocks >= 1 && config.maxLeafBlocks <= WEDGE_BVH_MAX_LEAF_BLOCKS);
    assert(!(config.mortonRuns && config.extraReferences > 0));
    assert(config.extraReferences >= 0 && config.extraReferences <= 4);

    const auto start = std::chrono::steady_clock::now();
    const std::size_t count = mesh.indices.size() / 3;
    std::size_t valid = 0;
    const std::unique_ptr<detail::BinaryTree> tree =
        config.extraReferences > 0 ? cheaperTree(mesh, config, valid) : makeTree(mesh, config, valid);
    Bvh bvh = tree ? detail::collapse(*tree, mesh, config) : emptyBvh();
    Statistics& statistics = bvh.statistics;
    statistics.traversalCost = config.traversalCost;
    statistics.nodes = bvh.nodes.size();
    statistics.blocks = bvh.blocks.size();
    statistics.skipped = count - valid;
    statistics.triangles = valid;
    statistics.bytes = bvh.nodes.size() * sizeof(shared::BvhNode) + bvh.blocks.size() * sizeof(shared::TriangleBlock);
    statistics.buildSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return bvh;
}

} // namespace wedge::bvh
