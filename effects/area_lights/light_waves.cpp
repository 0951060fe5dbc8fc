#include "effects/area_lights/light_waves.h"

#include "effects/area_lights/light_widths.h"
#include "effects/area_lights/soft_shadows.h"
#include "host/render/filters/filter_graph.h"
#include "host/render/filters/widening.h"
#include "host/render/sinks.h"

#include <limits>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr std::uint32_t allSamples = std::numeric_limits<std::uint32_t>::max();

} // namespace

LightWaves::LightWaves(FrameBuilder& frame, const SampleShape& shape, const TermLight& light)
    : WaveTerm(frame, shape, frame.totals.direct, 1, 1.0f)
    , index_(light.number)
    , light_(light.light)
    , channels_(frame.specular() ? 2 : 1)
{
}

shared::AnalysisParams LightWaves::analysisParams() const
{
    return lightParams(f_.analysisParams(), settings(), light_);
}

shared::SampleParams LightWaves::sampleParams() const
{
    shared::SampleParams p = lightSampleParams(settings(), index_);
    p.sampler = waveSampler(settings());
    p.firstPass = 0;
    p.strata = static_cast<std::uint32_t>(settings().spp); // receivers have but some of their pixel's samples
    return p;
}

void LightWaves::sample(
    Waves& waves, const Adding& adding, const PrimaryCounts& counts, const graph::Handle<Count>& hits)
{
    const Receivers& r = waves.receivers();
    const auto light = value("light", light_);
    Shared own = share(waves, adding, counts, 2 * channels_, shape_.geometryMoves ? 6 : 2);
    std::vector<graph::Sink> becoming { sinks::sums() };
    Arguments sunk { updates("sums", own.sums) };
    if (adding.first) {
        becoming.push_back(sinks::slopes());
        sunk.push_back(updates("slopes", own.extremes));
        if (shape_.geometryMoves) {
            becoming.push_back(sinks::shadowMotions(f_.geometry()));
            sunk = joined({ value("camera", waves.camera()) }, f_.geometry(), sunk);
        }
    }
    waves.tiles(adding.first ? "first pass" : "shadow rays", { "light/area_light.cl", "sampleShadows", becoming },
        joined(shadowSamples(f_, waves, sampleParams(), light_),
            sampleCounts(own.last, value("lastSample", allSamples), own.first, { waves.tallyRays() }), sunk));
    const bool exact = settings().method == Method::AxisAligned && !shape_.published;
    auto unshadowed = waves.list<Value>("unshadowed shading", graph::pairs);
    if (exact) {
        waves.list("unshadowed shading", { "light/wave_light.cl", "unshadowedReceivers" }, WEDGE_BLOCK_PIXELS,
            joined({ waves.frame(), waves.params(), light, quadratureOf(f_, index_), reads("pixelOf", r.pixelOf),
                       waves.sampleOf() },
                places(r),
                Arguments { reads("specular", r.specular), reads("gloss", r.gloss), reads("view", r.view),
                    writes("unshadowed", unshadowed) }));
    }
    waves.pixels("accumulateLight",
        joined({ waves.pixelParams(), waves.params(), light }, waves.pixelLists(reads("taken", counts.taken)),
            Arguments { reads("hits", hits) }, waves.arguments(),
            Arguments { reads("diffuse", r.diffuse), reads("specular", r.specular) },
            graph::together("sampled",
                { reads("sums", own.sums),
                    exact ? reads("unshadowed", unshadowed) : graph::absent("unshadowed", graph::pairs),
                    reads("slopes", own.extremes) }),
            accumulated(adding, counts)));
}

void LightWaves::widths()
{
    lightWidths(f_, analysisParams(),
        { wholeExtremes(), [this]() -> graph::Version { return weights("widths", PassKind::Analysis); },
            reflectedTexture(light_, means.texture) },
        means.beta, means.wanted);
}

void LightWaves::publishedWidths(
    const shared::DistributedParams& params, const graph::Handle<Share>& flags, const graph::Handle<Pixels>& confusion)
{
    const graph::Reach near = graph::around(WEDGE_MEDIAN_RADIUS);
    // The light's effective half extent is two standard deviations, as in chapter 3.
    f_.pixels("widths", PassKind::Analysis, { "analysis/published.cl", "publishedShadows" },
        { f_.rectangle(of(params)), value("mu", settings().distributed.mu), value("lightExtent", 2.0f * light_.sigma),
            reads("flags", flags, near), reads("slopes", means.extremes), reads("confusion", confusion),
            reads("pixelSize", f_.surfaces.pixelSize), reads("objectId", f_.surfaces.objectId),
            writes("beta", means.beta), writes("demand", means.demand) });
}

FilteredTerm LightWaves::filtered(const shared::DistributedParams& params)
{
    const shared::FilterParams filter = shape_.published
        ? publishedParams(settings(), f_.wholeFrame(), f_.graph.image())
        : filterParams(settings(), f_.wholeFrame(), light_, f_.graph.image());
    if (widens(settings())) {
        widen("filter", params, filter, settings().widening);
    }
    const graph::Handle<Value> seen = visibility("filter", params);
    graph::Handle<Value> out = gaussianFilter(f_, { "filter", PassKind::Filter }, 1, filter, seen, means.beta).value;
    if (shape_.geometryMoves && settings().distributed.blur) {
        out = alongShadows(params, out);
    }
    return fallingBack(nullptr, out);
}

graph::Handle<Value> LightWaves::alongShadows(
    const shared::DistributedParams& params, const graph::Handle<Value>& seen) const
{
    const char* pass = "filter of motion";
    const graph::Argument p = f_.rectangle(of(params));
    const graph::Reach far = graph::around(WEDGE_MOTION_REACH);
    auto along = f_.graph.plane<Pixels>("width along shadows' motion", graph::floats);
    auto directions = f_.graph.plane<Pixels>("direction of shadows' motion", f_.lean ? shortPairs : graph::pairs);
    auto out = f_.graph.plane<Value>("filtered along shadows' motion", graph::floats);
    f_.pixels(pass, PassKind::Filter, { "waves/distributed.cl", "shadowBlurs" },
        { p, f_.lean ? graph::absent("shadowSums", graph::floatPlanes(4)) : reads("shadowSums", means.shadowSums),
            f_.lean ? reads("shadowMotion", means.shadowMotion) : graph::absent("shadowMotion", shortPairs),
            reads("taken", shape_.full ? means.taken : means.wanted), reads("beta", means.beta),
            f_.lean ? graph::absent("along") : writes("along", along),
            f_.lean ? graph::absent("directions", shortPairs) : writes("directions", directions),
            f_.lean ? writes("vectors", directions) : graph::absent("vectors", shortPairs) });
    f_.pixels(pass, PassKind::Filter, { "waves/distributed.cl", "blurMotion" },
        joined({ p }, readsMotion(f_, along, directions),
            Arguments { graph::absent("texture", graph::vectors), reads("value", seen, far), writes("out", out) }));
    return out;
}

} // namespace wedge::render
