#pragma once

#include "benchmarks/common/measure_plan.h"
#include "benchmarks/common/statistics.h"
#include "benchmarks/rendering_filters/stylized_scenes.h"
#include "host/device/device.h"
#include "host/render/renderer.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// How much is measured.
struct StylizedPlan : MeasurePlan {
    StylizedPlan() { seeds = 5; }
    std::vector<int> samples { 32, 128, 512 }; ///< pieces of edge a pixel of thesis Fig. 3.10
    double work = 4e8; ///< distances of a pixel to a piece that the host may look at for its reference
};

/// The passes of styled shadows, by what they are for.
struct StylizedTimes {
    Summary matte, edges, distance, blur, transfer; ///< milliseconds of the device
    Summary style; ///< all of these together
    Summary frame, plainFrame; ///< the same of whole frames, with styles and without
};

/// A frame again after knobs of its styles changed, and nothing else: milliseconds from the change to the image, on the
/// host's clock.
struct RestyleTimes {
    Summary shade; ///< inflation, softness and brightness
    std::optional<Summary> abstraction; ///< none where no style has any
};

/// Distances to a shadow's edge against those in double to all pieces of it: RMS in what the first style leaves of the
/// light, before the blur, over some of the pixels.
struct StylizedErrors {
    std::size_t pixels = 0; ///< evenly spread
    double device = 0;
    std::vector<double> sampled; ///< of each count of StylizedPlan::samples
};

/// What was measured of a scene.
struct StylizedResult {
    StylizedScene source;
    bool soft = false; ///< shadows of quads have a style
    std::size_t pieces = 0; ///< of edge; of the first point or directional light with a style
    StylizedTimes times;
    RestyleTimes restyle;
    std::optional<StylizedErrors> errors; ///< none where no style moves or softens an edge of a hard shadow
};

/// Throws Error where no light's shadows have a style.
StylizedResult measureStyles(const StylizedScene& source, const device::Device& device, const StylizedPlan& plan);

} // namespace wedge::benchmark
