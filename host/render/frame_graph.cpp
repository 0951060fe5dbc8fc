#include "host/render/frame_graph.h"

#include "host/render/distributed_samples.h"
#include "host/render/filter_chain.h"

namespace wedge::render {

using graph::reads;
using graph::updates;

FrameGraph::FrameGraph(const Settings& settings, const PreparedScene& scene, bool keepLayers, bool distributed)
    : settings_(settings)
    , keepsLayers_(keepLayers)
    , distributed_(distributed)
    , layout_(frameLayout(settings, scene))
    , graph_(static_cast<int>(layout_.width), static_cast<int>(layout_.height), layout_.size,
          static_cast<int>(layout_.margin))
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
    for (const Unfiltered& added : unfiltered_) {
        units += added.workUnits;
    }
    return units;
}

void FrameGraph::showWidths(FrameBuilder& frame, const Term& term, const std::shared_ptr<TermState>& state,
    const graph::Handle<Metres>& beta, const graph::Handle<Metres>& pixelSize)
{
    auto widths = graph_.plane<Metres>("filter widths shown", graph::floatPlanes(2));
    frame.zero(widths);
    if (beta.graph != 0) {
        frame.pixels("widths", device::PassKind::Analysis, { "frame/layers.cl", "showWidths" },
            { frame.rectangle(frame.analysisParams()), reads("beta", beta), reads("pixelSize", pixelSize),
                updates("widths", widths) },
            [state](const graph::Run&) { return state->analysed; });
    }
    outputs_.add({ "filterWidth", term.name, widths, Where::OnSurfaces });
}

void FrameGraph::showWidths(
    FrameBuilder& frame, const DistributedSamples& samples, const graph::Handle<Metres>& pixelSize)
{
    for (std::size_t i = 0; frame.analysed() && i < terms_.size(); ++i) {
        const graph::Handle<Metres> none;
        showWidths(
            frame, terms_[i], samples.state(), samples.filters() ? samples.terms()[i]->means.beta : none, pixelSize);
    }
}

void FrameGraph::showTally(FrameBuilder& frame, const std::string& name, const std::string& output, Within within)
{
    const graph::Version counts = outputs_.find(output)->version;
    const bool plane = graph_.resources()[counts.resource].plane;
    const auto elements = static_cast<std::uint32_t>(graph_.resources()[counts.resource].elements);
    auto tally = graph_.list<Tally>(name, tallySums, WEDGE_TALLY_STRIPES);
    frame.zero(tally);
    if (plane) {
        std::optional<graph::Version> mask;
        if (within == Within::Surfaces) {
            mask = outputs_.find("objectId")->version;
        }
        frame.count(counts, within == Within::Image, tally, nullptr, mask);
    } else {
        frame.items("composite", device::PassKind::Composite, { "frame/tally.cl", "addListToTally" },
            WEDGE_TALLY_STRIPES,
            { graph::value("count", elements), graph::readsAsIs("list", counts), updates("tally", tally) });
    }
    outputs_.add(name, tally);
}

bool FrameGraph::showsParts() const { return keepsLayers_ || hasStage(settings_.filters, Stage::Frame); }

void FrameGraph::filterParts(FrameBuilder& frame)
{
    const auto shown = [this](const std::string& name) {
        return graph::Handle<Radiance> { graph::Version { outputs_.find(name)->version } };
    };
    if (hasStage(settings_.filters, Stage::Frame)) {
        for (const char* part : { targets::direct, targets::indirect }) {
            outputs_.replace(part, filteredImage(frame, part, shown(part)), Where::Everywhere);
        }
        outputs_.replace("beauty",
            frame.sumOfParts(frame.rectangle(frame.analysisParams()), "beauty of filtered parts", shown("emission"),
                shown(targets::direct), shown(targets::indirect)));
    }
    outputs_.replace("beauty", filteredImage(frame, targets::image, shown("beauty")));
}

void FrameGraph::finish(FrameBuilder& frame)
{
    filterParts(frame);
    if (distributed_) {
        showTally(frame, "samplesTally", "samples", Within::Surfaces);
        showTally(frame, "indirectTally", "indirectSamples", Within::Surfaces);
        showTally(frame, "raysTally", "raysTraced", Within::Image);
        showTally(frame, "pathRaysTally", "pathRays", Within::Image);
        showTally(frame, "primaryTally", "primarySamples", Within::Image);
        showTally(frame, "primaryShownTally", "primarySamples", Within::Output);
        if (outputs_.find("notFinite") != nullptr) {
            showTally(frame, "notFiniteTally", "notFinite", Within::Output);
        }
    }
    auto shaded = graph_.list<Tally>("tally of shaded pixels", tallySums, WEDGE_TALLY_STRIPES);
    auto matte = graph_.list<Tally>("tally of matte pixels", tallySums, WEDGE_TALLY_STRIPES);
    shared::AnalysisParams p = frame.analysisParams();
    const Window output = frame.output();
    setRectangle(p, output);
    const Output* specular = outputs_.find("specular");
    frame.items("composite", device::PassKind::Composite, { "frame/tally.cl", "countSurfaces" }, WEDGE_TALLY_STRIPES,
        { graph::value("p", p), graph::readsAsIs("objectId", outputs_.find("objectId")->version),
            specular != nullptr ? graph::readsAsIs("specular", specular->version)
                                : graph::absent("specular", graph::vectors),
            graph::writes("shaded", shaded), graph::writes("matte", matte) });
    outputs_.add("shadedTally", shaded);
    outputs_.add("matteTally", matte);
    outputs_.want(graph_, output);
}

std::unique_ptr<Frame> FrameGraph::outputs(const graph::Execution& execution) const
{
    auto frame = std::make_unique<Frame>(Frame { layout_, distributed_, keepsLayers_ });
    for (const Output& output : outputs_.all()) {
        const graph::Resource& resource = graph_.resources()[output.version.resource];
        const auto memory = execution.output<std::byte>(output.version);
        frame->shown.push_back({ output, memory.cl(), resource.bytes(),
            resource.plane ? resource.format.bytes / std::uint32_t { sizeof(float) } : 0,
            resource.format.storage == "uint" });
    }
    return frame;
}

} // namespace wedge::render
