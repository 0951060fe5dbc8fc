#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/common/savings.h"
#include "benchmarks/common/timing.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// A row of Table 3.1 or 4.1: milliseconds at 640x480 on the thesis' GPU.
struct PaperRow {
    const char* name;
    double triangles, spp, firstPass, secondPass, tracing, analysis, filter, overhead, total, fpsWith, fpsWithout;
};

/// What is measured of one scene in one setting.
struct SettingResult {
    std::string name; ///< "default" or "published"
    Timing timing;
    /// The rest is empty where only times were measured.
    Method method;
    std::vector<Comparison> baselines; ///< the one that goals are about first
};

/// The best single filter width in place of adaptive ones.
struct FixedBlur {
    float width = 0; ///< pixels
    Measured measured;
};

/// A curve of error against samples.
struct Series {
    std::string setting; ///< "default" or "published"
    std::string sampling; ///< "NAS": uniform counts, "AS": adaptive
    std::string filter; ///< "UF": none, "NAF": one width for the image, "AF": adaptive
    std::optional<float> fixedWidth; ///< of NAF, pixels
    std::vector<Measured> points;
};

/// How points of curves are written.
struct PointForm {
    double noise = 0; ///< of the reference, RMS
    const char* rays = "rays"; ///< the key of rays
};

/// Claims of a setting's times. suffix: appended to each quantity.
void addTimeClaims(ClaimList& list, const SettingResult& setting, const std::string& suffix, const PaperRow* paper,
    std::optional<double> overheadGoal);

/// Claims of what the method saves against each baseline, and its error. paper, goal: of the samples saved against the
/// first one.
void addErrorClaims(ClaimList& list, const SettingResult& setting, const std::string& suffix,
    std::optional<double> paper, std::optional<double> goal);

Json dataOf(const Measured& point, const PointForm& form);
Json dataOf(const std::vector<Measured>& points, const PointForm& form);
Json dataOf(const SettingResult& setting, const PointForm& form);
Json dataOf(const Series& series, const PointForm& form);
Json dataOf(const FixedBlur& blur, const PointForm& form);
/// null for no row.
Json dataOf(const PaperRow* row);
/// A list, by the integrands' names.
Json dataOf(const std::map<std::string, Reference>& references);
/// What all plans have.
Json dataOf(const MeasurePlan& plan);

} // namespace wedge::benchmark
