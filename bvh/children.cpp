#include "bvh/children.h"

#include <algorithm>

namespace wedge::bvh::detail {
namespace {

/// How many of a forest's trees the left child gets; 0 where the subtree is one tree.
unsigned leftShare(const BinaryNode& node, unsigned trees) { return node.shares >> 4 * (trees - 1) & 15u; }

/// Adds the roots of the best forest of at most that many trees to children.
void addForest(BinaryNode& node, unsigned trees, Children& children)
{
    const unsigned left = trees > 1 && node.children ? leftShare(node, trees) : 0;
    if (left == 0) {
        children.nodes[children.count++] = &node;
        return;
    }
    addForest(node.children[0], left, children);
    addForest(node.children[1], trees - left, children);
}

/// Whether every traversal that goes into one of the children finds its stack large enough.
bool fits(const Children& children, unsigned budget)
{
    unsigned height = 0;
    for (unsigned i = 0; i < children.count; i++)
        height = std::max(height, children.nodes[i]->height);
    return children.count - 1 + height <= budget;
}

/// Starts from the two children of root and opens the one of largest area until the node is full or budget spent.
Children openLargest(BinaryNode& root, unsigned budget)
{
    Children children { { &root.children[0], &root.children[1] }, 2 };
    double areas[WEDGE_BVH_WIDTH]; // negative for those that cannot be opened
    const auto areaOf = [&](unsigned i) {
        return children.nodes[i]->children ? children.nodes[i]->box.halfArea() : -1.0;
    };
    areas[0] = areaOf(0);
    areas[1] = areaOf(1);
    while (children.count < WEDGE_BVH_WIDTH) {
        unsigned height = 0, largest = 0;
        for (unsigned i = 0; i < children.count; i++) {
            height = std::max(height, children.nodes[i]->height);
            if (areas[i] > areas[largest])
                largest = i;
        }
        if (areas[largest] < 0 || children.count + height > budget)
            break;
        BinaryNode* opened = children.nodes[largest];
        children.nodes[largest] = &opened->children[0];
        children.nodes[children.count] = &opened->children[1];
        areas[largest] = areaOf(largest);
        areas[children.count] = areaOf(children.count);
        children.count++;
    }
    return children;
}

} // namespace

void weighForest(BinaryNode& node, float area, float traversalCost)
{
    const float* left = node.children[0].costs;
    const float* right = node.children[1].costs;
    float best[WEDGE_BVH_WIDTH + 1];
    std::uint32_t shares[WEDGE_BVH_WIDTH + 1];
    for (unsigned trees = 2; trees <= WEDGE_BVH_WIDTH; trees++) {
        best[trees] = left[0] + right[trees - 2];
        shares[trees] = 1;
        for (unsigned share = 2; share < trees; share++) {
            const float cost = left[share - 1] + right[trees - share - 1];
            if (cost < best[trees]) {
                best[trees] = cost;
                shares[trees] = share;
            }
        }
    }
    const float one = area * traversalCost + best[WEDGE_BVH_WIDTH];
    node.costs[0] = one;
    node.shares = shares[WEDGE_BVH_WIDTH] << 4 * (WEDGE_BVH_WIDTH - 1);
    for (unsigned trees = 2; trees < WEDGE_BVH_WIDTH; trees++) {
        node.costs[trees - 1] = std::min(one, best[trees]);
        node.shares |= best[trees] < one ? shares[trees] << 4 * (trees - 1) : 0;
    }
}

void completeNode(BinaryNode& node, float area, float traversalCost)
{
    weighForest(node, area, traversalCost);
    node.height = 1 + std::max(node.children[0].height, node.children[1].height);
    node.blocks = node.children[0].blocks + node.children[1].blocks;
}

void weighLeaf(BinaryNode& node, float area)
{
    std::fill(std::begin(node.costs), std::end(node.costs), area * static_cast<float>(node.blocks));
}

Children chooseChildren(BinaryNode& root, unsigned budget)
{
    if (!root.children)
        return { { &root }, 1 };
    Children children { {}, 0 };
    const unsigned left = leftShare(root, WEDGE_BVH_WIDTH);
    addForest(root.children[0], left, children);
    addForest(root.children[1], WEDGE_BVH_WIDTH - left, children);
    return fits(children, budget) ? children : openLargest(root, budget);
}

} // namespace wedge::bvh::detail
