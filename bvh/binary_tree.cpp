#include "bvh/binary_tree.h"

#include "bvh/children.h"
#include "bvh/histogram.h"
#include "bvh/partition.h"
#include "bvh/spatial_split.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <optional>

namespace wedge::bvh::detail {
namespace {

/// Below this size a task costs more than it brings.
constexpr std::uint32_t minParallelSubtree = 1024;

/// Children that share less of the root's area than this gain nothing from spatial splits.
constexpr double minOverlap = 5e-3;

/// References that become a subtree: [first, first + count) of one of the two arrays, with room up to first + room.
struct Work {
    std::uint32_t first, count, room;
    unsigned depth, array;
    Bounds bounds;
};

class BinaryBuilder {
public:
    BinaryBuilder(
        ReferenceArrays& references, const MortonRuns* runs, const Mesh& mesh, const Config& config, BinaryTree& tree)
        : arrays_ { references.current.data(), references.other.data() }
        , mesh_(mesh)
        , config_(config)
        , tree_(tree)
        , areaScale_(references.bounds.box.halfArea() > 0 ? 1.0 / references.bounds.box.halfArea() : 1.0)
        , runs_(runs)
        , blockShift_(runs ? 0u : unsigned { std::countr_zero(unsigned { WEDGE_BLOCK_SIZE }) })
        , maxLeaf_(config.maxLeafBlocks << blockShift_)
    {
    }

    /// Builds the subtree of work. arena: of the thread, for subtrees that are too small to be left to another.
    void build(BinaryNode& node, const Work& work, NodeArena* arena) const
    {
        node.box = work.bounds.box;
        const std::optional<Halves> halves = work.count > 1 ? split(work) : std::nullopt;
        if (!halves)
            return makeLeaf(node, work);
        const std::uint32_t leftRoom = leftRoomOf(work, halves->leftCount, halves->rightCount);
        const Work left { work.first, halves->leftCount, leftRoom, work.depth + 1, 1 - work.array, halves->left };
        const Work right { work.first + leftRoom, halves->rightCount, work.room - leftRoom, work.depth + 1,
            1 - work.array, halves->right };
        const bool parallel = work.count >= minParallelSubtree;
        if (!arena || parallel)
            arena = &tree_.arenas.local();
        node.children = arena->allocatePair();
        if (parallel) {
            tbb::parallel_invoke(
                [&] { build(node.children[0], left, nullptr); }, [&] { build(node.children[1], right, nullptr); });
        } else {
            build(node.children[0], left, arena);
            build(node.children[1], right, arena);
        }
        completeNode(node, relativeArea(node), config_.traversalCost);
    }

private:
    float relativeArea(const BinaryNode& node) const { return static_cast<float>(node.box.halfArea() * areaScale_); }

    /// The left child's share of the room: what is spare goes by the counts.
    static std::uint32_t leftRoomOf(const Work& work, std::uint32_t leftCount, std::uint32_t rightCount)
    {
        const std::uint64_t count = std::uint64_t { leftCount } + rightCount;
        return leftCount + static_cast<std::uint32_t>((work.room - count) * leftCount / count);
    }

    void makeLeaf(BinaryNode& node, const Work& work) const
    {
        node.children = nullptr;
        node.first = work.first << (runs_ ? std::countr_zero(unsigned { WEDGE_BLOCK_SIZE }) : 0);
        node.height = 0;
        std::uint32_t* const begin = &tree_.triangles[node.first];
        std::uint32_t* end = begin;
        for (const Reference& reference : from(work)) {
            if (runs_)
                end = std::copy(runs_->triangles.begin() + runs_->first[reference.index],
                    runs_->triangles.begin() + runs_->first[reference.index + 1], end);
            else
                *end++ = reference.index;
        }
        if (runs_)
            std::sort(begin, end);
        node.count = static_cast<std::uint32_t>(end - begin);
        node.blocks = blocksOf(node.count);
        weighLeaf(node, relativeArea(node));
    }

    /// Moves the references of work to the other array, those of the left child to the front and those of the right one
    /// to where its room begins; none to make a leaf.
    std::optional<Halves> split(const Work& work) const
    {
        const bool mayBeLeaf = work.count <= maxLeaf_;
        // A child may hold all but one triangle; median splits must be able to finish it within the height left.
        const bool deep = work.depth + 1 + std::bit_width(work.count - 1) > maxBinaryHeight;
        if (deep)
            return mayBeLeaf ? std::nullopt : std::optional(splitAtMedian(work));
        const Binning binning(work.bounds.centres, std::min(config_.bins, 8 + work.count / 16));
        const Split best = findObjectSplit(from(work), binning, work.bounds.box, blockShift_);
        const auto asLeaf = static_cast<float>((work.count + (1u << blockShift_) - 1) >> blockShift_);
        const bool cut = mayCut(work, best);
        // Cutting is tried before a leaf is made: it may be what makes two children pay.
        if (cut)
            if (std::optional<Halves> halves =
                    splitSpatially(work, mayBeLeaf ? std::min(best.cost, asLeaf - config_.traversalCost) : best.cost))
                return halves;
        if (mayBeLeaf && (best.axis < 0 || asLeaf <= config_.traversalCost + best.cost))
            return std::nullopt;
        if (best.axis < 0)
            return splitAtMedian(work);
        const std::uint32_t rightCount = work.count - best.leftCount;
        Reference* out = to(work);
        const CentreBoxes centres = divide(from(work), out, out + leftRoomOf(work, best.leftCount, rightCount),
            [&](const Reference& reference) { return binning(reference.centre())[best.axis] < best.bin; });
        return Halves { best.leftCount, rightCount, { best.left, centres.left }, { best.right, centres.right } };
    }

