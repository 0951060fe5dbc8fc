#include "host/render/frame_graph.h"

namespace wedge::render {
namespace {

/// Calls visit(buffer of the frame, version that it shows) for each that is shown.
template <class Shown, class Visit>
void eachShown(const Shown& shown, Frame& frame, const Visit& visit)
{
    const Surfaces& s = shown.surfaces;
    const Totals& t = shown.totals;
    const auto one = [&](auto& buffer, const graph::Version& version) {
        if (version.graph != 0) {
            visit(buffer, version);
        }
    };
    one(frame.position, s.position);
    one(frame.normal, s.normal);
    one(frame.origin, s.origin);
    one(frame.objectId, s.objectId);
    one(frame.depth, s.depth);
    one(frame.pixelSize, s.pixelSize);
    one(frame.diffuse, s.diffuse);
    one(frame.specular, s.specular);
    one(frame.emission, s.emission);
    one(frame.beauty, t.beauty);
    one(frame.direct, t.direct.filtered);
    one(frame.directNoisy, t.direct.noisy);
    one(frame.directDeviation, t.direct.deviation);
    one(frame.indirectDeviation, t.indirect.deviation);
    one(frame.indirect, t.indirect.filtered);
    one(frame.indirectNoisy, t.indirect.noisy);
    one(frame.samples, t.samples);
    one(frame.indirectSamples, t.indirectSamples);
    one(frame.rays, t.rays);
    one(frame.pathRays, t.pathRays);
    one(frame.samplesTally, t.tallies.samples);
    one(frame.indirectTally, t.tallies.indirectSamples);
    one(frame.raysTally, t.tallies.rays);
    one(frame.pathRaysTally, t.tallies.pathRays);
    one(frame.primaryTaken, shown.primaryTaken);
    one(frame.lensWidth, shown.lensWidth);
    one(frame.motionWidth, shown.motionWidth);
    one(frame.motion, shown.motion);
    for (const auto& [layer, radiance] : shown.unfiltered) {
        one(frame.unfiltered.try_emplace(layer, Frame::none<float>()).first->second, radiance);
    }
    for (const auto& [name, planes] : shown.termLayers) {
        one(frame.termLayers.try_emplace(name, Frame::none<float>()).first->second, planes);
    }
}

} // namespace

Totals imageOf(const Totals& totals)
{
    Totals image;
    image.beauty = totals.beauty;
    image.tallies = totals.tallies;
    if (totals.tallies.samples.graph == 0) {
        static_cast<Counted<Count>&>(image) = totals;
    }
    return image;
}

void FrameGraph::show(const Shown& shown, bool distributed, bool analysed)
{
    shown_ = shown;
    distributed_ = distributed;
    const Window output = outputWindow(settings_);
    Frame nobody { PlaneLayout(settings_.width, settings_.height) };
    eachShown(shown_, nobody, [&](auto&, const graph::Version& version) { graph_.want(version, output); });
    wantsWidths_ = keepsLayers_ && analysed;
    for (const TermWidths& term : widths_) {
        if (wantsWidths_) {
            graph_.want(term.beta, output);
        }
    }
}

FrameGraph::FrameGraph(const Settings& settings, const PreparedScene& scene, bool keepLayers)
    : settings_(settings)
    , keepsLayers_(keepLayers)
    , graph_(settings.width, settings.height, PlaneLayout(settings.width, settings.height).size)
    , terms_(frameTerms(settings, scene))
    , unfiltered_(frameUnfiltered(settings, scene))
{
}

double FrameGraph::workUnits() const
{
    double units = 1.0; // primary rays
    for (const Term& term : terms_) {
        units += term.workUnits;
    }
    for (const UnfilteredOf& added : unfiltered_) {
        units += added.light.workUnits;
    }
    return units;
}

std::unique_ptr<Frame> FrameGraph::outputs(const graph::Execution& execution) const
{
    auto frame = std::make_unique<Frame>(Frame { PlaneLayout(settings_.width, settings_.height) });
    frame->distributed = distributed_;
    frame->keepsLayers = keepsLayers_;
    eachShown(shown_, *frame, [&](auto& buffer, const graph::Version& version) {
        buffer = execution.output<typename std::decay_t<decltype(buffer)>::Element>(version);
    });
    return frame;
}

} // namespace wedge::render
