#pragma once

#include "bvh/memory.h"
#include "kernels/shared/bvh_types.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace wedge::bvh {

/// Triangles to build over; the caller keeps the memory alive during the build only.
struct Mesh {
    std::span<const float> positions; ///< x, y, z of each vertex, any unit
    std::span<const std::uint32_t> indices; ///< three vertices a triangle, each below positions.size() / 3
};

/// What the builder weighs; the defaults are the fastest measured (docs/bvh.md).
struct Config {
    /// Cost of visiting a node, in units of testing one block of triangles. More than 0.
    float traversalCost = 1.0f;
    /// Candidate planes an axis, plus one; 2 to maxBins. Small nodes use fewer.
    unsigned bins = 32;
    /// Blocks a leaf may hold; 1 to WEDGE_BVH_MAX_LEAF_BLOCKS.
    unsigned maxLeafBlocks = WEDGE_BVH_MAX_LEAF_BLOCKS;
    /// Whether to sort triangles along a Morton curve and split runs of it instead of triangles: several times faster
    /// to build, slower to trace.
    bool mortonRuns = false;
    /// References that spatial splits may add, as a share of the triangles, up to 4; 0 for none. Where some are
    /// allowed, the tree without them is built too, and the cheaper one taken. Not with mortonRuns.
    float extraReferences = 0;
    /// Rounds in which subtrees are moved to better places, and the share of all nodes that each tries, by area.
    unsigned reinsertionRounds = 1;
    double reinsertionShare = 0.05;
};
inline constexpr unsigned maxBins = 32;

/// What a hierarchy is for: meshes that change from frame to frame, a picture, or many rays through one mesh.
enum class Mode { Fast, Default, Quality };

/// The mode called "fast", "default" or "quality"; none for other names.
std::optional<Mode> parseMode(std::string_view name);

/// Its name, as parseMode takes it.
std::string_view modeName(Mode mode);

/// The configuration of a mode; Mode::Default gives Config{}.
Config config(Mode mode);

/// Coordinates beyond this are refused like infinities: products of three edges must stay within a float's range.
inline constexpr float maxCoordinate = 1e18f;

/// Edges at a smaller angle than this (its sine) span no area in floats: the triangle is degenerate.
inline constexpr double degenerateSine = 4.8e-7;

/// What a build made of its mesh.
struct Statistics {
    double traversalCost = 0; ///< what a node was taken to cost, in tests of one block
    double sahCost = 0; ///< expected cost of a ray that hits the root's box, in tests of one block
    unsigned depth = 0; ///< nodes on the longest path from the root, itself included
    unsigned stackNeeded = 0; ///< most entries that any traversal can have on its stack, at most WEDGE_BVH_STACK
    std::size_t nodes = 0;
    std::size_t blocks = 0;
    std::size_t triangles = 0; ///< triangles in the leaves, the degenerate ones included
    std::size_t degenerate = 0; ///< of those, the ones without area: they lie in a leaf and are never hit
    std::size_t references = 0; ///< lanes of blocks in use; more than triangles where spatial splits cut some
    std::size_t skipped = 0; ///< triangles left out: a vertex is NaN, infinite or beyond maxCoordinate
    std::size_t bytes = 0; ///< nodes and blocks
    double buildSeconds = 0;
};

/// An 8-wide hierarchy in the layout of kernels/shared/bvh_types.h, to be copied to a device as it is.
struct Bvh {
    Array<shared::BvhNode> nodes; ///< nodes[0] is the root and always there; all its slots are empty if all is
    Array<shared::TriangleBlock> blocks; ///< triangles of a leaf in ascending order of their index
    Statistics statistics;
};

/// Builds the hierarchy of mesh with binned SAH on all threads that oneTBB has. The result depends on mesh and
/// config alone, to the last bit, whatever the number of threads. Asserts that sizes and indices are valid.
Bvh build(const Mesh& mesh, const Config& config = {});

} // namespace wedge::bvh
