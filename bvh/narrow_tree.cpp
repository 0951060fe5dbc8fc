#include "bvh/narrow_tree.h"

#include "bvh/box.h"

#include <cassert>
#include <limits>

namespace wedge::bvh {
namespace {

using detail::Box;
using detail::Float4;
using shared::BvhNode;
using shared::BvhNode4;

Box slotBox(const BvhNode& node, unsigned slot)
{
    return { Float4 { node.loX[slot], node.loY[slot], node.loZ[slot], 0 },
        Float4 { node.hiX[slot], node.hiY[slot], node.hiZ[slot], 0 } };
}

/// Some of the children of a wide node, and their box.
struct Group {
    unsigned slots[WEDGE_BVH_NARROW_WIDTH];
    unsigned count;
    Box box;

    /// What it costs to have a node for the group: the chance that a ray must be tested against it, but for a factor.
    double cost() const { return count > 1 ? box.halfArea() : 0.0; }
};

Group merged(const Group& a, const Group& b)
{
    Group out = a;
    for (unsigned i = 0; i < b.count; i++)
        out.slots[out.count++] = b.slots[i];
    out.box.grow(b.box);
    return out;
}

/// What becomes of the children of one wide node: at most 4 groups.
struct Grouping {
    Group groups[WEDGE_BVH_WIDTH];
    unsigned count = 0;

    explicit Grouping(const BvhNode& node)
    {
        for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++)
            if (node.child[slot] != WEDGE_BVH_LEAF)
                groups[count++] = Group { { slot }, 1, slotBox(node, slot) };
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
                Box box = groups[i].box;
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

class Narrowing {
public:
    explicit Narrowing(const Bvh& bvh)
        : bvh_(bvh)
    {
        nodes_.reserve(2 * bvh.nodes.size());
    }

    std::vector<BvhNode4> run()
    {
        emitNode(0);
        nodes_[0].unit = bvh_.nodes[0].unit;
        return std::move(nodes_);
    }

private:
    /// Appends a node without children. Returns its index.
    std::uint32_t addNode()
    {
        BvhNode4 node {};
        for (unsigned slot = 0; slot < WEDGE_BVH_NARROW_WIDTH; slot++)
            setChild(node, slot, Box::empty(), WEDGE_BVH_LEAF);
        nodes_.push_back(node);
        return static_cast<std::uint32_t>(nodes_.size() - 1);
    }

    static void setChild(BvhNode4& node, unsigned slot, const Box& box, std::uint32_t child)
    {
        node.loX[slot] = box.lo[0];
        node.hiX[slot] = box.hi[0];
        node.loY[slot] = box.lo[1];
        node.hiY[slot] = box.hi[1];
        node.loZ[slot] = box.lo[2];
        node.hiZ[slot] = box.hi[2];
        node.child[slot] = child;
    }

    /// Appends the nodes of the wide node and of all below it. Returns the index of the first.
    std::uint32_t emitNode(std::uint32_t wide)
    {
        const Grouping grouping(bvh_.nodes[wide]);
        const std::uint32_t index = addNode();
        for (unsigned i = 0; i < grouping.count; i++) {
            const Group& group = grouping.groups[i];
            const std::uint32_t child = group.count == 1 ? emitChild(wide, group.slots[0]) : emitGroup(wide, group);
            setChild(nodes_[index], i, group.box, child);
        }
        return index;
    }

    std::uint32_t emitGroup(std::uint32_t wide, const Group& group)
    {
        const BvhNode& from = bvh_.nodes[wide];
        const std::uint32_t index = addNode();
        for (unsigned i = 0; i < group.count; i++) {
            const unsigned slot = group.slots[i];
            const std::uint32_t child = emitChild(wide, slot);
            setChild(nodes_[index], i, slotBox(from, slot), child);
        }
        return index;
    }

    std::uint32_t emitChild(std::uint32_t wide, unsigned slot)
    {
        const std::uint32_t child = bvh_.nodes[wide].child[slot];
        return child & WEDGE_BVH_LEAF ? child : emitNode(child);
    }

    const Bvh& bvh_;
    std::vector<BvhNode4> nodes_;
};

} // namespace

std::vector<shared::BvhNode4> narrow(const Bvh& bvh) { return Narrowing(bvh).run(); }

} // namespace wedge::bvh
