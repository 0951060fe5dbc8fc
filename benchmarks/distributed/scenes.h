#pragma once

#include "benchmarks/common/scene_source.h"

#include <optional>

namespace wedge::benchmark {

/// What the thesis says of a frame of 1024x1024 (Table 5.2, appendix B). Nothing where it says nothing.
struct PaperFrame {
    std::optional<double> triangles;
    double raysPerPixel;
    std::optional<double> overhead; ///< fraction of the frame
    std::optional<double> seconds; ///< of the frame
    std::optional<double> raysSaved; ///< at equal RMS error
};

/// A scene whose pixels have several receivers.
struct DistributedScene : SceneSource {
    std::optional<PaperFrame> paper;
    std::optional<double> raysSavedGoal; ///< at equal RMS error, against stratified sampling
    std::optional<double> raysSavedAim; ///< more than the goal asks for
    std::optional<double> overheadGoal; ///< fraction of the frame at most
};

} // namespace wedge::benchmark
