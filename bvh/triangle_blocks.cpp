#include "bvh/triangle_blocks.h"

#include <algorithm>
#include <cmath>

namespace wedge::bvh::detail {
namespace {

using shared::TriangleBlock;

/// Collapses the degenerate triangles of a block to points and returns how many there are.
std::size_t collapseDegenerate(TriangleBlock& block)
{
    std::uint8_t flat[WEDGE_BLOCK_SIZE];
    for (unsigned i = 0; i < WEDGE_BLOCK_SIZE; i++) {
        const float a[3] = { block.v1x[i] - block.v0x[i], block.v1y[i] - block.v0y[i], block.v1z[i] - block.v0z[i] };
        const float b[3] = { block.v2x[i] - block.v0x[i], block.v2y[i] - block.v0y[i], block.v2z[i] - block.v0z[i] };
        flat[i] = isDegenerate(a, b);
    }
    std::size_t degenerate = 0;
    for (unsigned i = 0; i < WEDGE_BLOCK_SIZE; i++) {
        if (!flat[i])
            continue;
        block.v1x[i] = block.v2x[i] = block.v0x[i];
        block.v1y[i] = block.v2y[i] = block.v0y[i];
        block.v1z[i] = block.v2z[i] = block.v0z[i];
        degenerate += block.triangle[i] != WEDGE_NO_TRIANGLE;
    }
    return degenerate;
}

} // namespace

float unitOf(const Box& box)
{
    float largest = 0;
    for (int axis = 0; axis < 3; axis++)
        largest = std::max({ largest, std::fabs(box.lo[axis]), std::fabs(box.hi[axis]) });
    return largest > 0 ? std::ldexp(1.0f, std::min(-std::ilogb(largest) - 1, 126)) : 1.0f;
}

std::size_t fillBlocks(std::span<const std::uint32_t> triangles, const Mesh& mesh, float unit, TriangleBlock* blocks)
{
    std::size_t degenerate = 0;
    for (std::size_t first = 0; first < triangles.size(); first += WEDGE_BLOCK_SIZE) {
        TriangleBlock& block = blocks[first / WEDGE_BLOCK_SIZE];
        const std::size_t count = std::min<std::size_t>(WEDGE_BLOCK_SIZE, triangles.size() - first);
        if (count < WEDGE_BLOCK_SIZE) {
            block = {};
            std::fill(block.triangle + count, block.triangle + WEDGE_BLOCK_SIZE, WEDGE_NO_TRIANGLE);
        }
        for (std::size_t lane = 0; lane < count; lane++) {
            const std::uint32_t triangle = triangles[first + lane];
            const std::uint32_t* corners = &mesh.indices[3 * std::size_t { triangle }];
            const float* v0 = &mesh.positions[3 * std::size_t { corners[0] }];
            const float* v1 = &mesh.positions[3 * std::size_t { corners[1] }];
            const float* v2 = &mesh.positions[3 * std::size_t { corners[2] }];
            block.v0x[lane] = v0[0] * unit;
            block.v0y[lane] = v0[1] * unit;
            block.v0z[lane] = v0[2] * unit;
            block.v1x[lane] = v1[0] * unit;
            block.v1y[lane] = v1[1] * unit;
            block.v1z[lane] = v1[2] * unit;
            block.v2x[lane] = v2[0] * unit;
            block.v2y[lane] = v2[1] * unit;
            block.v2z[lane] = v2[2] * unit;
            block.triangle[lane] = triangle;
        }
        degenerate += collapseDegenerate(block);
    }
    return degenerate;
}

} // namespace wedge::bvh::detail
