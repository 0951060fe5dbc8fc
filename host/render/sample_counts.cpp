#include "host/render/sample_counts.h"

namespace wedge::render {

using device::PassKind;

void countsFromDemand(Passes& passes, const shared::AnalysisParams& params, float mean,
    const device::Buffer<std::uint32_t>& mask, Scratch& scratch, device::Buffer<std::uint32_t>& wanted)
{
    device::TimedQueue& queue = passes.queue();
    device::Kernel& histogram = passes.find("counts.cl", "demandHistogram");
    histogram.setArgs(
        params, scratch.demand, mask, scratch.histogramCounts, scratch.histogramSums, scratch.histogramPixels);
    queue.launch("counts", PassKind::Analysis, histogram, WEDGE_DEMAND_STRIPES, 1);
    device::Kernel& solve = passes.find("counts.cl", "solveCountScale");
    solve.setArgs(mean, static_cast<float>(params.leastCount), static_cast<float>(params.countCap),
        scratch.histogramCounts, scratch.histogramSums, scratch.histogramPixels, scratch.binCounts, scratch.binSums,
        scratch.countScale);
    queue.launch("counts", PassKind::Analysis, solve, 1, 1);
    passes.rows("counts", PassKind::Analysis, "counts.cl", "countsFromDemand", params, 1, scratch.demand,
        scratch.countScale, mask, wanted);
}

void uniformCounts(Passes& passes, const shared::AnalysisParams& params, std::uint32_t count,
    const device::Buffer<std::uint32_t>& mask, device::Buffer<std::uint32_t>& wanted)
{
    passes.rows("counts", PassKind::Analysis, "counts.cl", "uniformCounts", params, 1, count, mask, wanted);
}

} // namespace wedge::render
