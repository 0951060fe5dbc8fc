#include "host/render/receiver_set.h"

namespace wedge::render {

PixelReceivers::PixelReceivers(FrameBuilder& frame)
    : f_(frame)
{
    begin();
}

void PixelReceivers::begin()
{
    rays_ = f_.graph.plane<Count>("rays of light", graph::counts);
    pathRays_ = f_.graph.plane<Count>("rays of paths", graph::counts);
    f_.zero(rays_, pathRays_);
    tallied_ = pathsTallied_ = false;
}

Arguments PixelReceivers::arguments() const
{
    return graph::together("receivers",
        joined(f_.readBy(ReadBy::Samplers, f_.surfaces),
            Arguments { graph::absent("pixelOf", graph::counts), graph::absent("view", graph::counts),
                graph::absent("time") }));
}

graph::Argument PixelReceivers::tallyRays()
{
    tallied_ = true;
    return graph::tallies("rays", rays_);
}

graph::Argument PixelReceivers::tallyPathRays()
{
    pathsTallied_ = true;
    return graph::tallies("pathRays", pathRays_);
}

void PixelReceivers::trace(std::string name, graph::KernelName kernel, Arguments arguments,
    const std::function<double(const graph::Launch&)>& workUnits)
{
    f_.trace(std::move(name), std::move(kernel), std::move(arguments), false, workUnits, rows_);
}

void PixelReceivers::countRays()
{
    Totals& t = f_.totals;
    if (tallied_) {
        f_.count(rays_, true, t.tallies.rays, &t.rays);
    }
    if (pathsTallied_) {
        f_.count(pathRays_, true, t.tallies.pathRays);
    }
    begin();
}

} // namespace wedge::render
