#pragma once

#include "host/render/frame.h"

#include <cstdint>
#include <span>
#include <vector>

namespace wedge::render {

/// Of one kind of samples, as the device has them, of each pixel.
struct AskedSamples {
    std::vector<float> values; ///< demands, of the samples of other pixels alone
    std::vector<std::uint32_t> taken; ///< which no count goes below
    std::vector<float>
        uncertainty; ///< variance of a sample's ray, of the pixel's own samples (kernels/analysis/demand.cl)
    float rays; ///< of a sample
    float least; ///< samples of a pixel
    float room; ///< new samples of a tile's pixels together, at most
};

/// The scale of all demands that makes the number of rays `budget`. most: samples of a pixel.
float scaleOf(std::span<const AskedSamples> asked, double budget, float most, const PlaneLayout& frame);

/// Counts that go from what demands ask for to what is the same everywhere.
struct EvenCounts {
    float share = 0; ///< how far; 0: not at all
    float mean = 0; ///< what is the same everywhere
};

/// How far counts of the first kind are to be even. Demands tell what other pixels found, and each pixel's own samples
/// by how much its error is less for that: where things are small and few, as stars are, those who found one ask for
/// samples of others that have none, and even counts are better.
EvenCounts evenCounts(std::span<const AskedSamples> asked, float scale, float most, const PlaneLayout& frame);

} // namespace wedge::render
