#include "host/render/effects/term_context.h"

namespace wedge::render {

shared::AnalysisParams analysisParams(const TermContext& context, const image::Window& window)
{
    shared::AnalysisParams p {};
    setRectangle(p, window);
    p.width = context.fullFrame.width;
    p.height = context.fullFrame.height;
    p.stride = context.fullFrame.stride;
    p.planeSize = context.fullFrame.planeSize;
    p.packed = context.frame.shape.packed() ? 1 : 0;
    return p;
}

std::uint32_t samplerOf(const TermContext& context)
{
    const bool counts = context.settings.method == Method::AxisAligned;
    return static_cast<std::uint32_t>(
        counts || context.settings.progressive ? Sampler::Sobol : context.settings.sampler);
}

void addFilteredTerm(const TermContext& context, const Term& term, const shared::DistributedParams& params,
    device::Buffer<float>& radiance)
{
    Scratch& scratch = context.scratch;
    shared::DistributedParams p = params;
    const device::Buffer<float>* texture = &term.texture;
    if (context.shutter && context.settings.distributed.blur) {
        context.passes.rows("filter of motion", device::PassKind::Filter, "blur.cl", "blurMotion", params, 1, 3u,
            context.frame.motionWidth, context.frame.motionDirection, term.texture, scratch.rowsFiltered);
        texture = &scratch.rowsFiltered;
        p.plainTexture = 1;
    }
    context.passes.rows("composite", device::PassKind::Composite, "distributed.cl", "addFilteredTerm", p, 1,
        term.texture, *texture, term.value, scratch.filtered, term.beta, term.radiance, radiance);
}

} // namespace wedge::render
