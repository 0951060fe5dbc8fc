#include "host/render/sample_passes.h"

#include "kernels/shared/sample_filter.h"

#include <cmath>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr const char* exposurePass = "exposure of samples";

} // namespace

graph::Handle<Count> probeCounts(FrameBuilder& frame, const graph::Handle<ObjectId>& objectId)
{
    auto wanted = frame.graph.plane<Count>("samples of probes wanted", graph::counts);
    frame.pixels(exposurePass, PassKind::Analysis, { "filter/exposure.cl", "probeCounts" },
        { frame.rectangle(frame.analysisParams()),
            objectId.graph != 0 ? reads("objectId", objectId) : graph::absent("objectId", graph::counts),
            writes("wanted", wanted) });
    return wanted;
}

void exposureOfProbes(FrameBuilder& frame, const graph::Handle<Sums>& sums, const graph::Handle<Count>& taken,
    graph::Handle<Share>& exposure)
{
    auto bins = frame.graph.list<Count>("bins of luminances", graph::counts, WEDGE_PROBE_BINS);
    frame.items(exposurePass, PassKind::Analysis, { "filter/exposure.cl", "exposureOfProbes" }, 1,
        { frame.rectangle(frame.analysisParams()), reads("sums", sums), reads("taken", taken), writes("bins", bins),
            writes("exposure", exposure) },
        true);
}

void spread(FrameBuilder& frame, float sigma, float widest, LostLight lost)
{
    if (sigma <= 0.0f) {
        return;
    }
    sigma = std::max(sigma, 1e-3f); // widths that double reach any from here, also where small floats are 0
    float last = sigma;
    while (2.0f * last <= widest) {
        last *= 2.0f;
    }
    const bool grows = last > sigma;
    const graph::Reach far = graph::around(static_cast<int>(std::ceil(WEDGE_SPREAD_CUT * last)));
    auto per = frame.graph.plane<Share>("shares of rejected light", graph::floats);
    auto width = frame.graph.plane<Pixels>("widths of rejected light", graph::floats);
    const auto surface = [&](float pixels) {
        return Arguments { frame.rectangle(frame.analysisParams()), value("sigma", pixels),
            reads("objectId", frame.surfaces.objectId, far), reads("normal", frame.surfaces.normal, far),
            reads("taken", lost.taken, far) };
    };
    frame.pixels(samplePass, PassKind::Filter, { "filter/spread.cl", "spreadSums" },
        joined(surface(sigma),
            Arguments { value("widest", last), reads("excess", lost.excess),
                grows ? reads("sums", lost.sums, far) : graph::absent("sums", graph::floats), writes("per", per),
                grows ? writes("width", width) : graph::absent("width", graph::floats) }));
    frame.blocks(samplePass, PassKind::Filter, { "filter/spread.cl", "spreadExcess" },
        joined(surface(last),
            Arguments { grows ? reads("width", width, far) : graph::absent("width", graph::floats),
                reads("excess", lost.excess, far), reads("per", per, far), updates("sums", lost.sums),
                lost.parts.graph != 0 ? updates("parts", lost.parts) : graph::absent("parts", packedColours) }));
}

void meansOfKept(
    FrameBuilder& frame, const graph::Handle<Sums>& sums, const graph::Handle<Count>& taken, graph::Handle<Value>& mean)
{
    frame.pixels(samplePass, PassKind::Filter, { "filter/spread.cl", "meanOfKept" },
        { frame.rectangle(frame.analysisParams()), reads("sums", sums), reads("taken", taken), writes("mean", mean) });
}

} // namespace wedge::render
