#pragma once

#include "host/image/image.h"
#include "host/render/renderer.h"
#include "host/render/settings.h"

#include <array>
#include <map>
#include <string>

namespace wedge::render {

/// "0.1.0"
const char* version();

/// From world to camera space, for row vectors. As OpenEXR defines it, camera space is left-handed: x right, y up, and
/// z along the view, in metres.
std::array<float, 16> worldToCamera(const scene::Camera& camera);

/// From world space to the image, for row vectors, to be divided by w: (0, 0) is the upper left corner of the full
/// frame and (1, 1) the lower right one. z is 1 - 1 / (distance along the view in metres): 1 at infinity.
std::array<float, 16> worldToNdc(const scene::Camera& camera, int width, int height);

/// What is known about a frame, by the names that docs/command-line.md lists.
std::map<std::string, image::MetadataValue> frameMetadata(
    const Renderer& renderer, const Settings& settings, const FrameStatistics& statistics);

} // namespace wedge::render
