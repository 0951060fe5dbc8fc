#pragma once

#include "host/image/metrics.h"
#include "host/render/environment_table.h"
#include "host/render/progressive.h"
#include "host/render/renderer.h"
#include "host/render/settings.h"

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace wedge::render {

/// What is reported besides the frames themselves.
struct ReportExtras {
    double loadMilliseconds = 0; ///< reading the scene, not part of any frame
    std::string reference; ///< path, where there is one
    std::optional<image::Comparison> error; ///< of the last frame against the reference
    std::vector<ProgressiveStep> steps; ///< of a progressive render; their statistics without passes will do
    std::optional<double> targetError; ///< likewise
    std::string ended; ///< likewise: by what
    std::vector<std::string> files; ///< likewise: what the last image was written to
    /// Of a sequence.
    struct Sequence {
        std::uint32_t first = 0, last = 0;
        double fps = 0; ///< frames in one unit of the keys' time
        std::vector<std::uint32_t> skipped; ///< frames that were there
        std::string ended; ///< by what
    };
    std::optional<Sequence> sequence;
};

/// All rays of the frame, by the pixels that it shows.
double raysPerPixel(const FrameStatistics& statistics, const Settings& settings);

/// Rays a second of the tracing passes' device time, in millions; 0 where nothing was timed.
double megaraysPerSecond(const FrameStatistics& statistics);

/// What a report and `wedge info` say of a scene's lens, its shutter, and what moves.
nlohmann::ordered_json cameraReport(const scene::Scene& scene);

/// What a report and `wedge info` say of a picture around the scene.
nlohmann::ordered_json environmentReport(const EnvironmentPicture& picture);
/// The whole of an extent that is as half of it at distance 1.
double degreesAcross(const glm::vec3& half);

/// The report that docs/command-line.md describes, as JSON text of several lines. Quantities that are not finite are
/// null.
std::string jsonReport(const Renderer& renderer, const Settings& settings, const std::vector<FrameStatistics>& frames,
    const ReportExtras& extras);

} // namespace wedge::render
