#pragma once

#include "host/device/limits.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

#include <cstdint>

namespace wedge::benchmark {

/// Bytes of a frame's own buffers on a device, without the scene's and its hierarchy's. keepLayers: as
/// Renderer::render() has it.
std::uint64_t frameBytes(const scene::Scene& described, const device::DeviceInfo& device,
    const render::Settings& settings, bool keepLayers = false);

} // namespace wedge::benchmark
