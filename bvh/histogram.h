#pragma once

#include "bvh/reference.h"

#include <span>

namespace wedge::bvh::detail {

/// Maps doubled centres to equal bins between the outermost ones.
struct Binning {
    unsigned bins;
    Float4 origin, scale;

    Binning(const Box& centres, unsigned count);
    Int4 operator()(Float4 centre) const { return __builtin_convertvector((centre - origin) * scale, Int4); }
};

/// The plane before a bin of an axis; axis -1 where no plane separates the centres.
struct Split {
    int axis = -1;
    int bin = 0;
    float cost = 0; ///< area times blocks on both sides, relative to the area of the whole
    std::uint32_t leftCount = 0;
    Box left, right;
};

/// Boxes and counts of the references in each bin of each axis.
class Histogram {
public:
    /// Clears the first bins, which are all that may be used.
    void clear(unsigned bins);
    void add(std::span<const Reference> references, const Binning& binning);
    void merge(const Histogram& other, unsigned bins);

    /// The best plane: one sweep from the right for the areas there, one from the left. box is that of all references;
    /// a block holds 1 << blockShift of them.
    Split bestSplit(unsigned bins, const Box& box, unsigned blockShift) const;

private:
    Box boxes_[maxBins][3];
    std::uint32_t counts_[maxBins][4];
};

/// The best plane between the centres of references, in parallel where there are many.
Split findObjectSplit(
    std::span<const Reference> references, const Binning& binning, const Box& box, unsigned blockShift);

} // namespace wedge::bvh::detail
