#pragma once

#include "host/graph/layout.h"
#include "host/image/image.h"
#include "host/scene/scene.h"
#include "kernels/shared/camera.h"
#include "kernels/shared/frame.h"

#include <cstddef>
#include <cstdint>

namespace wedge::render {

using graph::PlaneLayout;

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
/// time; beyond the image it sees what a wider one would.
shared::FrameParams frameParams(
    const scene::Scene& scene, const PlaneLayout& layout, const image::Window& window, std::uint32_t seed);

/// The lens, the shutter and the camera's motion for an image of that height. pixelFilter: WEDGE_PIXEL_*.
shared::CameraParams cameraParams(const scene::Scene& scene, std::uint32_t height, std::uint32_t pixelFilter);

} // namespace wedge::render
