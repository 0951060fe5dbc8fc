#include "host/render/effects/term_context.h"

namespace wedge::render {

std::uint32_t samplerOf(const TermContext& context)
{
    const bool counts = context.frame.distributed && context.settings.method == Method::AxisAligned;
    return static_cast<std::uint32_t>(counts || context.settings.progressive ? Sampler::Sobol : context.settings.sampler);
}

void replaceTerm(
    const TermContext& context, const Term& term, const shared::DistributedParams& params, device::Buffer<float>& radiance)
{
    context.passes.rows("composite", device::PassKind::Composite, "distributed.cl", "replaceTerm", params, 1, term.texture,
        term.value, context.scratch.filtered, term.beta, term.radiance, radiance);
}

} // namespace wedge::render