    std::span<const Reference> from(const Work& work) const { return { arrays_[work.array] + work.first, work.count }; }
    Reference* to(const Work& work) const { return arrays_[1 - work.array] + work.first; }

    /// A spatial split where it costs less than cost and there is room for it.
    std::optional<Halves> splitSpatially(const Work& work, float cost) const
    {
        SpatialSplitter splitter(from(work), work.bounds.box, mesh_);
        const SpatialSplit best = splitter.find(blockShift_);
        if (best.axis < 0 || best.cost >= cost)
            return std::nullopt;
        Halves halves = splitter.count(best, blockShift_);
        if (std::max(halves.leftCount, halves.rightCount) >= work.count
            || std::min(halves.leftCount, halves.rightCount) == 0 || halves.leftCount + halves.rightCount > work.room)
            return std::nullopt;
        Reference* out = to(work);
        splitter.divide(best, halves, out, out + leftRoomOf(work, halves.leftCount, halves.rightCount));
        return halves;
    }

    /// Whether cutting triangles may pay: there is room for more, and the best halves overlap.
    bool mayCut(const Work& work, const Split& best) const
    {
        if (work.room == work.count || best.axis < 0)
            return false;
        const Box overlap { maxOf(best.left.lo, best.right.lo), minOf(best.left.hi, best.right.hi) };
        for (int axis = 0; axis < 3; axis++)
            if (overlap.hi[axis] < overlap.lo[axis])
                return false;
        return overlap.halfArea() * areaScale_ > minOverlap;
    }

    Halves splitAtMedian(const Work& work) const
    {
        const std::span<const Reference> range = from(work);
        Reference* out = to(work);
        const Float4 extent = work.bounds.centres.hi - work.bounds.centres.lo;
        const int wider = extent[1] > extent[0] ? 1 : 0;
        const int axis = extent[2] > extent[wider] ? 2 : wider;
        const auto key = [axis](const Reference& reference) {
            return std::pair(reference.centre()[axis], reference.index);
        };
        std::vector<std::pair<float, std::uint32_t>> keys(range.size());
        std::transform(range.begin(), range.end(), keys.begin(), key);
        const auto half = static_cast<std::uint32_t>(range.size() / 2);
        std::nth_element(keys.begin(), keys.begin() + half, keys.end());
        Halves halves { half, work.count - half, {}, {} };
        Reference* right = out + leftRoomOf(work, half, halves.rightCount);
        divide(range, out, right, [&](const Reference& reference) { return key(reference) < keys[half]; });
        for (std::uint32_t i = 0; i < half; i++)
            halves.left.add(out[i]);
        for (std::uint32_t i = 0; i < halves.rightCount; i++)
            halves.right.add(right[i]);
        return halves;
    }

    Reference* arrays_[2];
    const Mesh& mesh_;
    const Config& config_;
    BinaryTree& tree_;
    double areaScale_;
    const MortonRuns* runs_; ///< what references refer to, if not to triangles
    unsigned blockShift_;
    std::uint32_t maxLeaf_;
};

} // namespace

BinaryNode* NodeArena::allocatePair()
{
    if (used_ == slabNodes) {
        slabs_.emplace_back(new BinaryNode[slabNodes]);
        used_ = 0;
    }
    used_ += 2;
    return &slabs_.back()[used_ - 2];
}

void buildBinaryTree(
    ReferenceArrays references, std::uint32_t room, const Mesh& mesh, const Config& config, BinaryTree& tree)
{
    tree.triangles.resize(room);
    const Work all { 0, references.count, room, 0, 0, references.bounds };
    BinaryBuilder(references, nullptr, mesh, config, tree).build(tree.root, all, nullptr);
}

void buildBinaryTree(MortonRuns runs, const Mesh& mesh, const Config& config, BinaryTree& tree)
{
    const std::uint32_t count = runs.references.count;
    tree.triangles.resize(std::size_t { count } * WEDGE_BLOCK_SIZE);
    const Work all { 0, count, count, 0, 0, runs.references.bounds };
    BinaryBuilder(runs.references, &runs, mesh, config, tree).build(tree.root, all, nullptr);
}

} // namespace wedge::bvh::detail
