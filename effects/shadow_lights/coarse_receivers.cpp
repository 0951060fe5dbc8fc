#include "effects/shadow_lights/coarse_receivers.h"

#include <stdexcept>
#include <utility>

namespace wedge::render {

using device::PassKind;
using graph::Launch;
using graph::reads;
using graph::writes;

CoarseReceivers::CoarseReceivers(FrameBuilder& frame, graph::Scale scale)
    : f_(frame)
    , scale_(scale)
    , layout_(frame.graph.layout(scale))
{
    Surfaces& s = surfaces_;
    const auto plane = [&]<class Quantity>(
                           graph::Handle<Quantity>& handle, const char* name, const graph::Format& format) {
        handle = f_.graph.plane<Quantity>(std::string("coarse ") + name, format, scale_);
    };
    plane(s.position, "position", graph::vectors);
    plane(s.normal, "normal", graph::vectors);
    plane(s.origin, "origin", graph::vectors);
    plane(s.geometric, "geometric", graph::counts);
    plane(s.objectId, "objectId", graph::counts);
    plane(s.diffuse, "diffuse", graph::vectors);
    plane(s.specular, "specular", graph::vectors);
    plane(s.gloss, "gloss", wholeGloss);
    plane(rays_, "rays", graph::counts);
    f_.zero(rays_);
    copy();
}

void CoarseReceivers::copy()
{
    const Surfaces& from = f_.surfaces;
    Surfaces& to = surfaces_;
    f_.graph.add({ .name = "receivers of few pixels",
        .kind = PassKind::Analysis,
        .kernel = { "light/shadow_resampling.cl", "coarseReceivers" },
        .arguments = joined({ f_.graph.grid("coarse", scale_), f_.graph.grid("full", graph::Scale::Full) },
            graph::together("surfaces",
                { reads("position", from.position), reads("normal", from.normal), reads("origin", from.origin),
                    reads("geometric", from.geometric), reads("objectId", from.objectId),
                    reads("diffuse", from.diffuse), reads("specular", from.specular), reads("gloss", from.gloss) }),
            graph::together("receivers",
                { writes("coarsePosition", to.position), writes("coarseNormal", to.normal),
                    writes("coarseOrigin", to.origin), writes("coarseGeometric", to.geometric),
                    writes("coarseObjectId", to.objectId), writes("coarseDiffuse", to.diffuse),
                    writes("coarseSpecular", to.specular), writes("coarseGloss", to.gloss) })),
        .domain = graph::Domain::Pixels,
        .scale = scale_ });
}

graph::Argument CoarseReceivers::frame() const
{
    return graph::made(
        "frame", [&scene = f_.description, layout = layout_, seed = frameSeed(f_.settings)](const Launch& launch) {
            return frameParams(scene, layout, launch.window, seed);
        });
}

Arguments CoarseReceivers::arguments() const
{
    return graph::together("receivers",
        joined(f_.readBy(ReadBy::Samplers, surfaces_),
            Arguments { graph::absent("pixelOf", graph::counts), graph::absent("view", graph::counts),
                graph::absent("time") }));
}

graph::Argument CoarseReceivers::tallyPathRays() { throw std::logic_error("few pixels have no paths"); }

void CoarseReceivers::trace(std::string name, graph::KernelName kernel, Arguments arguments,
    const std::function<double(const graph::Launch&)>& workUnits)
{
    const auto tiles = [&scene = f_.description, layout = layout_](const Launch& launch) -> std::size_t {
        return frameParams(scene, layout, launch.window, 0).tileCount;
    };
    f_.graph.add({ .name = std::move(name),
        .kind = PassKind::Trace,
        .kernel = std::move(kernel),
        .arguments = std::move(arguments),
        .domain = graph::Domain::Tiles,
        .scale = scale_,
        .count = tiles,
        .itemsOfTile = WEDGE_TILE_PIXELS / f_.packetSize,
        .workUnits = workUnits,
        .stoppable = true });
}

void CoarseReceivers::countRays()
{
    shared::AnalysisParams p {};
    p.width = layout_.width;
    p.height = layout_.height;
    p.stride = layout_.stride;
    p.planeSize = static_cast<std::uint32_t>(layout_.size);
    setRectangle(p, f_.graph.image(scale_));
    f_.items("composite", PassKind::Composite, { "frame/tally.cl", "addToTally" }, WEDGE_TALLY_STRIPES,
        { graph::value("p", p), graph::readsAsIs("counts", rays_), graph::absent("mask", graph::counts),
            graph::updates("tally", f_.totals.tallies.rays) });
}

} // namespace wedge::render
