#pragma once

#include "host/image/image.h"
#include "host/render/effect.h"
#include "host/render/renderer.h"
#include "host/render/settings.h"

#include <string>
#include <vector>

namespace wedge::render {

/// All layers, in the order in which they are written. The beauty is not among them: it is always there.
std::vector<LayerInfo> knownLayers();

/// The layers that a list "albedo,normal" names, each once; "all" means all that `settings` and the scene make, ""
/// none. Throws UsageError for a name that is unknown, or that these settings do not make.
std::vector<std::string> selectLayers(const std::string& list, const Settings& settings, const PreparedScene& scene);

/// The last frame, over its crop: channels R, G and B, those of the layers, and the metadata of metadata.h.
/// settings: those that the frame was rendered with, with keepLayers for other layers than the beauty. Throws Error if
/// the device fails.
image::LayeredImage readLayers(Renderer& renderer, const Settings& settings, const FrameStatistics& statistics,
    const std::vector<std::string>& layers);

} // namespace wedge::render
