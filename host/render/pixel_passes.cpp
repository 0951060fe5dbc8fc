// The passes of frames whose pixels are the receivers: what each sees, and point and directional lights.
#include "host/render/renderer.h"

namespace wedge::render {

using device::PassKind;

bool Renderer::primaryPass(const shared::FrameParams& params, bool lit)
{
    const DeviceScene& s = *deviceScene_;
    Frame& f = *frame_;
    bool complete = true;
    try {
        passes_->tiles("primary rays", PassKind::Trace, "primary.cl", "primary", params, 1.0, s.nodes, s.blocks,
            surfaceArguments(s), s.objectIds, s.areaLights,
            static_cast<std::uint32_t>(lit ? s.areaLightList.size() : 0), f.position, f.normal, f.origin, f.geometric,
            f.objectId, f.depth, f.pixelSize, f.diffuse, f.specular, f.emission, f.gloss);
    } catch (const device::Cancelled&) {
        complete = false;
    }
    if (!lit) {
        f.emission.fill(queue_, 0.0f);
    }
    return complete;
}

bool Renderer::deltaLightPass(const shared::FrameParams& params)
{
    const DeviceScene& s = *deviceScene_;
    Frame& f = *frame_;
    try {
        passes_->tiles("point lights", PassKind::Trace, "delta_lights.cl", "deltaLights", params, 1.0, s.deltaLights,
            s.deltaLightCount, s.diameter, s.nodes, s.blocks, f.receivers(), f.diffuse, f.specular, f.direct,
            f.directNoisy, f.rays);
    } catch (const device::Cancelled&) {
        return false;
    }
    return true;
}

} // namespace wedge::render
