#pragma once

#include "host/image/image.h"
#include "host/render/renderer.h"
#include "host/render/settings.h"

#include <string>

namespace wedge::benchmark {

/// An image that others are measured against: the mean of two halves with seeds of their own.
struct Reference {
    image::RgbImage image;
    double noise = 0; ///< RMS error of the image, from the difference of its halves
    int spp = 0; ///< of both halves together
    std::string path; ///< where it is kept
    bool cached = false; ///< read, not rendered
    bool otherKernels = false; ///< cached, and rendered with kernels of other source text
    /// Half of the difference of the halves: its square is, pixel by pixel, what the squared error is expected to be.
    image::RgbImage deviation;
};

/// The renderer's last frame, or a layer of it that has a colour. Throws Error if a value is NaN or infinite.
image::RgbImage imageOf(render::Renderer& renderer, const render::Settings& settings,
    const render::FrameStatistics& statistics, const std::string& layer = "");

/// Reads the reference for these settings from the folder, or renders it and keeps it there. settings.spp is the whole
/// number of samples, even; its seed decides those of the halves. The file's name has a hash of the scene's contents,
/// the settings, the size and the version of wedge. The kernels' text is not in it, so that a faster kernel does not
/// cost new references: what was rendered with others is marked, for a warning. layer: as imageOf() has it. Throws
/// Error.
Reference obtainReference(render::Renderer& renderer, const render::Settings& settings, const std::string& folder,
    const std::string& name, const std::string& layer = "");

} // namespace wedge::benchmark
