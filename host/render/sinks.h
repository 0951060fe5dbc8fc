// What becomes of samples: the sinks that frames have, and the arguments that they are handed.
#pragma once

#include "host/graph/graph.h"
#include "host/render/frame_builder.h"
#include "kernels/shared/components.h"
#include "kernels/shared/light.h"

#include <string>

namespace wedge::render::sinks {

/// What a receiver's samples add up to: "sums".
inline graph::Sink sums()
{
    return { .file = "sinks/sums.h", .name = "Sums", .begin = { "sums" }, .finish = { "sums" } };
}

/// What is made of the sums to be filtered: "value". After sums().
inline graph::Sink means()
{
    return { .file = "sinks/means.h", .name = "Means", .finish = { "sums", "value" }, .onlyFinishes = true };
}

/// The same of the first of two parts: "parts". After sums().
inline graph::Sink parts()
{
    return { .file = "sinks/parts.h", .name = "Parts", .begin = { "sums" }, .finish = { "parts" } };
}

/// Of what occludes a light: "slopes".
inline graph::Sink slopes()
{
    return { .file = "light/slopes.h", .name = "Slopes", .begin = { "slopes" }, .finish = { "slopes" } };
}

/// Where on a light it is that samples see: "gradients", of "score", the light's. After sums().
inline graph::Sink scores()
{
    return { .file = "light/scores.h", .name = "Scores", .take = { "score" }, .finish = { "sums", "gradients" } };
}

/// The same of first and second order: "moments", of "scores", the light's. After sums().
inline graph::Sink moments()
{
    return { .file = "light/moments.h", .name = "Moments", .take = { "scores" }, .finish = { "sums", "moments" } };
}

/// By components along both axes, so many each: "components", of the light's "axes".
inline graph::Sink components(int count)
{
    return { .file = "light/components.h",
        .name = "Components",
        .take = { "axes" },
        .finish = { "components" },
        .defines = { { "WEDGE_COMPONENTS", std::to_string(count) } } };
}

/// Of shadows in the image, after "slopes" in its planes: of "camera" and the scene's geometry.
inline graph::Sink shadowMotions(const Arguments& geometry)
{
    graph::Sink out { .file = "light/shadow_motions.h",
        .name = "ShadowMotions",
        .begin = { "slopes" },
        .take = { "camera" },
        .finish = { "slopes" } };
    for (const graph::Argument& argument : geometry) {
        out.take.push_back(argument.name);
    }
    return out;
}

/// Of what paths come from: "reflectors".
inline graph::Sink distances()
{
    return { .file = "paths/distances.h", .name = "Distances", .begin = { "reflectors" }, .finish = { "reflectors" } };
}

} // namespace wedge::render::sinks
