#pragma once

#include "host/device/buffer.h"
#include "host/device/memory_plan.h"
#include "host/image/image.h"
#include "host/scene/scene.h"
#include "kernels/shared/frame.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace wedge::render {

/// Where pixels lie in a plane: rows padded so that a gather may run past their ends (kernels/shared/frame.h).
struct PlaneLayout {
    PlaneLayout(int width, int height);

    std::uint32_t width, height;
    std::uint32_t stride; ///< elements from row to row
    std::uint64_t size; ///< elements of a plane
    bool operator==(const PlaneLayout&) const = default;
};

/// The buffers that all effects of a frame share. Vectors are three planes one after the other.
class Frame {
public:
    static void plan(device::MemoryPlan& plan, const PlaneLayout& layout);

    Frame(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout);

    PlaneLayout layout;
    device::Buffer<float> position, normal, origin; ///< G-buffer, see kernels/primary.cl
    device::Buffer<float> depth, pixelSize;
    device::Buffer<float> diffuse, specular, emission, gloss;
    device::Buffer<std::uint32_t> objectId;
    device::Buffer<std::uint32_t> rays; ///< rays traced for each pixel
    device::Buffer<float> direct, directNoisy; ///< radiance, filtered and not
    device::Buffer<float> beauty; ///< emission and all that is reflected
    device::Buffer<std::uint32_t> samples; ///< of all area lights

    /// Zeroes what a frame accumulates.
    void clear(device::TimedQueue& queue);
};

/// One light's term: what was accumulated, what the analysis made of it, the filtered result. Used for one light
/// after the other.
class Term {
public:
    static void plan(device::MemoryPlan& plan, const PlaneLayout& layout, bool specular, bool analysed);

    /// channels: 1 (diffuse) or 2 (diffuse and specular). analysed: with the buffers of analysis and filter.
    Term(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout, bool specular,
        bool analysed);

    bool analysed;
    device::Buffer<float> sums; ///< two planes a channel: weights, weights of visible samples
    device::Buffer<float> value; ///< a plane a channel: what is filtered
    device::Buffer<std::uint32_t> taken, wanted; ///< samples
    device::Buffer<float> slopes; ///< s_min, s_max
    device::Buffer<float> beta; ///< metres
    device::Buffer<float> rowsFiltered, filtered; ///< like value
    device::Buffer<float> rowsEffective, effective; ///< equal samples that the gather amounts to
    device::Buffer<float> logSlopes; ///< 4 planes, see analysis.cl
    device::Buffer<float> spreadRows, spread; ///< 4 planes
    device::Buffer<float> demand; ///< and before that, eroded slopes
    device::Buffer<std::uint32_t> histogramCounts, histogramPixels, binCounts; ///< see counts.cl
    device::Buffer<float> histogramSums, binSums, countScale;
};

/// Sets the rectangle x0, y0, x1, y1 that a kernel's parameters have to window, which lies inside the image.
template <class Params>
void setRectangle(Params& params, const image::Window& window)
{
    params.x0 = static_cast<std::uint32_t>(window.x0);
    params.y0 = static_cast<std::uint32_t>(window.y0);
    params.x1 = static_cast<std::uint32_t>(window.x1);
    params.y1 = static_cast<std::uint32_t>(window.y1);
}

/// The frame's constants for the pixels of `window`, tiles included.
shared::FrameParams frameParams(
    const scene::Scene& scene, const PlaneLayout& layout, const image::Window& window, std::uint32_t seed);

} // namespace wedge::render
