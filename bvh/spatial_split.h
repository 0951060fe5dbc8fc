#pragma once

#include "bvh/chunks.h"
#include "bvh/reference.h"

#include <span>
#include <vector>

namespace wedge::bvh::detail {

/// A plane that cuts triangles in two where they cross it (Stich, Friedrich, Dietrich, "Spatial Splits in Bounding
/// Volume Hierarchies", 2009).
struct SpatialSplit {
    int axis = -1; ///< -1 where there is none
    int bin = 0; ///< the plane is in front of this one
    float cost = 0; ///< as of Split
    std::uint32_t leftCount = 0, rightCount = 0;
    Box left, right;
};

/// What becomes of a node's references.
struct Halves {
    std::uint32_t leftCount = 0, rightCount = 0;
    Bounds left, right;
};

/// Finds a spatial split of references, which are parts of the mesh's triangles, within their box, and carries it out.
class SpatialSplitter {
public:
    /// Boxes of what is left and right of a plane; empty where nothing is.
    struct Parts {
        Box left, right;
    };

    SpatialSplitter(std::span<const Reference> references, const Box& box, const Mesh& mesh);

    /// The best of the planes at equal distances, three axes of them.
    SpatialSplit find(unsigned blockShift) const;

    /// How many references either side gets. A triangle that crosses the plane goes to one side as a whole where
    /// that costs less than cutting it. To be called before divide.
    Halves count(const SpatialSplit& split, unsigned blockShift);

    /// Copies the references, cut where they have to be, to left and right, in their order. Completes halves.
    void divide(const SpatialSplit& split, Halves& halves, Reference* left, Reference* right) const;

private:
    static constexpr unsigned bins = 16;
    enum class Side : std::uint8_t { Left, Right, Both };

    struct Histogram {
        Box boxes[bins][3];
        std::uint32_t begins[bins][3], ends[bins][3];
    };

    Int4 binOf(Float4 point) const;
    float planeAt(int axis, int bin) const { return box_.lo[axis] + static_cast<float>(bin) * width_[axis]; }
    void add(const Reference& reference, Histogram& histogram) const;
    Parts cutReference(const Reference& reference, const SpatialSplit& split) const;
    Side sideOf(const Reference& reference, const SpatialSplit& split, unsigned blockShift) const;

    std::span<const Reference> references_;
    Box box_;
    const Mesh& mesh_;
    Float4 scale_ {}, width_ {};
    Chunks chunks_;
    std::vector<Side> sides_; ///< of each reference
    std::vector<std::uint32_t> firstLeft_, firstRight_; ///< of each chunk, among all
};

} // namespace wedge::bvh::detail
