#include "bvh/reinsertion.h"

#include "bvh/children.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>

namespace wedge::bvh::detail {
namespace {

constexpr std::uint32_t none = ~0u;

/// A node of the tree as an array, in which subtrees can be moved.
struct FlatNode {
    Box box;
    float area; ///< relative to the root's
    std::uint32_t parent;
    std::uint32_t children[2]; ///< none, none for a leaf
    const BinaryNode* leaf;

    bool isLeaf() const { return children[0] == none; }
};

/// A subtree, the node beside which it would be better off, and the area that this saves.
struct Move {
    std::uint32_t node = none, target = none;
    float gain = 0;
};

class Reinsertion {
public:
    Reinsertion(BinaryTree& tree, const Config& config)
        : tree_(tree)
        , config_(config)
    {
        const double area = tree.root.box.halfArea();
        areaScale_ = area > 0 ? 1 / area : 0;
        flatten(tree.root, none);
    }

    /// Returns how many subtrees were moved.
    std::size_t runRound(double share)
    {
        const std::vector<std::uint32_t> candidates = largest(share);
        std::vector<Move> moves(candidates.size());
        tbb::parallel_for(std::size_t { 0 }, candidates.size(), [&](std::size_t i) { moves[i] = find(candidates[i]); });
        std::sort(moves.begin(), moves.end(),
            [](const Move& a, const Move& b) { return a.gain != b.gain ? a.gain > b.gain : a.node < b.node; });
        std::vector<bool> touched(nodes_.size());
        std::size_t moved = 0;
        for (const Move& move : moves)
            if (move.target != none)
                moved += apply(move, touched);
        return moved;
    }

    /// Writes the tree back; not if it is too high.
    void finish()
    {
        if (heightOf() > WEDGE_BVH_STACK)
            return;
        tbb::enumerable_thread_specific<NodeArena> arenas;
        BinaryNode root;
        rebuild(0, root, 0, arenas);
        tree_.root = root;
        tree_.arenas = std::move(arenas);
    }

private:
    std::uint32_t flatten(const BinaryNode& node, std::uint32_t parent)
    {
        const auto index = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back({ node.box, areaOf(node.box), parent, { none, none }, &node });
        if (node.children)
            for (int i = 0; i < 2; i++) {
                const std::uint32_t child = flatten(node.children[i], index);
                nodes_[index].children[i] = child;
            }
        return index;
    }

    float areaOf(const Box& box) const { return static_cast<float>(box.halfArea() * areaScale_); }

    std::uint32_t siblingOf(std::uint32_t node) const
    {
        const FlatNode& parent = nodes_[nodes_[node].parent];
        return parent.children[parent.children[0] == node ? 1 : 0];
    }

    /// The nodes of largest area that can be moved: neither the root nor its children.
    std::vector<std::uint32_t> largest(double share) const
    {
        std::vector<std::uint32_t> order;
        for (std::uint32_t i = 1; i < nodes_.size(); i++)
            if (nodes_[i].parent != 0)
                order.push_back(i);
        const auto count =
            std::min(order.size(), static_cast<std::size_t>(share * static_cast<double>(nodes_.size())) + 1);
        const auto larger = [&](std::uint32_t a, std::uint32_t b) {
            return nodes_[a].area != nodes_[b].area ? nodes_[a].area > nodes_[b].area : a < b;
        };
        std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(), larger);
        order.resize(count);
        return order;
    }

    /// The best place for a subtree: from its parent upwards, into each sibling's subtree as far as it can still pay.
    Move find(std::uint32_t index) const
    {
        const FlatNode& node = nodes_[index];
        struct Place {
            std::uint32_t node;
            float gain; ///< of the removal, less what the nodes above grow by
        };
        Place stack[2 * WEDGE_BVH_STACK + 64];
        Move best { index, none, 0 };
        std::uint32_t pivot = node.parent, sibling = siblingOf(index);
        float gain = nodes_[pivot].area; // the parent goes
        Box rest = nodes_[sibling].box; // of what stays below the pivot
        for (;;) {
            unsigned top = 0;
            stack[top++] = { sibling, gain };
            while (top > 0) {
                const Place place = stack[--top];
                if (place.gain - node.area <= best.gain)
                    continue;
                const FlatNode& target = nodes_[place.node];
                Box merged = target.box;
                merged.grow(node.box);
                const float beside = place.gain - areaOf(merged);
                if (beside > best.gain && nodes_[place.node].parent != node.parent) {
                    best.target = place.node;
                    best.gain = beside;
                }
                const float below = beside + target.area;
                if (!target.isLeaf() && top + 2 <= std::size(stack)) {
                    stack[top++] = { target.children[0], below };
                    stack[top++] = { target.children[1], below };
                }
            }
            if (pivot == 0)
                return best;
            if (pivot != node.parent) {
                rest.grow(nodes_[sibling].box);
                gain += nodes_[pivot].area - areaOf(rest);
            }
            sibling = siblingOf(pivot);
            pivot = nodes_[pivot].parent;
        }
    }

