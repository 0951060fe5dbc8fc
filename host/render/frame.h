#pragma once

#include "host/device/buffer.h"
#include "host/device/memory_plan.h"
#include "host/image/image.h"
#include "host/scene/scene.h"
#include "kernels/shared/camera.h"
#include "kernels/shared/frame.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>

namespace wedge::render {

/// Where pixels lie in a plane: rows padded so that a gather may run past their ends (kernels/shared/frame.h).
struct PlaneLayout {
    PlaneLayout(int width, int height);

    std::uint32_t width, height;
    std::uint32_t stride; ///< elements from row to row
    std::uint64_t size; ///< elements of a plane
    bool operator==(const PlaneLayout&) const = default;
};

/// The buffers that all effects of a frame share. Vectors are three planes one after the other. With a pinhole and nothing
/// that moves the pixels are the receivers of light; else these planes hold means over a pixel's receivers, and those are
/// in planes of their own (waves.h).
class Frame {
public:
    /// distributed: pixels have several receivers.
    static void plan(device::MemoryPlan& plan, const PlaneLayout& layout, bool distributed);

    Frame(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout, bool distributed);

    PlaneLayout layout;
    bool distributed;
    device::Buffer<float> position, normal, origin; ///< G-buffer, see kernels/primary.cl
    device::Buffer<float> depth, pixelSize;
    device::Buffer<float> diffuse, specular, emission, gloss;
    device::Buffer<std::uint32_t> geometric; ///< geometric normal, packed
    device::Buffer<std::uint32_t> objectId;
    device::Buffer<std::uint32_t> rays; ///< rays traced for each pixel, without the camera's
    device::Buffer<std::uint32_t> pathRays; ///< those of them that looked for the nearest surface of a path
    device::Buffer<float> direct, directNoisy; ///< radiance, filtered and not
    device::Buffer<float> indirect, indirectNoisy; ///< radiance, or how open the hemisphere is
    device::Buffer<float> beauty; ///< emission and all that is reflected
    device::Buffer<std::uint32_t> samples; ///< of all terms
    device::Buffer<std::uint32_t> indirectSamples; ///< of the indirect terms
    device::Buffer<std::uint32_t> receiverPixels, receiverViews; ///< WEDGE_RECEIVER_PARAMETERS: of no use here
    device::Buffer<float> receiverTimes; ///< likewise

    // Of distributed frames.
    device::Buffer<std::uint32_t> primaryTaken, primaryWanted; ///< primary samples
    device::Buffer<std::uint32_t> hits; ///< those of them that met a surface
    device::Buffer<float> confusion; ///< planes: least and largest signed radius of the circle of confusion, pixels
    device::Buffer<float> motion; ///< planes: pixels that the surface moves while the shutter is open; largest difference
    device::Buffer<float> lensWidth, motionWidth, motionDirection; ///< of the image's filters, see blurs() of distributed.cl
    device::Buffer<float> primaryDemand;
    device::Buffer<float> delta; ///< radiance from point and directional lights
    device::Buffer<float> emissionSquares; ///< mean squared luminance of a primary sample's emission

    /// What kernels take for WEDGE_RECEIVER_PARAMETERS, the pixels being the receivers.
    auto receivers() const
    {
        return std::tie(position, normal, origin, geometric, objectId, gloss, receiverPixels, receiverViews, receiverTimes);
    }

    /// Zeroes what a frame accumulates.
    void clear(device::TimedQueue& queue);
};

/// Planes that the terms of a frame need.
struct TermShape {
    std::uint32_t sums = 0, values = 0; ///< accumulated; filtered
    std::uint32_t extremes = 0; ///< slopes, or distances of reflectors
    bool analysed = false; ///< with the buffers of analysis and filter
    bool distributed = false; ///< with those of pixels of several receivers, whose sums are the receivers' own
    bool published = false; ///< of those, with the radiance of the term alone

    /// Whether buffers of this shape serve terms of the other.
    bool holds(const TermShape& other) const;
    /// What serves both.
    TermShape with(const TermShape& other) const;
};

/// One term: what was accumulated, and what the analysis made of it. Where the pixels are the receivers, one such serves one
/// term after the other.
class Term {
public:
    static void plan(device::MemoryPlan& plan, const PlaneLayout& layout, const TermShape& shape);

    Term(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout, const TermShape& shape);

    /// Forgets the term before.
    void clear(device::TimedQueue& queue);

    TermShape shape;
    device::Buffer<float> sums; ///< see area_light.cl, indirect.cl
    device::Buffer<float> value; ///< what is filtered
    device::Buffer<std::uint32_t> taken, wanted; ///< samples
    device::Buffer<float> extremes; ///< of lights: s_min, s_max; of indirect light see indirect.cl
    device::Buffer<float> beta; ///< metres
    device::Buffer<float> texture, plain, squares, textureSquares; ///< of distributed frames, see accumulate.cl
    device::Buffer<float> demand; ///< likewise: of samples
    device::Buffer<float> radiance; ///< likewise, as published: of the term alone

    /// What kernels take for WEDGE_TERM_PARAMETERS.
    auto accumulated() const
    {
        return std::tie(wanted, taken, texture, value, plain, squares, textureSquares, radiance, extremes);
    }
};

/// What analysis and filter need besides, for one term after the other.
class Scratch {
public:
    /// values: planes of the terms' values at most.
    static void plan(device::MemoryPlan& plan, const PlaneLayout& layout, std::uint32_t values);

    Scratch(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout, std::uint32_t values);

    std::uint32_t values;
    device::Buffer<float> rowsFiltered, filtered; ///< like value
    device::Buffer<float> rowsEffective, effective; ///< equal samples that the gather amounts to
    device::Buffer<float> logs; ///< 4 planes: logarithms of slopes and weights, see analysis.cl; of indirect light variances
    device::Buffer<float> rowsSpread, spread; ///< 4 planes: the same, summed over a neighbourhood
    device::Buffer<float> demand; ///< and before that, eroded slopes
    device::Buffer<float> bounds, extent; ///< of what the camera sees, see reflectors.cl
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

/// The frame's constants for the pixels of `window`, tiles included. The camera is that of the middle of the shutter's time.
shared::FrameParams frameParams(
    const scene::Scene& scene, const PlaneLayout& layout, const image::Window& window, std::uint32_t seed);

/// The lens, the shutter and the camera's motion for an image of that height. antialias: a pixel's rays go through all of
/// its square.
shared::CameraParams cameraParams(const scene::Scene& scene, std::uint32_t height, bool antialias);

} // namespace wedge::render
