#pragma once

#include "host/device/buffer.h"
#include "host/image/image.h"
#include "host/scene/scene.h"
#include "kernels/shared/camera.h"
#include "kernels/shared/frame.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace wedge::render {

/// Where pixels lie in a plane: rows padded so that a gather may run past their ends (kernels/shared/frame.h).
struct PlaneLayout {
    PlaneLayout(int width, int height);

    std::uint32_t width, height;
    std::uint32_t stride; ///< elements from row to row
    std::uint64_t size; ///< elements of a plane, whole parts of buffers (device::partAlignment)
    bool operator==(const PlaneLayout&) const = default;
};

/// What is to be read of a frame, planes of pixels in device memory. Vectors are three planes one after the other. What
/// nobody asked for is empty.
struct Frame {
    template <class T>
    static device::Buffer<T> none()
    {
        return device::Buffer<T>::over(cl::Buffer(), 0, "nothing");
    }

    PlaneLayout layout;
    bool distributed = false; ///< pixels have several receivers, and these are means over them
    bool keepsLayers = false; ///< there is all that layers show
    device::Buffer<float> position = none<float>(), normal = none<float>(), origin = none<float>();
    device::Buffer<float> depth = none<float>(), pixelSize = none<float>();
    device::Buffer<float> diffuse = none<float>(), specular = none<float>(), emission = none<float>();
    device::Buffer<std::uint32_t> objectId = none<std::uint32_t>();
    /// Rays traced for each pixel, without the camera's, and those of them that looked for the nearest surface of a
    /// path. Without layers there are none, and of distributed frames only their sums mean something.
    device::Buffer<std::uint32_t> rays = none<std::uint32_t>(), pathRays = none<std::uint32_t>();
    device::Buffer<float> beauty = none<float>(); ///< emission and all that is reflected
    device::Buffer<float> direct = none<float>(), directNoisy = none<float>(); ///< radiance, filtered and not
    device::Buffer<float> indirect = none<float>(),
                          indirectNoisy = none<float>(); ///< radiance, or how open the hemisphere is
    /// Of the noisy ones' luminances, in 16 bits; of frames that are filtered over time and measure it.
    device::Buffer<float> directDeviation = none<float>(), indirectDeviation = none<float>();
    std::map<std::string, device::Buffer<float>>
        unfiltered = {}; ///< direct light that no filter had, by effects' layers
    std::map<std::string, device::Buffer<float>>
        termLayers = {}; ///< by names of layers of terms, each with its term's (effect.h)
    device::Buffer<std::uint32_t> samples =
        none<std::uint32_t>(); ///< of all terms; without layers of distributed frames alone
    device::Buffer<std::uint32_t> indirectSamples = none<std::uint32_t>(); ///< of the indirect terms

    /// What these add up to, where the pixels are the receivers, see kernels/frame/tally.cl: of samples within
    /// the output.
    device::Buffer<std::uint64_t> samplesTally = none<std::uint64_t>(), indirectTally = none<std::uint64_t>();
    device::Buffer<std::uint64_t> raysTally = none<std::uint64_t>(), pathRaysTally = none<std::uint64_t>();

    // Of distributed frames.
    device::Buffer<std::uint32_t> primaryTaken = none<std::uint32_t>(); ///< primary samples
    device::Buffer<float> motion = none<float>(); ///< planes: pixels that the surface moves while the shutter is open
    device::Buffer<float> lensWidth = none<float>(), motionWidth = none<float>(); ///< see blurs() of distributed.cl
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

/// The lens, the shutter and the camera's motion for an image of that height. pixelFilter: WEDGE_PIXEL_*.
shared::CameraParams cameraParams(const scene::Scene& scene, std::uint32_t height, std::uint32_t pixelFilter);

} // namespace wedge::render
