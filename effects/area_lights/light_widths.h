#pragma once

#include "host/render/frame_builder.h"
#include "kernels/shared/filter_params.h"

#include <functional>

namespace wedge::render {

/// Over which pixels slopes are taken together.
struct SlopeWindow {
    bool eroded = true; ///< the least one of 3 x 3 pixels first
    int radius = 1; ///< then means over 2 radius + 1 by as many
};

/// What a light's samples tell of it.
struct LightMeasures {
    /// Of occluders: the least of each pixel, in the first plane; the largest, in the second, where it is asked for.
    graph::Handle<Extremes> slopes;
    /// Above 0 where the light is seen, in the first plane: asked for when it is needed.
    std::function<graph::Version()> lit;
    Arguments reflected; ///< reflectedSums() or reflectedTexture()
};
/// What pixels reflect of the light, diffusely and specularly: the sums of their own samples, or one texture.
Arguments reflectedSums(const FrameBuilder& frame, const graph::Handle<Sums>& sums);
Arguments reflectedTexture(const shared::AreaLight& light, const graph::Handle<Texture>& texture);

/// Of filters by both slopes of occluders (kernels/analysis/two_slopes.cl): where the largest, smoothed and spread as
/// the least is, over that goes, and whether widths follow from both.
struct BothSlopes {
    graph::Handle<Share>& ratio;
    bool widens;
    SlopeWindow window;
};

/// Declares how the widths of a light's filter, metres, follow from slopes of occluders as the settings say: from the
/// least one, smoothed and spread, narrowed where a lobe reflects; or as published, then or where counts follow from
/// the spectrum with those, `wanted` (kernels/analysis/analysis.cl). both: null: of the least slope alone
void lightWidths(FrameBuilder& frame, const shared::AnalysisParams& params, const LightMeasures& of,
    graph::Handle<Metres>& beta, graph::Handle<Count>& wanted, const BothSlopes* both = nullptr);

} // namespace wedge::render
