#include "effects/area_lights/light_widths.h"

namespace wedge::render {

using device::PassKind;
using graph::around;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

/// Weighted sums of `planes` planes over the neighbourhood that slopes spread to.
graph::Handle<Logarithms> spreadOver(FrameBuilder& frame, const shared::AnalysisParams& params, std::uint32_t planes,
    const graph::Handle<Logarithms>& from)
{
    const graph::Argument p = frame.rectangle(params);
    const int radius = static_cast<int>(params.fillRadius);
    auto rows = frame.graph.plane<Logarithms>("spread along rows", graph::floatPlanes(planes));
    auto spread = frame.graph.plane<Logarithms>("spread", graph::floatPlanes(planes));
    frame.blocks("widths", PassKind::Analysis, { "analysis/analysis.cl", "spreadRows" },
        { p, value("planes", planes), reads("in", from, { .x = radius }), writes("out", rows) });
    frame.blocks("widths", PassKind::Analysis, { "analysis/analysis.cl", "spreadColumns" },
        { p, value("planes", planes), reads("in", rows, { .y = radius }), writes("out", spread) });
    return spread;
}

/// From the least slope: eroded and smoothed as the window says, and spread.
void smoothedWidths(FrameBuilder& frame, const shared::AnalysisParams& params, const LightMeasures& of,
    const BothSlopes* both, graph::Handle<Metres>& beta)
{
    const graph::Argument p = frame.rectangle(params);
    const Surfaces& s = frame.surfaces;
    const SlopeWindow window = both != nullptr ? both->window : SlopeWindow();
    const std::uint32_t planes = both != nullptr ? 3 : 2;
    graph::Handle<Extremes> least = of.slopes;
    auto logs = frame.graph.plane<Logarithms>("logarithms", graph::floatPlanes(planes));
    if (window.eroded) {
        least = frame.graph.plane<Extremes>("eroded slopes", graph::floats);
        frame.blocks("widths", PassKind::Analysis, { "analysis/analysis.cl", "erodeSlopes" },
            { p, reads("slopes", of.slopes, around(1)), reads("objectId", s.objectId, around(1)),
                writes("eroded", least) });
    }
    const graph::Argument radius = value("radius", window.radius);
    const graph::Reach near = around(window.radius);
    frame.zero(logs); // what spreads comes from the padding, too
    frame.blocks("widths", PassKind::Analysis, { "analysis/analysis.cl", "smoothSlopes" },
        { p, radius, reads("eroded", least, near), reads("objectId", s.objectId, near), updates("logSlopes", logs) });
    if (both != nullptr) {
        frame.blocks("widths", PassKind::Analysis, { "analysis/two_slopes.cl", "smoothLargest" },
            { p, radius, reads("slopes", of.slopes, near), reads("objectId", s.objectId, near),
                updates("logSlopes", logs) });
    }
    const auto spread = spreadOver(frame, params, planes, logs);
    if (both != nullptr) {
        frame.blocks("widths", PassKind::Analysis, { "analysis/two_slopes.cl", "slopeRatios" },
            { p, reads("logSlopes", logs), reads("spread", spread), writes("ratio", both->ratio) });
    }
    frame.pixels("widths", PassKind::Analysis, { "analysis/analysis.cl", "widths" },
        { p, reads("logSlopes", logs), reads("spread", spread), reads("objectId", s.objectId),
            reads("pixelSize", s.pixelSize), reads("sums", of.lit()), writes("beta", beta) });
    if (both != nullptr && both->widens) {
        frame.pixels("widths", PassKind::Analysis, { "analysis/two_slopes.cl", "widenBetweenSlopes" },
            { p, reads("ratio", both->ratio), updates("beta", beta) });
    }
}

void publishedWidths(FrameBuilder& frame, const shared::AnalysisParams& params, const LightMeasures& of,
    graph::Handle<Metres>& beta, graph::Handle<Count>& wanted)
{
    const graph::Argument p = frame.rectangle(params);
    const Surfaces& s = frame.surfaces;
    auto distances = frame.graph.plane<Logarithms>("distances", graph::floatPlanes(4));
    frame.zero(distances); // what spreads comes from the padding, too
    frame.blocks("widths", PassKind::Analysis, { "analysis/analysis.cl", "publishedDistances" },
        { p, reads("slopes", of.slopes), reads("position", s.position), reads("objectId", s.objectId),
            updates("distances", distances) });
    const auto spread = spreadOver(frame, params, 4, distances);
    frame.pixels("widths", PassKind::Analysis, { "analysis/analysis.cl", "publishedWidths" },
        { p, value("countMu", frame.settings.mu), reads("slopes", of.slopes), reads("distances", spread),
            reads("objectId", s.objectId), reads("pixelSize", s.pixelSize), reads("sums", of.lit()),
            writes("beta", beta), writes("wanted", wanted) });
}

void narrowForLobes(
    FrameBuilder& frame, const shared::AnalysisParams& params, const Arguments& reflected, graph::Handle<Metres>& beta)
{
    // With shading apart from visibility samples know nothing of the lobe.
    const Settings& settings = frame.settings;
    if (!frame.specular() || settings.filtering != Filtering::Adaptive || settings.shading == Shading::Separate) {
        return;
    }
    const Surfaces& s = frame.surfaces;
    frame.pixels("widths", PassKind::Analysis, { "analysis/analysis.cl", "narrowForLobes" },
        joined({ frame.rectangle(params), value("frame", frame.wholeFrame()) }, reflected,
            Arguments { reads("position", s.position), reads("gloss", s.gloss), reads("objectId", s.objectId),
                updates("beta", beta) }));
}

} // namespace

Arguments reflectedSums(const FrameBuilder& frame, const graph::Handle<Sums>& sums)
{
    return graph::together("reflected",
        { reads("sums", sums), reads("diffuse", frame.surfaces.diffuse), reads("specular", frame.surfaces.specular),
            graph::absent("texture", graph::vectors) });
}

Arguments reflectedTexture(const shared::AreaLight& light, const graph::Handle<Texture>& texture)
{
    return graph::together("reflected",
        { graph::absent("sums"), graph::absent("diffuse", graph::vectors), graph::absent("specular", graph::vectors),
            reads("texture", texture), value("light", light) });
}

void lightWidths(FrameBuilder& frame, const shared::AnalysisParams& params, const LightMeasures& of,
    graph::Handle<Metres>& beta, graph::Handle<Count>& wanted, const BothSlopes* both)
{
    const Settings& settings = frame.settings;
    const bool spectrum = settings.sampling == Sampling::Adaptive && settings.counts == Counts::Spectrum;
    if (spectrum || settings.slopes == Slopes::Published) {
        publishedWidths(frame, params, of, beta, wanted);
    }
    if (settings.slopes == Slopes::Smoothed) {
        smoothedWidths(frame, params, of, both, beta);
        narrowForLobes(frame, params, of.reflected, beta);
    }
}

} // namespace wedge::render
