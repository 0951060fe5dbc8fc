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
    std::uint64_t size; ///< elements of a plane, whole parts of buffers (device::partAlignment)
    bool operator==(const PlaneLayout&) const = default;
};

/// What the buffers of a frame are for.
struct FrameShape {
    bool distributed = false; ///< pixels have several receivers
    /// A distributed frame of one image, of which nothing else is read: what that is not made of is left out, and
    /// planes that are needed one after the other share their memory (docs/architecture.md has who lives when).
    bool lean = false;
    bool analysed = true; ///< with filters; of interest to lean frames alone, as what follows
    bool shutter = true,
         deltaLights = true; ///< something moves while it is open; there are point or directional lights

    bool operator==(const FrameShape&) const = default;

    /// What pixels keep is in fewer bits, kernels/accumulate.cl: not where means of many waves have to converge.
    bool packed() const { return lean && analysed; }
    std::uint64_t normalPlanes() const { return packed() ? 1 : 3; }
    std::uint64_t motionPlanes() const { return ofMotion() * (packed() ? 1 : 3); }

    // 1 or 0: what the planes of such buffers are to be multiplied by.
    std::uint64_t kept() const { return lean ? 0 : 1; } ///< of no use to lean frames
    std::uint64_t ofAnalysis() const { return !lean || analysed ? 1 : 0; }
    std::uint64_t ofMotion() const { return distributed && (!lean || (shutter && analysed)) ? 1 : 0; }
    std::uint64_t ofDeltaLights() const { return distributed && (!lean || deltaLights) ? 1 : 0; }
};

/// The buffers that all effects of a frame share. Vectors are three planes one after the other. With a pinhole and
/// nothing that moves the pixels are the receivers of light; else these planes hold means over a pixel's receivers, and
/// those are in planes of their own (waves.h).
class Frame {
public:
    static void plan(device::MemoryPlan& plan, const PlaneLayout& layout, const FrameShape& shape);

    Frame(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout, const FrameShape& shape);

    /// Of pixels that are the receivers, whose planes are still to be filled in.
    explicit Frame(const PlaneLayout& layout);

    PlaneLayout layout;
    FrameShape shape;
    bool distributed; ///< shape.distributed
    device::Buffer<float> position, normal, origin; ///< G-buffer, see kernels/primary.cl
    device::Buffer<float> depth, pixelSize;
    device::Buffer<float> diffuse, specular, emission, gloss;
    device::Buffer<std::uint32_t> geometric; ///< geometric normal, packed
    device::Buffer<std::uint32_t> objectId;
    device::Buffer<std::uint32_t>
        rays; ///< rays traced for each pixel (of lean frames, of a wave), without the camera's
    device::Buffer<std::uint32_t> pathRays; ///< those of them that looked for the nearest surface of a path
    // In lean frames all radiance is added to what is emitted: emission, beauty, direct and indirect are one buffer.
    device::Buffer<float> beauty; ///< emission and all that is reflected
    device::Buffer<float> direct, directNoisy; ///< radiance, filtered and not
    device::Buffer<float> indirect, indirectNoisy; ///< radiance, or how open the hemisphere is
    /// Numbers whose squares are, in the mean, the variances of directNoisy's and indirectNoisy's luminance, see
    /// composite.cl.
    device::Buffer<float> directDeviation, indirectDeviation;
    device::Buffer<std::uint32_t> samples; ///< of all terms
    device::Buffer<std::uint32_t> indirectSamples; ///< of the indirect terms
    device::Buffer<std::uint32_t> receiverPixels, receiverViews; ///< WEDGE_RECEIVER_PARAMETERS: of no use here
    device::Buffer<float> receiverTimes; ///< likewise

    // Of distributed frames.
    device::Buffer<std::uint32_t> primaryTaken; ///< primary samples
    device::Buffer<std::uint32_t> hits; ///< those of them that met a surface
    /// Planes: least and largest signed radius of the circle of confusion, pixels; packed, the one nearest to 0, with
    /// hits.
    device::Buffer<float> confusion;
    /// Planes: pixels that the surface moves while the shutter is open; largest difference; packed, one, see
    /// accumulate.h.
    device::Buffer<float> motion;
    device::Buffer<float>
        lensWidth; ///< of the image's filter, see blurs() of distributed.cl; lean: in the place of pixelSize
    /// Likewise, of textures' filter; packed, in the place of motion and together.
    device::Buffer<float> motionWidth, motionDirection;
    device::Buffer<float> emissionSquares; ///< mean squared luminance of a primary sample's emission
    device::Buffer<float> primaryDemand; ///< of samples; in lean frames in the place of emissionSquares
    device::Buffer<std::uint32_t> primaryWanted; ///< primary samples; packed, in the place of primaryDemand
    device::Buffer<float> delta; ///< radiance from point and directional lights
    device::Buffer<float> deltaSquares; ///< mean squared luminance of a primary sample's

    /// What kernels take for WEDGE_RECEIVER_PARAMETERS, the pixels being the receivers.
    auto receivers() const
    {
        return std::tie(
            position, normal, origin, geometric, objectId, gloss, receiverPixels, receiverViews, receiverTimes);
    }

    /// Zeroes what a frame accumulates.
    void clear(device::TimedQueue& queue);
};

