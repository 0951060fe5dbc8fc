#pragma once

#include "host/render/frame.h"
#include "host/render/passes.h"
#include "kernels/shared/filter_params.h"

namespace wedge::render {

/// Sets wanted of the pixels whose mask is not 0 to clamp(C scratch.demand, params.leastCount, params.countCap), with C
/// such that their mean is `mean` (kernels/counts.cl).
void countsFromDemand(Passes& passes, const shared::AnalysisParams& params, float mean,
    const device::Buffer<std::uint32_t>& mask, Scratch& scratch, device::Buffer<std::uint32_t>& wanted);

/// Sets wanted of the pixels whose mask is not 0 to `count`.
void uniformCounts(Passes& passes, const shared::AnalysisParams& params, std::uint32_t count,
    const device::Buffer<std::uint32_t>& mask, device::Buffer<std::uint32_t>& wanted);

} // namespace wedge::render
