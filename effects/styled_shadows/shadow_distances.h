#pragma once

#include "host/render/frame_builder.h"

namespace wedge::render {

struct Matte { }; ///< WEDGE_MATTE_*
struct Edges { }; ///< pieces of shadows' edges, boxes around them, and areas

/// How far pixels are from a shadow's edge, metres, below 0 in shadow; and where something goes by it how far away what
/// hides the light is, continued beyond the shadow.
struct ShadowDistances {
    graph::Handle<Metres> distance, away;
};

/// How far distances are found, metres, above 0.
struct DistanceReach {
    float largest; ///< that are told apart
    float meanWithin; ///< means over edges; beyond it over to distances to the nearest edge, which take less time

    /// Means are all that there is.
    static DistanceReach means(float largest) { return { largest, 2.0f * largest }; }
};

/// Declares the passes that find them for a matte. occluder: metres to what hides the light, of pixels in shadow; of no
/// graph where nothing goes by it. farthest: metres, the most that it may be, above 0 then.
ShadowDistances shadowDistances(FrameBuilder& frame, const graph::Handle<Matte>& matte,
    const graph::Handle<Metres>& occluder, float farthest, const DistanceReach& reach);

/// How distances are smoothed.
struct Smoothing {
    graph::Argument away; ///< what the deviation goes by; absent: nothing
    graph::Argument deviation; ///< StyleKnob, metres
    float largest; ///< metres, of shadowDistances()
    bool keepArea; ///< as much is in shadow as before
};

/// Distances that a style goes by, and where in them the shadow's edge is: the first of two numbers; of no graph: at 0.
struct SmoothedDistance {
    graph::Handle<Metres> distance, zeros;
};

/// Declares the passes that smooth distances of a matte.
SmoothedDistance smoothedDistance(FrameBuilder& frame, const graph::Handle<Matte>& matte,
    const graph::Handle<Metres>& distance, const Smoothing& smoothing);

} // namespace wedge::render
