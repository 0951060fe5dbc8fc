#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/lottery/measure.h"

#include <optional>

namespace wedge::benchmark {

/// A ratio of errors, and its standard error.
struct Ratio {
    double value = 1, deviation = 0;
    /// Exceeded by two standard errors.
    bool exceeds(double bound) const { return value - 2.0 * deviation > bound; }
};

/// What the measurements of a seed say. Errors are RMS.
struct Verdict {
    Ratio againstPlain; ///< filtered over plain, equal samples
    Ratio againstBlur; ///< filtered over the best fixed blur, equal samples
    Ratio againstEqualTime; ///< filtered over plain in the filtered frame's device time
    double savedSamples = 0,
           savedTrimmed = 0; ///< plain samples of equal error over the filtered's; trimmed: worst pixels apart
    double savedTime = 0, savedWallTime = 0; ///< the same in device time, and by the host's clock
    double slope = 0, plainSlope = 0; ///< d log error / d log samples, from `compared` to the largest budget
    double slopeDeviation = 0;
    double bias = 0, biasDeviation = 0; ///< at `compared`, a fraction of the mean
};

Verdict verdictOf(const LotteryResult& result, int compared);

/// Bounds that no scene should break.
inline constexpr double mostAgainstPlain = 1.05, mostAgainstBlur = 1.05, mostAgainstEqualTime = 1.10;
inline constexpr double usualSlope = -0.45, worstSlope = -0.35, slopeBehindPlain = 0.05;

/// Claims over scenes: lottery.direct.*, lottery.bounce.* and lottery.all.*; docs/benchmarks.md.
std::vector<Claim> lotteryClaims(const std::vector<LotteryResult>& results, int compared);

/// One line a scene that breaks a bound, then the totals.
std::string lotteryTable(const std::vector<LotteryResult>& results, int compared);

} // namespace wedge::benchmark
