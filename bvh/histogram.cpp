#include "bvh/histogram.h"

#include "bvh/chunks.h"

#include <algorithm>

namespace wedge::bvh::detail {
namespace {

/// The half areas of three boxes in lanes 0 to 2, lengths measured in 1 / scale; 0 for empty ones.
Float4 halfAreas(const Box* boxes, float scale)
{
    Float4 products[3];
    for (int i = 0; i < 3; i++) {
        const Float4 extent = maxOf(boxes[i].hi - boxes[i].lo, Float4 {}) * scale;
        products[i] = extent * __builtin_shufflevector(extent, extent, 1, 2, 0, 3);
    }
    const Float4 xy = __builtin_shufflevector(products[0], products[1], 0, 4, 1, 5);
    const Float4 z = __builtin_shufflevector(products[0], products[1], 2, 6, 2, 6);
    return __builtin_shufflevector(xy, products[2], 0, 1, 4, 4) + __builtin_shufflevector(xy, products[2], 2, 3, 5, 5)
        + __builtin_shufflevector(z, products[2], 0, 1, 6, 6);
}

Int4 load(const std::uint32_t* four)
{
    Int4 lanes;
    std::memcpy(&lanes, four, sizeof lanes);
    return lanes;
}

} // namespace

Binning::Binning(const Box& centres, unsigned count)
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

void Histogram::clear(unsigned bins)
{
    for (unsigned bin = 0; bin < bins; bin++) {
        std::fill_n(boxes_[bin], 3, Box::empty());
        std::fill_n(counts_[bin], 4, 0u);
    }
}

void Histogram::add(std::span<const Reference> references, const Binning& binning)
{
    for (const Reference& reference : references) {
        const Box box = reference.box();
        const Int4 bin = binning(box.lo + box.hi);
        for (int axis = 0; axis < 3; axis++) {
            boxes_[bin[axis]][axis].grow(box);
            counts_[bin[axis]][axis]++;
        }
    }
}

void Histogram::merge(const Histogram& other, unsigned bins)
{
    for (unsigned bin = 0; bin < bins; bin++)
        for (int axis = 0; axis < 3; axis++) {
            boxes_[bin][axis].grow(other.boxes_[bin][axis]);
            counts_[bin][axis] += other.counts_[bin][axis];
        }
}

Split Histogram::bestSplit(unsigned bins, const Box& box, unsigned blockShift) const
{
    const Float4 extent = box.hi - box.lo;
    const float scale = 1.0f / std::max({ extent[0], extent[1], extent[2], 1e-30f });
    const Int4 roundUp = Int4 {} + ((1 << blockShift) - 1);
    const auto cost = [&](const Box* boxes, Int4 count) {
        return halfAreas(boxes, scale)
            * __builtin_convertvector((count + roundUp) >> static_cast<int>(blockShift), Float4);
    };
    constexpr float none = 1e30f;
    Float4 rightCosts[maxBins];
    Box right[3] = { Box::empty(), Box::empty(), Box::empty() };
    Int4 count {};
    for (unsigned bin = bins; --bin > 0;) {
        for (int axis = 0; axis < 3; axis++)
            right[axis].grow(boxes_[bin][axis]);
        count += load(counts_[bin]);
        rightCosts[bin] = count > 0 ? cost(right, count) : Float4 {} + none;
    }
    Float4 bestCosts = Float4 {} + none;
    Int4 bestBins {};
    Box left[3] = { Box::empty(), Box::empty(), Box::empty() };
    count = Int4 {};
    for (unsigned bin = 1; bin < bins; bin++) {
        for (int axis = 0; axis < 3; axis++)
            left[axis].grow(boxes_[bin - 1][axis]);
        count += load(counts_[bin - 1]);
        const Float4 costs = count > 0 ? cost(left, count) + rightCosts[bin] : Float4 {} + none;
        const Int4 better = costs < bestCosts;
        bestCosts = better ? costs : bestCosts;
        bestBins = better ? Int4 {} + static_cast<int>(bin) : bestBins;
    }
    Split best;
    for (int axis = 0; axis < 3; axis++)
        if (bestCosts[axis] < none && (best.axis < 0 || bestCosts[axis] < bestCosts[best.axis]))
            best.axis = axis;
    if (best.axis < 0)
        return best;
    best.bin = bestBins[best.axis];
    const Box whole[3] = { box, box, box };
    const float area = halfAreas(whole, scale)[0];
    best.cost = area > 0 ? bestCosts[best.axis] / area : none; // a line or a point gains nothing
    best.left = best.right = Box::empty();
    for (int bin = 0; bin < static_cast<int>(bins); bin++) {
        (bin < best.bin ? best.left : best.right).grow(boxes_[bin][best.axis]);
        best.leftCount += bin < best.bin ? counts_[bin][best.axis] : 0;
    }
    return best;
}

Split findObjectSplit(
    std::span<const Reference> references, const Binning& binning, const Box& box, unsigned blockShift)
{
    const Chunks chunks(references.size());
    if (chunks.count() == 1) {
        Histogram histogram;
        histogram.clear(binning.bins);
        histogram.add(references, binning);
        return histogram.bestSplit(binning.bins, box, blockShift);
    }
    const std::unique_ptr<Histogram[]> histograms(new Histogram[chunks.count()]);
    chunks.forEach([&](std::size_t chunk) {
        histograms[chunk].clear(binning.bins);
        histograms[chunk].add(
            references.subspan(chunks.begin(chunk), chunks.end(chunk) - chunks.begin(chunk)), binning);
    });
    for (std::size_t chunk = 1; chunk < chunks.count(); chunk++)
        histograms[0].merge(histograms[chunk], binning.bins);
    return histograms[0].bestSplit(binning.bins, box, blockShift);
}

} // namespace wedge::bvh::detail
