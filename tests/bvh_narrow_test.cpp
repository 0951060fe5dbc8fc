// The 4-wide tree made of the 8-wide hierarchy.
#include "bvh/narrow_tree.h"
#include "tests/bvh_meshes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <span>

using namespace wedge;
using namespace wedge::test;
using shared::BvhNode;
using shared::BvhNode4;

namespace {

using Bounds = std::array<float, 6>; // lo, then hi

template <typename Node>
Bounds slotBounds(const Node& node, std::size_t slot)
{
    return { node.loX[slot], node.loY[slot], node.loZ[slot], node.hiX[slot], node.hiY[slot], node.hiZ[slot] };
}

bool contains(const Bounds& outer, const Bounds& inner)
{
    for (std::size_t axis = 0; axis < 3; axis++)
        if (inner[axis] < outer[axis] || inner[axis + 3] > outer[axis + 3])
            return false;
    return true;
}

/// The leaves of a tree with their boxes, and what a walk through all of it finds out.
struct Walk {
    std::map<std::uint32_t, Bounds> leaves;
    std::vector<unsigned> visits; ///< of each node
    bool nested = true; ///< all boxes lie within their parents'
    bool emptyLast = true; ///< empty slots come last and can't be entered
    unsigned stack = 0; ///< most entries that a traversal leaves, whichever child it takes at each node

    template <typename Nodes>
    explicit Walk(const Nodes& nodes)
        : visits(nodes.size())
    {
        stack = visit(std::span(nodes), 0, Bounds { -1, -1, -1, 1, 1, 1 });
    }

private:
    template <typename Node>
    unsigned visit(std::span<const Node> nodes, std::size_t index, const Bounds& outer)
    {
        REQUIRE(index < nodes.size());
        const Node& node = nodes[index];
        REQUIRE(visits[index]++ == 0);
        unsigned used = 0, below = 0;
        for (std::size_t slot = 0; slot < std::size(node.child); slot++) {
            const std::uint32_t child = node.child[slot];
            const Bounds bounds = slotBounds(node, slot);
            if (child == WEDGE_BVH_LEAF) {
                emptyLast &= bounds == Bounds { 1e30f, 1e30f, 1e30f, -1e30f, -1e30f, -1e30f };
                continue;
            }
            emptyLast &= used == slot;
            used++;
            nested &= contains(outer, bounds);
            if (child & WEDGE_BVH_LEAF)
                CHECK(leaves.emplace(child, bounds).second);
            else
                below = std::max(below, visit(nodes, child, bounds));
        }
        return below + std::max(used, 1u) - 1;
    }
};

/// One node over leaves with these boxes, the i-th at block i.
bvh::Bvh oneNode(const std::vector<Bounds>& boxes)
{
    bvh::Bvh bvh;
    BvhNode node {};
    node.unit = 0.25f;
    for (std::size_t slot = 0; slot < WEDGE_BVH_WIDTH; slot++) {
        const bool used = slot < boxes.size();
        const Bounds b = used ? boxes[slot] : Bounds { 1e30f, 1e30f, 1e30f, -1e30f, -1e30f, -1e30f };
        float* const planes[] = { node.loX, node.loY, node.loZ, node.hiX, node.hiY, node.hiZ };
        for (std::size_t i = 0; i < 6; i++)
            planes[i][slot] = b[i];
        node.child[slot] = used ? WEDGE_BVH_LEAF | static_cast<std::uint32_t>(slot) << 3 | 1u : WEDGE_BVH_LEAF;
    }
    bvh.nodes.push_back(node);
    return bvh;
}

} // namespace

TEST_CASE("The narrow tree has the leaves of the wide one in boxes that nest, and needs no more of the stack")
{
    for (const TestMesh& mesh : nastyMeshes())
        for (const bvh::Mode mode : { bvh::Mode::Fast, bvh::Mode::Default, bvh::Mode::Quality }) {
            CAPTURE(mesh.name);
            const bvh::Bvh wide = bvh::build(mesh.view(), bvh::config(mode));
            const std::vector<BvhNode4> narrow = bvh::narrow(wide);
            const Walk from(wide.nodes), to(narrow);
            CHECK(from.leaves == to.leaves);
            CHECK(to.nested);
            CHECK(to.emptyLast);
            CHECK(std::ranges::count(to.visits, 1u) == static_cast<std::ptrdiff_t>(narrow.size()));
            CHECK(from.stack == wide.statistics.stackNeeded);
            CHECK(to.stack <= from.stack);
            CHECK(to.stack <= WEDGE_BVH_STACK);
            CHECK(narrow[0].unit == wide.nodes[0].unit);
            // At best 8 children take 3 nodes, at worst 5.
            CHECK(narrow.size() >= wide.nodes.size());
            CHECK(narrow.size() <= 5 * wide.nodes.size());
        }
}

TEST_CASE("An empty hierarchy becomes one node of empty slots")
{
    const std::vector<BvhNode4> narrow = bvh::narrow(bvh::build({}));
    REQUIRE(narrow.size() == 1);
    CHECK(std::ranges::count(narrow[0].child, WEDGE_BVH_LEAF) == WEDGE_BVH_NARROW_WIDTH);
    const Walk walk(narrow);
    CHECK(walk.leaves.empty());
    CHECK(walk.emptyLast);
    CHECK(walk.stack == 0);
}

TEST_CASE("Up to 4 children stay in one node; more are grouped by where they are")
{
    std::vector<Bounds> boxes;
    for (std::size_t count = 1; count <= WEDGE_BVH_WIDTH; count++) {
        CAPTURE(count);
        // Taken in turn from two far corners, so that slots tell nothing about places.
        const float i = static_cast<float>(boxes.size()), side = boxes.size() % 2 ? 0.9f : -0.9f;
        boxes.push_back({ side, 0.01f * i, 0, side + 0.02f, 0.01f * i + 0.01f, 0.01f });
        const bvh::Bvh wide = oneNode(boxes);
        const std::vector<BvhNode4> narrow = bvh::narrow(wide);
        CHECK(Walk(narrow).leaves == Walk(wide.nodes).leaves);
        CHECK(narrow[0].unit == 0.25f);
        CHECK((narrow.size() == 1) == (count <= 4));
        for (std::size_t node = 1; node < narrow.size(); node++)
            for (std::size_t slot = 1; slot < WEDGE_BVH_NARROW_WIDTH; slot++)
                if (narrow[node].child[slot] != WEDGE_BVH_LEAF)
                    CHECK((narrow[node].loX[slot] > 0) == (narrow[node].loX[0] > 0));
    }
}

TEST_CASE("The narrow tree is the same to the last bit every time")
{
    const bvh::Bvh wide = bvh::build(soup(20000, 0.05f).view());
    const std::vector<BvhNode4> once = bvh::narrow(wide), again = bvh::narrow(wide);
    REQUIRE(once.size() == again.size());
    CHECK(std::memcmp(once.data(), again.data(), once.size() * sizeof(BvhNode4)) == 0);
}
