#pragma once

#include "host/render/effect.h"
#include "host/render/receiver_set.h"
#include "host/render/settings.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/light.h"

#include <cstdint>
#include <string>

namespace wedge::render {

/// A light that has a term of its own.
struct TermLight {
    std::uint32_t number = 0; ///< of DirectLights::own
    shared::AreaLight light {};
    std::string name; ///< of its term
    std::uint32_t quad = 0; ///< its number among the scene's area lights; where something changes what is seen of it
    const Effect* changer = nullptr; ///< what does; null: nothing
};

/// What the analysis of a light needs besides where pixels lie.
shared::AnalysisParams lightParams(
    shared::AnalysisParams params, const Settings& settings, const shared::AreaLight& light);

/// Whether filters of lights are sheared where the pixels are the receivers (kernels/filter/gather_sheared.h).
bool isSheared(const Settings& settings);

/// The score of a light's profile. Of its two parts the steps at a cut profile's ends have `edge`, from 0 to 1, of the
/// first moment, 1.
struct ProfileScore {
    shared::LightScore score {};
    float edge = 0;
};
ProfileScore scoreOf(const shared::AreaLight& light);

/// The analysis' parameters with the widths of sheared filters: shearedWidth times as wide as others where the profile
/// ends in no edges. Shadows have kinks where it has, which no gradient takes away.
shared::AnalysisParams withShearedWidths(
    shared::AnalysisParams params, const Settings& settings, const shared::AreaLight& light);

/// The gather's parameters with what neighbours' gradients count for. analysis: as above
shared::FilterParams withShear(
    shared::FilterParams params, const shared::AnalysisParams& analysis, const shared::AreaLight& light);

/// How a light is sampled where the pixels are the receivers. index: of the light
shared::SampleParams lightSampleParams(const Settings& settings, std::uint32_t index);

/// What sampleShadows takes of a light and of receivers; next come counts of samples, and what these become.
Arguments shadowSamples(const FrameBuilder& frame, const ReceiverSet& at, const shared::SampleParams& params,
    const shared::AreaLight& light);

/// Nodes of its quadratures. index: of the light
graph::Argument quadratureOf(const FrameBuilder& frame, std::uint32_t index);

/// Directions of a pixel's lobe that no quadrature rule resolves, in proportion to its samples: whatever stood still
/// would be what the error ends at.
std::uint32_t lobeDirections(int spp);

} // namespace wedge::render
