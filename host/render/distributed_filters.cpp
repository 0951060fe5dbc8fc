// Filters of samples in frames of several receivers a pixel.
#include "host/render/distributed_samples.h"
#include "host/render/sample_passes.h"
#include "kernels/shared/sample_filter.h"

#include <algorithm>
#include <limits>

namespace wedge::render {

using graph::reads;
using graph::updates;
using graph::value;

void DistributedSamples::exposeBins()
{
    std::vector<WaveTerm*> probed;
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        if (term->bins && before_.taken == 0 && !term->bins->givesExposure()) {
            probed.push_back(term.get());
        }
    }
    if (probed.empty()) {
        return;
    }
    struct Found {
        graph::Handle<Sums> sums;
        graph::Handle<Count> seen;
    };
    std::vector<Found> found;
    for (std::size_t i = 0; i < probed.size(); ++i) {
        found.push_back({ f_.graph.plane<Sums>("sums of probes", graph::vectors),
            f_.graph.plane<Count>("surfaces of probes", graph::counts) });
        f_.zero(found.back().sums, found.back().seen);
    }
    PrimaryCounts counts { f_.graph.plane<Count>("samples of probes", graph::counts), probeCounts(f_, {}) };
    f_.zero(counts.taken);
    shared::WaveParams settings {};
    settings.sampler = waveSampler(f_.settings);
    constexpr double each = double { WEDGE_PROBE_SAMPLES } / (WEDGE_PROBE_STEP * WEDGE_PROBE_STEP);
    Waves waves(f_, settings, camera_, counts,
        { .last = [](std::size_t) { return std::numeric_limits<std::uint32_t>::max(); },
            .most = each,
            .workUnits = each,
            .terms = probed.size(),
            .everywhere = true });
    const auto addProbes = [&](const graph::Handle<Sums>& sums, Found& to, bool countsRays) {
        const Receivers& r = waves.receivers();
        const auto read = [&](const char* name, const graph::Handle<Count>& list) {
            return countsRays ? reads(name, list) : graph::absent(name, graph::counts);
        };
        const auto updated = [&](const char* name, graph::Handle<Count>& plane) {
            return countsRays ? updates(name, plane) : graph::absent(name, graph::counts);
        };
        waves.pixels("accumulateProbes",
            joined({ waves.pixelParams(), waves.params(), value("raysOfImage", shape_.layers ? 1u : 0u) },
                waves.pixelLists(reads("taken", counts.taken)),
                Arguments { reads("objectId", r.objectId), reads("sums", sums), updates("found", to.sums),
                    updates("seen", to.seen) },
                graph::together("rays of probes",
                    { read("rays", r.rays), read("pathRays", r.pathRays), updated("kept_rays", f_.totals.rays),
                        updated("kept_pathRays", f_.totals.pathRays) })));
    };
    waves.declare(lit_, [&] {
        for (std::size_t i = 0; i < probed.size(); ++i) {
            const graph::Handle<Sums> sums = probed[i]->probe(waves, counts);
            addProbes(sums, found[i], i + 1 == probed.size());
        }
    });
    for (std::size_t i = 0; i < probed.size(); ++i) {
        probed[i]->bins->expose(found[i].sums, found[i].seen);
    }
}

std::vector<TermMeans> DistributedSamples::keepSamples()
{
    std::vector<TermMeans> all;
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        all.push_back(term->means);
        if (term->bins) {
            term->means = term->bins->kept(term->means, shape_.layers);
        }
    }
    return all;
}

void DistributedSamples::goOnWith(const std::vector<TermMeans>& all)
{
    for (std::size_t i = 0; i < terms_.size(); ++i) {
        TermMeans& m = terms_[i]->means;
        m.value = all[i].value;
        m.deviation = all[i].deviation;
        m.spreads = all[i].spreads;
        m.squares = all[i].squares;
    }
}

} // namespace wedge::render
