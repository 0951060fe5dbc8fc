#include "bvh/binary_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>

namespace wedge::bvh::detail {
namespace {

// Below these sizes a task costs more than it brings. Chunks of a reduction are fixed, so that no result
// depends on how the scheduler splits.
constexpr std::uint32_t minParallelSubtree = 2048;
constexpr std::uint32_t minParallelReduce = 32768;
constexpr std::uint32_t reduceChunk = 8192;

/// The box of references and the box of their (doubled) centres.
struct Bounds {
    Box box = Box::empty(), centres = Box::empty();

    void add(const Reference& reference)
    {
        box.grow(reference.box());
        centres.grow(reference.centre());
    }
    void merge(const Bounds& other)
    {
        box.grow(other.box);
        centres.grow(other.centres);
    }
};

/// Maps doubled centres to equal bins between the outermost ones.
struct Binning {
    unsigned bins;
    Float4 origin, scale;

    Binning(const Box& centres, unsigned count)
        : bins(count)
        , origin(centres.lo)
        , scale {}
    {
        for (int axis = 0; axis < 3; axis++) {
            const float extent = centres.hi[axis] - centres.lo[axis];
            // Just below the number of bins, so that the last centre falls into the last one. A flat axis has one.
            scale[axis] = extent > 1e-30f ? static_cast<float>(bins) * 0.99999f / extent : 0.0f;
        }
    }
    Int4 operator()(Float4 centre) const { return __builtin_convertvector((centre - origin) * scale, Int4); }
};

/// Boxes and counts of the references in each bin of each axis.
struct Histogram {
    Box boxes[3][maxBins];
    std::uint32_t counts[3][maxBins];

    explicit Histogram(unsigned bins)
    {
        for (int axis = 0; axis < 3; axis++) {
            std::fill_n(boxes[axis], bins, Box::empty());
            std::fill_n(counts[axis], bins, 0u);
        }
    }
    void add(const Reference& reference, const Binning& binning)
    {
        const Box box = reference.box();
        const Int4 bin = binning(box.lo + box.hi);
        for (int axis = 0; axis < 3; axis++) {
            boxes[axis][bin[axis]].grow(box);
            counts[axis][bin[axis]]++;
        }
    }
    void merge(const Histogram& other, unsigned bins)
    {
        for (int axis = 0; axis < 3; axis++)
            for (unsigned bin = 0; bin < bins; bin++) {
                boxes[axis][bin].grow(other.boxes[axis][bin]);
                counts[axis][bin] += other.counts[axis][bin];
            }
    }
};

/// Folds references [first, last) into a copy of identity, in parallel where that pays.
template <typename Value, typename Add, typename Merge>
Value reduce(std::span<const Reference> references, const Value& identity, const Add& add, const Merge& merge)
{
    const auto fold = [&](const tbb::blocked_range<std::size_t>& range, Value value) {
        for (std::size_t i = range.begin(); i < range.end(); i++)
            add(value, references[i]);
        return value;
    };
    if (references.size() < minParallelReduce)
        return fold({ 0, references.size() }, identity);
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, references.size(), reduceChunk), identity, fold,
        [&](Value a, const Value& b) {
            merge(a, b);
            return a;
        },
        tbb::simple_partitioner());
}

Bounds boundsOf(std::span<const Reference> references)
{
    return reduce(
        references, Bounds {}, [](Bounds& bounds, const Reference& reference) { bounds.add(reference); },
        [](Bounds& a, const Bounds& b) { a.merge(b); });
}

/// The plane before a bin of an axis; axis -1 where no plane separates the centres.
struct Split {
    int axis = -1;
    int bin = 0;
    double cost = 0; ///< area times blocks on both sides
};

/// The best plane of a histogram: one sweep from the right for the areas there, one from the left.
Split bestSplit(const Histogram& histogram, unsigned bins)
{
    Split best;
    for (int axis = 0; axis < 3; axis++) {
        double rightCosts[maxBins];
        std::uint32_t right = 0;
        Box box = Box::empty();
        for (unsigned bin = bins; --bin > 0;) {
            box.grow(histogram.boxes[axis][bin]);
            right += histogram.counts[axis][bin];
            rightCosts[bin] = right ? box.halfArea() * blocksOf(right) : -1.0;
        }
        std::uint32_t left = 0;
        box = Box::empty();
        for (unsigned bin = 1; bin < bins; bin++) {
            box.grow(histogram.boxes[axis][bin - 1]);
            left += histogram.counts[axis][bin - 1];
            if (left == 0 || rightCosts[bin] < 0)
                continue;
            const double cost = box.halfArea() * blocksOf(left) + rightCosts[bin];
            if (best.axis < 0 || cost < best.cost)
                best = { axis, static_cast<int>(bin), cost };
        }
    }
    return best;
}

