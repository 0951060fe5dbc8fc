#include "effects/indirect/path_waves.h"

#include "host/render/filters/filter_graph.h"
#include "host/render/filters/widening.h"
#include "host/render/sinks.h"

#include <algorithm>
#include <limits>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

PathWaves::PathWaves(FrameBuilder& frame, const SampleShape& shape, Component component)
    : WaveTerm(frame, shape, isDirect(component) ? frame.totals.direct : frame.totals.indirect, 3,
        isDirect(component) ? 2.0f : 2.0f * static_cast<float>(std::max(1, frame.settings.bounces)))
    , component_(component)
{
}

shared::PathParams PathWaves::pathParams() const
{
    shared::PathParams p = render::pathParams(f_, component_);
    p.sampler = waveSampler(settings());
    p.firstPass = 0;
    p.occluders = 0; // widths follow from distances
    p.skipsMirrors = 0; // pixels have receivers of all kinds, and one mean
    p.strata = static_cast<std::uint32_t>(settings().spp); // receivers have but some of their pixel's samples
    return p;
}

PathWaves::Shared PathWaves::samplePaths(Waves& waves, const Adding& adding, const PrimaryCounts& counts) const
{
    Shared own = share(waves, adding, counts, 4, 3);
    waves.tiles("paths", { "paths/indirect.cl", "samplePaths", { sinks::sums(), sinks::distances() } },
        joined(pathSamples(f_, waves, pathParams(), component_),
            sampleCounts(own.last, value("lastSample", std::numeric_limits<std::uint32_t>::max()), own.first,
                { waves.tallyRays(), waves.tallyPathRays() }),
            Arguments { updates("sums", own.sums), updates("reflectors", own.extremes) }));
    return own;
}

graph::Handle<Sums> PathWaves::probe(Waves& waves, const PrimaryCounts& counts)
{
    return samplePaths(waves, { .probes = true }, counts).sums;
}

void PathWaves::sample(
    Waves& waves, const Adding& adding, const PrimaryCounts& counts, const graph::Handle<Count>& hits)
{
    const Receivers& r = waves.receivers();
    const Shared own = samplePaths(waves, adding, counts);
    graph::Handle<Reflectance> reflectance = isGlossy(component_) ? r.specular : r.diffuse;
    if (isRelative(component_, settings())) {
        reflectance = waves.list<Reflectance>("reflectance times unshadowed light", graph::vectors);
        waves.list("paths", { "light/unshadowed_environment.cl", "environmentOfReceivers" }, WEDGE_BLOCK_PIXELS,
            joined({ waves.frame(), waves.params() }, f_.beyond(),
                Arguments {
                    reads("normal", r.normal), reads("diffuse", r.diffuse), writes("unshadowed", reflectance) }));
    }
    waves.pixels("accumulatePaths",
        joined({ waves.pixelParams(), waves.params(), value("ambient", component_ == Component::Ambient ? 1u : 0u) },
            waves.pixelLists(reads("taken", counts.taken)),
            Arguments { reads("hits", hits), reads("objectId", r.objectId), reads("reflectance", reflectance) },
            graph::together("samples of receivers", { reads("sums", own.sums), reads("reflectors", own.extremes) }),
            bins ? bins->sunk() : SampleBins::notSunk(), accumulated(adding, counts)));
}

void PathWaves::widths()
{
    shared::ReflectorParams p = reflectorParams(f_, component_);
    p.meanOnly = oneExtreme() ? 1 : 0;
    p.widthScale = settings().indirect.widthScale;
    reflectorWidths(f_, p, wholeExtremes(), means.taken, means.beta);
}

std::uint32_t PathWaves::publishedSamples() const
{
    constexpr std::uint32_t ofChapter6 = 16; // section 6.5.1
    return isOfEnvironment(component_) ? ofChapter6 : 0;
}

void PathWaves::publishedWidths(
    const shared::DistributedParams& params, const graph::Handle<Share>& flags, const graph::Handle<Pixels>& confusion)
{
    f_.pixels("widths", PassKind::Analysis, { "analysis/published.cl", "publishedReflectors" },
        { f_.rectangle(of(params)), value("mu", settings().distributed.mu),
            value("component", static_cast<std::uint32_t>(component_)),
            reads("flags", flags, graph::around(WEDGE_MEDIAN_RADIUS)), reads("reflectors", means.extremes),
            reads("gloss", f_.surfaces.gloss), reads("confusion", confusion), reads("pixelSize", f_.surfaces.pixelSize),
            reads("objectId", f_.surfaces.objectId), writes("beta", means.beta), writes("demand", means.demand) });
}

FilteredTerm PathWaves::filtered(const shared::DistributedParams& params)
{
    const shared::FilterParams filter = shape_.published
        ? publishedParams(settings(), f_.wholeFrame(), f_.graph.image())
        : pathFilterParams(f_, component_);
    if (widens(settings())) {
        widen("filter of indirect", params, filter, wideningOf(component_, settings()));
    }
    graph::Handle<Value> plain = means.value;
    if (shape_.compact) {
        plain = f_.graph.plane<Value>("value", graph::vectors);
        f_.pixels("filter of indirect", PassKind::Filter, { "waves/distributed.cl", "unpackImage" },
            { f_.rectangle(of(params)), reads("in", means.value), writes("out", plain) });
    }
    const graph::Handle<Value> out =
        gaussianFilter(f_, { "filter of indirect", PassKind::Filter }, 3, filter, plain, means.beta).value;
    return fallingBack(&filter, out);
}

} // namespace wedge::render
