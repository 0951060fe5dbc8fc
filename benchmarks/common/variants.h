#pragma once

#include "benchmarks/common/lab.h"

namespace wedge::benchmark {

/// The same setting with equal counts everywhere, about spp. Jittered strata are even only in square counts, so each
/// of the two passes gets one. firstPass: what every pixel takes at least.
render::Settings uniform(render::Settings settings, double spp, int firstPass);

/// Neither analysed nor filtered: plain Monte Carlo with about spp samples, square counts where strata need them.
render::Settings plain(render::Sampler sampler, double spp);

/// The same setting with one width in pixels everywhere.
render::Settings fixed(render::Settings settings, float width);

/// The width in pixels of least error with these settings: from `start` by factors of sqrt 2 in the direction in which
/// the error falls.
float bestFixedWidth(Lab& lab, const render::Settings& settings, float start);

} // namespace wedge::benchmark
