// The passes of frames whose pixels are the receivers: what each sees, point and directional lights, and what becomes
// of filters that are off.
#include "host/render/renderer.h"

#include "kernels/shared/filter_params.h"

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

void Renderer::fallBack(const TermContext& context)
{
    Frame& f = *frame_;
    // Filters do not need it any more.
    const device::Buffer<float>& squares = scratch_->logs;
    const auto part = [&](device::Buffer<float>& filtered, const device::Buffer<float>& noisy,
                          const device::Buffer<float>& deviation) {
        shared::AnalysisParams p =
            analysisParams(context, blockWindow(context.window, 0, context.full().x1, context.full().y1));
        passes_->rows("fallback", PassKind::Filter, "fallback.cl", "fallbackSquares", p, WEDGE_BLOCK_PIXELS, filtered,
            noisy, deviation, squares);
        setRectangle(p, blockWindow(outputWindow(context.settings), 0, context.full().x1, context.full().y1));
        passes_->rows("fallback", PassKind::Filter, "fallback.cl", "fallBack", p, WEDGE_BLOCK_PIXELS, squares,
            f.objectId, noisy, filtered);
    };
    if (!deviceScene_->areaLightList.empty() && context.settings.integrator == Integrator::Path) {
        part(f.direct, f.directNoisy, f.directDeviation);
    }
    if (tracesPaths(context.settings)) {
        part(f.indirect, f.indirectNoisy, f.indirectDeviation);
    }
}

} // namespace wedge::render
