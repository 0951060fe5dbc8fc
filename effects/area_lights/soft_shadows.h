#pragma once

#include "host/render/settings.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/light.h"

#include <cstdint>

namespace wedge::render {

/// A light that has a term of its own.
struct TermLight {
    std::uint32_t number = 0; ///< of DirectLights::own
    shared::AreaLight light {};
};

/// What the analysis of a light needs besides where pixels lie.
shared::AnalysisParams lightParams(
    shared::AnalysisParams params, const Settings& settings, const shared::AreaLight& light);

/// How a light is sampled where the pixels are the receivers. index: of the light
shared::SampleParams lightSampleParams(const Settings& settings, std::uint32_t index);

/// Directions of a pixel's lobe that no quadrature rule resolves, in proportion to its samples: whatever stood still
/// would be what the error ends at.
std::uint32_t lobeDirections(int spp);

} // namespace wedge::render