class BinaryBuilder {
public:
    BinaryBuilder(std::span<Reference> references, BinaryNode* nodes, const Config& config)
        : references_(references)
        , nodes_(nodes)
        , config_(config)
        , maxLeafTriangles_(config.maxLeafBlocks * WEDGE_BLOCK_SIZE)
    {
    }

    /// Builds the subtree over references [first, first + count) into nodes_[index] and the 2 count - 2 after it.
    void build(std::uint32_t index, std::uint32_t first, std::uint32_t count, unsigned depth) const
    {
        const auto range = references_.subspan(first, count);
        const Bounds bounds = boundsOf(range);
        BinaryNode& node = nodes_[index];
        node.box = bounds.box;
        node.first = first;
        node.count = count;
        const std::uint32_t leftCount = count > 1 ? split(range, bounds, depth) : 0;
        if (leftCount == 0) {
            node.right = 0;
            node.height = 0;
            node.blocks = blocksOf(count);
            return;
        }
        const std::uint32_t left = index + 1, right = index + 2 * leftCount;
        const auto buildLeft = [&] { build(left, first, leftCount, depth + 1); };
        const auto buildRight = [&] { build(right, first + leftCount, count - leftCount, depth + 1); };
        if (count >= minParallelSubtree) {
            tbb::parallel_invoke(buildLeft, buildRight);
        } else {
            buildLeft();
            buildRight();
        }
        node.right = right;
        node.height = 1 + std::max(nodes_[left].height, nodes_[right].height);
        node.blocks = nodes_[left].blocks + nodes_[right].blocks;
    }

private:
    /// Moves the left child's references of range to its front and returns their number; 0 to make a leaf.
    std::uint32_t split(std::span<Reference> range, const Bounds& bounds, unsigned depth) const
    {
        const auto count = static_cast<std::uint32_t>(range.size());
        const bool mayBeLeaf = count <= maxLeafTriangles_;
        // A child may hold all but one triangle; median splits must be able to finish it within the height left.
        const bool deep = depth + 1 + std::bit_width(count - 1) > maxBinaryHeight;
        if (!deep) {
            const Binning binning(bounds.centres, std::min(config_.bins, 8 + count / 16));
            const Split best = findSplit(range, binning);
            const double area = bounds.box.halfArea();
            if (mayBeLeaf && (best.axis < 0 || area * blocksOf(count) <= area * config_.traversalCost + best.cost))
                return 0;
            if (best.axis >= 0) {
                const auto isLeft = [&](const Reference& reference) {
                    return binning(reference.centre())[best.axis] < best.bin;
                };
                return static_cast<std::uint32_t>(std::partition(range.begin(), range.end(), isLeft) - range.begin());
            }
        }
        return mayBeLeaf ? 0 : splitAtMedian(range, bounds.centres);
    }

    Split findSplit(std::span<const Reference> range, const Binning& binning) const
    {
        const Histogram histogram = reduce(
            range, Histogram(binning.bins),
            [&](Histogram& bins, const Reference& reference) { bins.add(reference, binning); },
            [&](Histogram& a, const Histogram& b) { a.merge(b, binning.bins); });
        return bestSplit(histogram, binning.bins);
    }

    static std::uint32_t splitAtMedian(std::span<Reference> range, const Box& centres)
    {
        const Float4 extent = centres.hi - centres.lo;
        const int wider = extent[1] > extent[0] ? 1 : 0;
        const int axis = extent[2] > extent[wider] ? 2 : wider;
        const auto middle = range.begin() + static_cast<std::ptrdiff_t>(range.size() / 2);
        std::nth_element(range.begin(), middle, range.end(), [axis](const Reference& a, const Reference& b) {
            const float x = a.lo[axis] + a.hi[axis], y = b.lo[axis] + b.hi[axis];
            return x != y ? x < y : a.triangle < b.triangle;
        });
        return static_cast<std::uint32_t>(range.size() / 2);
    }

    std::span<Reference> references_;
    BinaryNode* nodes_;
    const Config& config_;
    std::uint32_t maxLeafTriangles_;
};

} // namespace

std::unique_ptr<BinaryNode[]> buildBinaryTree(std::span<Reference> references, const Config& config)
{
    const auto count = static_cast<std::uint32_t>(references.size());
    auto nodes = std::make_unique_for_overwrite<BinaryNode[]>(2 * references.size() - 1);
    BinaryBuilder(references, nodes.get(), config).build(0, 0, count, 0);
    return nodes;
}

} // namespace wedge::bvh::detail