    /// Makes the move unless an earlier one has changed what it was found with.
    bool apply(const Move& move, std::vector<bool>& touched)
    {
        const std::uint32_t parent = nodes_[move.node].parent, sibling = siblingOf(move.node);
        const std::uint32_t grandparent = nodes_[parent].parent, beside = nodes_[move.target].parent;
        const std::uint32_t all[] = { move.node, parent, sibling, grandparent, move.target, beside };
        for (const std::uint32_t node : all)
            if (node == none || touched[node])
                return false;
        // Moves before this one may have put the target below the node, where boxes are equal but for rounding.
        for (std::uint32_t above = move.target; above != none; above = nodes_[above].parent)
            if (above == move.node)
                return false;
        for (const std::uint32_t node : all)
            touched[node] = true;
        replaceChild(grandparent, parent, sibling);
        // With its parent gone, what was beside the target may have been that parent.
        replaceChild(nodes_[move.target].parent, move.target, parent);
        nodes_[parent].children[0] = move.target;
        nodes_[parent].children[1] = move.node;
        nodes_[move.target].parent = nodes_[move.node].parent = parent;
        fitUpwards(grandparent);
        fitUpwards(parent);
        return true;
    }

    void replaceChild(std::uint32_t parent, std::uint32_t from, std::uint32_t to)
    {
        nodes_[parent].children[nodes_[parent].children[0] == from ? 0 : 1] = to;
        nodes_[to].parent = parent;
    }

    void fitUpwards(std::uint32_t index)
    {
        for (; index != none; index = nodes_[index].parent) {
            FlatNode& node = nodes_[index];
            node.box = nodes_[node.children[0]].box;
            node.box.grow(nodes_[node.children[1]].box);
            node.area = areaOf(node.box);
        }
    }

    unsigned heightOf() const
    {
        unsigned highest = 0;
        std::vector<std::pair<std::uint32_t, unsigned>> stack { { 0, 0 } };
        while (!stack.empty()) {
            const auto [node, depth] = stack.back();
            stack.pop_back();
            highest = std::max(highest, depth);
            if (!nodes_[node].isLeaf())
                for (const std::uint32_t child : nodes_[node].children)
                    stack.emplace_back(child, depth + 1);
        }
        return highest;
    }

    void rebuild(
        std::uint32_t index, BinaryNode& out, unsigned depth, tbb::enumerable_thread_specific<NodeArena>& arenas) const
    {
        const FlatNode& node = nodes_[index];
        if (node.isLeaf()) {
            out = *node.leaf;
            return;
        }
        out.box = node.box;
        out.children = arenas.local().allocatePair();
        const auto child = [&](int i) { rebuild(node.children[i], out.children[i], depth + 1, arenas); };
        if (depth < 10)
            tbb::parallel_invoke([&] { child(0); }, [&] { child(1); });
        else
            for (int i = 0; i < 2; i++)
                child(i);
        completeNode(out, node.area, config_.traversalCost);
    }

    BinaryTree& tree_;
    const Config& config_;
    double areaScale_;
    std::vector<FlatNode> nodes_;
};

} // namespace

void reinsertSubtrees(BinaryTree& tree, const Config& config)
{
    if (!tree.root.children || config.reinsertionRounds == 0)
        return;
    Reinsertion reinsertion(tree, config);
    for (unsigned round = 0; round < config.reinsertionRounds; round++)
        if (reinsertion.runRound(config.reinsertionShare) == 0)
            break;
    reinsertion.finish();
}

} // namespace wedge::bvh::detail
