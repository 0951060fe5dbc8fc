#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/common/references.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// How far an image is from a reference.
struct ImageErrors {
    double rmse = 0; ///< linear radiance, all pixels and channels, the reference's noise in it
    double corrected = 0; ///< the same with that noise taken out in quadrature
    double display = 0; ///< RMS of exposed values, clipped to 0 .. 1
    double flip = 0; ///< mean FLIP of the same values
    double energy = 0; ///< mean of all pixels over the reference's, less 1
    double colour = 0; ///< blue over red in the bluest tenth of the reference, over what it is there
};

/// A reference, and what of it images are compared by.
class Truth {
public:
    explicit Truth(Reference reference);

    ImageErrors errorsOf(const image::RgbImage& image) const;

    /// What radiance is multiplied by before it is shown: the median luminance becomes 0.18; 1 where that is black.
    double exposure() const { return exposure_; }
    const Reference& reference() const { return reference_; }

private:
    image::RgbImage shown(const image::RgbImage& image) const;
    double blueOverRed(const image::RgbImage& image) const;

    Reference reference_;
    double exposure_ = 1;
    image::RgbImage shown_;
    std::vector<std::size_t> bluest_; ///< pixels
};

/// The reference of these settings, whose seed is apart from those of what is measured, kept in that folder; a line
/// says where it came from. scene: its name. layer: as imageOf() has it. Throws Error.
Truth obtainTruth(render::Renderer& renderer, render::Settings settings, const std::string& folder,
    const std::string& scene, const std::string& layer = "");

Json dataOf(const ImageErrors& errors);

/// Of several images of one setting: geometric means of errors and of colour, the mean of energy. One or more.
ImageErrors averaged(const std::vector<ImageErrors>& errors);

} // namespace wedge::benchmark
