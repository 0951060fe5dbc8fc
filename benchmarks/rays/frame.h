#pragma once

#include "benchmarks/rays/measure.h"

#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// A whole frame of direct light with one shadow ray a sample, ours beside Embree's.
struct FrameResult {
    std::vector<Runs> runs; ///< "wedge frame", "embree frame single", "embree frame packets high"
    std::vector<double> deviceSeconds; ///< of our passes by event times, one a repetition
    double rmse = 0; ///< between our image and Embree's by single rays, linear radiance
    double mean = 0; ///< of our image
    std::size_t differentPixels = 0; ///< by more than 1 part in 1000 of the mean
    bool cpuTime = false;

    /// Seconds of our frame: the device's, or, if processor time is measured, the process's.
    const std::vector<double>& ourSeconds() const { return cpuTime ? runs.front().seconds : deviceSeconds; }
    std::vector<double> ratios(const std::string& theirs) const;
};

/// Why such a frame cannot be compared for this scene, "" if it can.
std::string frameProblem(const scene::Scene& scene);

FrameResult measureFrame(const scene::Scene& scene, const WedgeTracer& tracer, const BuiltScene& built,
    Workers& workers, const RayPlan& plan);

} // namespace wedge::benchmark
