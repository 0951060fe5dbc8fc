#include "host/render/sample_counts.h"

namespace wedge::render {

using device::PassKind;

void countsFromDemand(Passes& passes, const shared::AnalysisParams& params, float mean,
    const device::Buffer<std::uint32_t>& mask, Term& term)
{
    device::TimedQueue& queue = passes.queue();
    device::Kernel& histogram = passes.find("counts.cl", "demandHistogram");
    histogram.setArgs(params, term.demand, mask, term.histogramCounts, term.histogramSums, term.histogramPixels);
    queue.launch("counts", PassKind::Analysis, histogram, WEDGE_DEMAND_STRIPES, 1);
    device::Kernel& solve = passes.find("counts.cl", "solveCountScale");
    solve.setArgs(mean, static_cast<float>(params.leastCount), static_cast<float>(params.countCap),
        term.histogramCounts, term.histogramSums, term.histogramPixels, term.binCounts, term.binSums, term.countScale);
    queue.launch("counts", PassKind::Analysis, solve, 1, 1);
    passes.rows("counts", PassKind::Analysis, "counts.cl", "countsFromDemand", params, 1, term.demand, term.countScale,
        mask, term.wanted);
}

void uniformCounts(Passes& passes, const shared::AnalysisParams& params, std::uint32_t count,
    const device::Buffer<std::uint32_t>& mask, Term& term)
{
    passes.rows("counts", PassKind::Analysis, "counts.cl", "uniformCounts", params, 1, count, mask, term.wanted);
}

} // namespace wedge::render
