#include "host/render/filters/widening.h"

#include "kernels/shared/packed.h"

#include <algorithm>
#include <cmath>

namespace wedge::render {

using device::PassKind;

int comparedReach(const Settings& settings, float pixels)
{
    return std::min(settings.maxRadius, static_cast<int>(std::ceil(settings.cut * pixels)));
}

bool widens(const Settings& s)
{
    return s.widening > 0 && s.method == Method::AxisAligned && s.filtering == Filtering::Adaptive && !s.published
        && s.shading == Shading::Ratio;
}

int widenReach(const Settings& s)
{
    const float widest = tracesPaths(s) ? std::max(s.widening, s.indirect.widening) : s.widening;
    return widens(s) ? 2 * WEDGE_SHRINK_REACH + comparedReach(s, widest) : 0;
}

Widening::Widening(const TermContext& context, std::string_view pass, const shared::FilterParams& params, float pixels)
    : c_(context)
    , pass_(pass)
    , params_(params)
    , pixels_(pixels)
    // What lens and shutter blur is filtered everywhere, in crops, too.
    , widened_(context.full())
    , shared_(blockWindow(widened_, WEDGE_SHRINK_REACH, context.full().x1, context.full().y1))
    , compared_(blockWindow(shared_, WEDGE_SHRINK_REACH, context.full().x1, context.full().y1))
{
    params_.maxRadius = static_cast<std::uint32_t>(comparedReach(context.settings, pixels));
}

void Widening::compare(
    device::Buffer<float>& value, const device::Buffer<float>& deviation, const device::Buffer<float>& beta) const
{
    Scratch& s = c_.scratch;
    const Frame& f = c_.frame;
    const std::string program = (f.shape.packed() ? "packed_" : "") + std::string("compare_widths.cl");
    const int height = c_.full().y1;
    // A gather takes the widths of all pixels that it reaches.
    c_.passes.rows(pass_, PassKind::Filter, "widen.cl", "comparedWidths", analysisParams(c_, c_.full()),
        WEDGE_BLOCK_PIXELS, c_.fullFrame, pixels_, deviation, f.position, f.normal, f.objectId, beta, s.compared);
    shared::FilterParams p = params_;
    const int reach = static_cast<int>(p.maxRadius);
    setRectangle(
        p, { compared_.x0, std::max(0, compared_.y0 - reach), compared_.x1, std::min(height, compared_.y1 + reach) });
    c_.passes.rows(pass_, PassKind::Filter, program, "compareRows", p, WEDGE_BLOCK_PIXELS, value, beta, s.compared,
        f.position, f.normal, f.objectId, s.narrowRows, s.wideRows, s.narrowCounts, s.rowsEffective);
    setRectangle(p, compared_);
    c_.passes.rows(pass_, PassKind::Filter, program, "compareColumns", p, WEDGE_BLOCK_PIXELS, s.narrowRows, s.wideRows,
        s.narrowCounts, s.rowsEffective, beta, s.compared, f.position, f.normal, f.objectId, value, s.effective);
}

void Widening::apply(const device::Buffer<float>& difference, const device::Buffer<float>& deviation,
    const device::Buffer<float>& weights, device::Buffer<float>& beta) const
{
    Scratch& s = c_.scratch;
    const Frame& f = c_.frame;
    const device::Buffer<float>&squares = s.narrowRows, &variance = s.compared, &shares = s.effective;
    c_.passes.rows(pass_, PassKind::Filter, "widen.cl", "widenSquares", analysisParams(c_, compared_),
        WEDGE_BLOCK_PIXELS, difference, s.effective, deviation, weights, squares, variance);
    c_.passes.rows(pass_, PassKind::Filter, "widen.cl", "wideShares", analysisParams(c_, shared_), WEDGE_BLOCK_PIXELS,
        c_.fullFrame, pixels_, distributedNoise, squares, variance, f.position, f.normal, f.objectId, beta, shares);
    c_.passes.rows(pass_, PassKind::Filter, "widen.cl", "widen", analysisParams(c_, widened_), WEDGE_BLOCK_PIXELS,
        c_.fullFrame, pixels_, shares, f.position, f.normal, f.objectId, beta);
}

void widenDistributed(
    const TermContext& context, Term& term, const shared::DistributedParams& params, const Widening& widening)
{
    Scratch& scratch = context.scratch;
    context.passes.rows(widening.pass(), PassKind::Filter, "distributed.cl", "visibilityOf", params, 1, term.texture,
        term.value, scratch.visibility);
    widening.compare(scratch.visibility, term.deviation, term.beta);
    context.passes.rows(widening.pass(), PassKind::Filter, "analysis.cl", "luminanceOf",
        analysisParams(context, context.full()), 1, shared::textureBits(params.packed, term.shape.light), term.texture,
        scratch.weights);
    widening.apply(scratch.visibility, term.deviation, scratch.weights, term.beta);
}

} // namespace wedge::render
