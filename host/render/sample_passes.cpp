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
            writes("exposure", exposure) });
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
    const auto surface = [&](float pixels) {
        return Arguments { frame.rectangle(frame.analysisParams()), value("sigma", pixels),
            reads("objectId", frame.surfaces.objectId, far), reads("normal", frame.surfaces.normal, far),
            reads("taken", lost.taken, far) };
    };
    Arguments widths { graph::absent("width", graph::floats), graph::absent("widths", graph::floats) };
    if (grows) {
        auto width = frame.graph.plane<Pixels>("widths of rejected light", graph::floats);
        auto largest = frame.graph.plane<Pixels>("largest widths of rejected light", graph::floats);
        frame.pixels(samplePass, PassKind::Filter, { "filter/spread.cl", "spreadWidths" },
            joined(surface(sigma),
                Arguments { value("widest", last), reads("excess", lost.excess), reads("sums", lost.sums, far),
                    writes("per", per), writes("width", width) }));
        frame.pixels(samplePass, PassKind::Filter, { "filter/spread.cl", "spreadBlocks" },
            { frame.rectangle(frame.analysisParams()), reads("width", width, graph::around(WEDGE_SPREAD_BLOCK - 1)),
                writes("widths", largest) });
        widths = { reads("width", width, far), reads("widths", largest, far) };
    } else {
        frame.pixels(samplePass, PassKind::Filter, { "filter/spread.cl", "spreadSums" },
            joined(surface(sigma), Arguments { reads("excess", lost.excess), writes("per", per) }));
    }
    frame.pixels(samplePass, PassKind::Filter, { "filter/spread.cl", "spreadExcess" },
        joined(surface(last), widths,
            Arguments { reads("excess", lost.excess, far), reads("per", per, far), updates("sums", lost.sums),
                lost.parts.graph != 0 ? updates("parts", lost.parts) : graph::absent("parts", packedColours) }));
}

void meansOfKept(
    FrameBuilder& frame, const graph::Handle<Sums>& sums, const graph::Handle<Count>& taken, graph::Handle<Value>& mean)
{
    frame.pixels(samplePass, PassKind::Filter, { "filter/spread.cl", "meanOfKept" },
        { frame.rectangle(frame.analysisParams()), reads("sums", sums), reads("taken", taken), writes("mean", mean) });
}

} // namespace wedge::render
