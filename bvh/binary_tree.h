#pragma once

#include "bvh/box.h"
#include "bvh/bvh.h"

#include <cstring>
#include <memory>

namespace wedge::bvh::detail {

/// The box of one triangle and its index. The index lies in the fourth lane as an integer and is cleared
/// before any arithmetic: as a float it would be a denormal, which costs a hundred cycles an addition.
struct alignas(16) Reference {
    float lo[3];
    std::uint32_t triangle;
    float hi[3];
    std::uint32_t unused;

    Box box() const { return { load(lo), load(hi) }; }
    /// Twice the centre of the box.
    Float4 centre() const { return load(lo) + load(hi); }

private:
    static Float4 load(const float* xyz)
    {
        Int4 bits;
        std::memcpy(&bits, xyz, sizeof bits);
        bits &= Int4 { -1, -1, -1, 0 };
        Float4 lanes;
        std::memcpy(&lanes, &bits, sizeof lanes);
        return lanes;
    }
};

/// A node of the binary tree that the wide one is collapsed from. The left child follows its parent.
struct alignas(64) BinaryNode {
    Box box;
    std::uint32_t first, count; ///< the references below it
    std::uint32_t right; ///< index of the right child; 0 for a leaf
    std::uint32_t height; ///< inner nodes on the longest way down, itself included; 0 for a leaf
    std::uint32_t blocks; ///< triangle blocks of the leaves below
    std::uint32_t wideNodes; ///< written by the collapse: wide nodes below, itself included
};

/// Inner nodes on the longest path of any binary tree that the builder makes. Deep branches of the SAH fall
/// back to median splits in time, which 2^31 triangles need 31 of.
inline constexpr unsigned maxBinaryHeight = 64;
static_assert(maxBinaryHeight <= WEDGE_BVH_STACK, "a tree collapsed to two children a node must fit the stack");

inline std::uint32_t blocksOf(std::uint32_t triangles) { return (triangles + WEDGE_BLOCK_SIZE - 1) / WEDGE_BLOCK_SIZE; }

/// Splits references, at least one, by binned SAH, reorders them so that each node's are contiguous, and
/// returns the nodes; the root is the first. A node over n triangles has the room of 2 n - 1 nodes to itself,
/// which is what makes parallel subtrees land in the same place every time: most of the array stays unused.
std::unique_ptr<BinaryNode[]> buildBinaryTree(std::span<Reference> references, const Config& config);

} // namespace wedge::bvh::detail
