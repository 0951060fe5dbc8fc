#include "bvh/narrow_tree.h"

#include "bvh/moving_box.h"
#include "bvh/wide_node.h"

#include <cassert>
#include <limits>

namespace wedge::bvh {
namespace {

using detail::Box;
using detail::MovingBox;
using shared::BvhNode;
using shared::BvhNode4;
using shared::MovingNode;
using shared::MovingNode4;

void setBox(BvhNode4& node, unsigned slot, const Box& box)
{
    node.loX[slot] = box.lo[0];
    node.hiX[slot] = box.hi[0];
    node.loY[slot] = box.lo[1];
    node.hiY[slot] = box.hi[1];
    node.loZ[slot] = box.lo[2];
    node.hiZ[slot] = box.hi[2];
}

/// Some of the children of a wide node, and their box.
template <typename BoxType>
struct Group {
    unsigned slots[WEDGE_BVH_NARROW_WIDTH];
    unsigned count;
    BoxType box;

    /// What it costs to have a node for the group: the chance that a ray must be tested against it, but for a factor.
    double cost() const { return count > 1 ? box.halfArea() : 0.0; }
};

template <typename BoxType>
Group<BoxType> merged(const Group<BoxType>& a, const Group<BoxType>& b)
{
    Group<BoxType> out = a;
    for (unsigned i = 0; i < b.count; i++)
        out.slots[out.count++] = b.slots[i];
    out.box.grow(b.box);
    return out;
}

/// What becomes of the children of one wide node: at most 4 groups.
template <typename Node, typename BoxType>
struct Grouping {
    Group<BoxType> groups[WEDGE_BVH_WIDTH];
    unsigned count = 0;

    explicit Grouping(const Node& node)
    {
        for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++)
            if (node.child[slot] != WEDGE_BVH_LEAF)
                groups[count++] = { { slot }, 1, detail::slotBox(node, slot) };
        while (count > WEDGE_BVH_NARROW_WIDTH)
            mergeCheapest();
    }

private:
    /// Merges the two groups that add the least to the cost of all. Of more than 4 groups of 8 children, two have 3 or
    /// fewer together, so that there always are two whose children fit into a node.
    void mergeCheapest()
    {
        double least = std::numeric_limits<double>::infinity();
        unsigned first = 0, second = 0;
        for (unsigned i = 0; i < count; i++)
            for (unsigned j = i + 1; j < count; j++) {
                if (groups[i].count + groups[j].count > WEDGE_BVH_NARROW_WIDTH)
                    continue;
                BoxType box = groups[i].box;
                box.grow(groups[j].box);
                const double added = box.halfArea() - groups[i].cost() - groups[j].cost();
                if (added < least) {
                    least = added;
                    first = i;
                    second = j;
                }
            }
        assert(first < second);
        groups[first] = merged(groups[first], groups[second]);
        groups[second] = groups[--count];
    }
};

/// WideTree: Bvh or MovingBvh. NarrowNode: of the sort that its nodes become.
template <typename WideTree, typename NarrowNode, typename BoxType>
class Narrowing {
public:
    explicit Narrowing(const WideTree& bvh)
        : bvh_(bvh)
    {
        nodes_.reserve(2 * bvh.nodes.size());
    }

    std::vector<NarrowNode> run()
    {
        emitNode(0);
        nodes_[0].unit = bvh_.nodes[0].unit;
        return std::move(nodes_);
    }

private:
    using WideNode = typename decltype(WideTree::nodes)::value_type;

    /// Appends a node without children. Returns its index.
    std::uint32_t addNode()
    {
        NarrowNode node {};
        for (unsigned slot = 0; slot < WEDGE_BVH_NARROW_WIDTH; slot++)
            setChild(node, slot, BoxType::empty(), WEDGE_BVH_LEAF);
        nodes_.push_back(node);
        return static_cast<std::uint32_t>(nodes_.size() - 1);
    }

    static void setChild(NarrowNode& node, unsigned slot, const BoxType& box, std::uint32_t child)
    {
        setBox(node, slot, box);
        node.child[slot] = child;
    }

    /// Appends the nodes of the wide node and of all below it. Returns the index of the first.
    std::uint32_t emitNode(std::uint32_t wide)
    {
        const Grouping<WideNode, BoxType> grouping(bvh_.nodes[wide]);
        const std::uint32_t index = addNode();
        for (unsigned i = 0; i < grouping.count; i++) {
            const Group<BoxType>& group = grouping.groups[i];
            const std::uint32_t child = group.count == 1 ? emitChild(wide, group.slots[0]) : emitGroup(wide, group);
            setChild(nodes_[index], i, group.box, child);
        }
        return index;
    }

    std::uint32_t emitGroup(std::uint32_t wide, const Group<BoxType>& group)
    {
        const WideNode& from = bvh_.nodes[wide];
        const std::uint32_t index = addNode();
        for (unsigned i = 0; i < group.count; i++) {
            const unsigned slot = group.slots[i];
            const std::uint32_t child = emitChild(wide, slot);
            setChild(nodes_[index], i, detail::slotBox(from, slot), child);
        }
        return index;
    }

    std::uint32_t emitChild(std::uint32_t wide, unsigned slot)
    {
        const std::uint32_t child = bvh_.nodes[wide].child[slot];
        return child & WEDGE_BVH_LEAF ? child : emitNode(child);
    }

    const WideTree& bvh_;
    std::vector<NarrowNode> nodes_;
};

} // namespace

std::vector<BvhNode4> narrow(const Bvh& bvh) { return Narrowing<Bvh, BvhNode4, Box>(bvh).run(); }

std::vector<MovingNode4> narrow(const MovingBvh& bvh)
{
    return Narrowing<MovingBvh, MovingNode4, MovingBox>(bvh).run();
}

} // namespace wedge::bvh
