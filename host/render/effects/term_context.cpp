#include "host/render/effects/term_context.h"

namespace wedge::render {

void replaceTerm(
    const TermContext& context, const Term& term, const shared::DistributedParams& params, device::Buffer<float>& radiance)
{
    context.passes.rows("composite", device::PassKind::Composite, "distributed.cl", "replaceTerm", params, 1, term.texture,
        term.value, context.scratch.filtered, term.beta, term.radiance, radiance);
}

} // namespace wedge::render
