#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/common/measure_plan.h"
#include "benchmarks/common/scene_source.h"
#include "benchmarks/common/squared_error.h"
#include "benchmarks/denoiser/open_image_denoise.h"
#include "host/device/device.h"

#include <string>
#include <utility>
#include <vector>

namespace wedge::benchmark {

/// How much is measured.
struct DenoiserPlan : MeasurePlan {
    DenoiserPlan()
    {
        referenceSpp = 4096;
        seeds = 2;
        frames = 3;
    }
    int spp = 28; ///< of ours
    std::vector<int> denoised { 1, 2, 4, 8, 16, 32, 64, 128, 256 }; ///< samples of what is denoised
    int region = 64; ///< pixels a side of the regions that are compared
};

/// A setting's images: samples a pixel, error, and the time of one: rendering by the device, denoising by the host.
struct TimedError {
    int spp = 0;
    SquaredError error;
    double renderMilliseconds = 0, denoiseMilliseconds = 0;
    double milliseconds() const { return renderMilliseconds + denoiseMilliseconds; }
};

/// The region where ours is farthest behind in equal time.
struct WorstRegion {
    int x = 0, y = 0; ///< its first pixel
    double ratio = 0; ///< RMS error of ours over that of the denoised one
};

struct DenoiserResult {
    SceneSource source;
    double referenceNoise = 0;
    TimedError ours;
    std::vector<TimedError> denoised; ///< by samples
    TimedError equalTime; ///< denoised, of as many samples as fit into our time
    WorstRegion region;
    /// Time that the denoised takes to our error over our time, whole and without the worst pixels; where no number of
    /// samples reaches that error, of the largest one: at least so much.
    double savedTime = 0, savedTimeTrimmed = 0;
    bool reached = true, reachedTrimmed = true;
};

/// Time at which a curve of errors, in the order of their times, comes down to `error`, by its neighbours' power; the
/// first one's where that is below already, the last one's where none is: then *reached is false.
double timeToError(const std::vector<std::pair<double, double>>& timesAndErrors, double error, bool* reached);

/// Throws Error.
DenoiserResult compareWithDenoiser(
    const SceneSource& source, const device::Device& device, const DenoiserPlan& plan, const OpenImageDenoise& oidn);

std::vector<Claim> claimsOf(const DenoiserResult& result);
Json dataOf(const DenoiserResult& result);
std::string tableOf(const DenoiserResult& result);

} // namespace wedge::benchmark