/// Planes that the terms of a frame need.
struct TermShape {
    std::uint32_t sums = 0, values = 0; ///< accumulated; filtered
    std::uint32_t extremes = 0; ///< slopes, or distances of reflectors; packed, of lights the motion of shadows
    bool analysed = false; ///< with the buffers of analysis and filter
    bool distributed = false; ///< with those of pixels of several receivers, whose sums are the receivers' own
    bool published = false; ///< of those, with the radiance of the term alone
    bool lean = false; ///< of those, of a lean frame
    bool light = false; ///< of those, of a light: what packed planes have fewer bits of

    /// Whether buffers of this shape serve terms of the other.
    bool holds(const TermShape& other) const;
    /// Planes of the deviations of its value.
    std::uint64_t deviations() const { return distributed && analysed && !published ? 1 : 0; }
    /// WEDGE_OMITS_* of a wave that is added to such a term.
    std::uint32_t omits() const;
    /// 1 or 0: planes of each of what is measured for the analysis of terms of several receivers a pixel.
    std::uint64_t measured() const { return distributed && (!lean || analysed) ? 1 : 0; }
    bool packed() const { return lean && analysed; } ///< as FrameShape has it
    /// Bytes of a pixel's texture and value.
    std::uint64_t textureBytes() const;
    std::uint64_t valueBytes() const;
    /// What serves both.
    TermShape with(const TermShape& other) const;
};

/// One term: what was accumulated, and what the analysis made of it. Where the pixels are the receivers, one such
/// serves one term after the other.
class Term {
public:
    static void plan(device::MemoryPlan& plan, const PlaneLayout& layout, const TermShape& shape);

    /// Of that frame.
    Term(const device::Device& device, device::TimedQueue& queue, const Frame& frame, const TermShape& shape);

    /// Forgets the term before.
    void clear(device::TimedQueue& queue);

    TermShape shape;
    device::Buffer<float> sums; ///< see area_light.cl, indirect.cl
    device::Buffer<float> value; ///< what is filtered
    /// Samples. In lean frames these are the primary samples': between two passes over the image each term has as many.
    device::Buffer<std::uint32_t> taken;
    device::Buffer<float> extremes; ///< of lights: s_min, s_max; of indirect light see indirect.cl
    device::Buffer<float> texture, plain, squares, textureSquares; ///< of distributed frames, see accumulate.cl
    device::Buffer<float> beta; ///< metres; in lean frames in the place of plain, which it is made with
    device::Buffer<float> demand; ///< of distributed frames: of samples; in lean ones in the place of squares
    device::Buffer<std::uint32_t> wanted; ///< samples; packed, in the place of demand
    device::Buffer<float> radiance; ///< likewise, as published: of the term alone
    device::Buffer<float> deviation; ///< of distributed frames: of the value's samples, see accumulate.h

    /// Samples taken, once all are.
    const device::Buffer<std::uint32_t>& counts() const { return shape.lean ? wanted : taken; }

    /// What kernels take for WEDGE_TERM_PARAMETERS.
    auto accumulated() const
    {
        return std::tie(wanted, taken, texture, value, plain, squares, textureSquares, radiance, deviation, extremes);
    }
};

/// What analysis and filter need besides, for one term after the other. In lean frames it is made of the planes of one
/// piece of memory, and those that overlap are not in use together; waves of receivers have the same memory before and
/// after. No gather has both three planes and effective counts there.
class Scratch {
public:
    /// values: planes of the terms' values at most.
    static void plan(device::MemoryPlan& plan, const PlaneLayout& layout, std::uint32_t values);

    Scratch(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout, std::uint32_t values);
    /// Of a lean frame, in that memory, which has leanPlanes at least.
    Scratch(const device::Device& device, const PlaneLayout& layout, const device::Buffer<float>& memory);

    static constexpr std::uint32_t leanPlanes = 6;

    std::uint32_t values;
    device::Buffer<float> rowsFiltered, filtered; ///< like value
    device::Buffer<float> rowsEffective, effective; ///< equal samples that the gather amounts to
    device::Buffer<float>
        logs; ///< 4 planes: logarithms of slopes and weights, see analysis.cl; of indirect light variances
    device::Buffer<float> rowsSpread, spread; ///< 4 planes: the same, summed over a neighbourhood
    device::Buffer<float> demand; ///< and before that, eroded slopes
    device::Buffer<float> slopes, width; ///< of packed terms: slopes or distances; widths while they are made
    device::Buffer<float> error; ///< of taking texture and irradiance apart
    device::Buffer<float> visibility; ///< of a light, or of indirect light one number for irradiance, to be filtered
    /// Of widening.h: rows filtered with pixels' own widths, then squares; with the wider ones; these, then variances;
    /// equal samples of narrowRows; what values are worth, in lean frames
    /// in the place of narrowCounts.
    device::Buffer<float> narrowRows, wideRows, compared, narrowCounts, weights;
    device::Buffer<float> motionWidth, motionDirection; ///< of packed frames, for the demands; before any gather
    device::Buffer<float> ofTexture, ofAllTextures; ///< variance of one term's, and of all that is not irradiance
    device::Buffer<float> bounds, extent; ///< of what the camera sees, see reflectors.cl
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

/// The frame's constants for the pixels of `window`, tiles included. The camera is that of the middle of the shutter's
/// time.
shared::FrameParams frameParams(
    const scene::Scene& scene, const PlaneLayout& layout, const image::Window& window, std::uint32_t seed);

/// The lens, the shutter and the camera's motion for an image of that height. antialias: a pixel's rays go through all
/// of its square.
shared::CameraParams cameraParams(const scene::Scene& scene, std::uint32_t height, bool antialias);

} // namespace wedge::render
