#pragma once

#include "benchmarks/common/savings.h"
#include "benchmarks/harness/benchmark.h"
#include "benchmarks/harness/bias.h"
#include "benchmarks/harness/maps.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// The best single filter width in place of adaptive ones.
struct FixedWidth {
    float width = 0; ///< pixels
    Measured measured;
};

/// A case of a scene in one setting.
struct CaseSetting {
    Case of;
    bool published = false;
    std::size_t triangles = 0;
    Timing timing; ///< without columns where only errors were measured
    double raysPerPixel = 0; ///< of the whole image, of timed frames if there are any; by rays alone
    /// The rest is empty where only times were measured.
    double noise = 0; ///< of the reference
    Method method;
    std::vector<Comparison> baselines;
    std::vector<Measured> convergence; ///< by mu
    std::optional<FixedWidth> fixedWidth;
    std::optional<Method> blur; ///< with Benchmark::blurWidth everywhere, by the method's seeds
    std::optional<Method> rival; ///< Benchmark::rival, by the method's seeds
    double regionFraction = 0; ///< of the image, Subject::regionOf()

    /// Appended to quantities of claims.
    std::string suffix() const { return (published ? "_published" : "") + of.suffix; }
};

/// A curve of error against samples or rays.
struct CurveResult {
    Json head; ///< what it is of, as it is written
    std::vector<Measured> points;
    std::vector<double> widths; ///< of Gaussians over the image, pixels
};

/// Everything measured of one scene.
struct SceneResult {
    BenchmarkScene source;
    std::size_t triangles = 0;
    std::vector<CaseSetting> settings; ///< by cases, the default before the published one
    std::vector<CurveResult> curves;
    std::vector<int> budgets; ///< samples of variants' points
    std::vector<Bias> biases;
    std::vector<Map> maps;
    std::map<std::string, Reference> references; ///< without their pixels
    std::uint64_t memoryBytes = 0; ///< of a frame without its scene
    double seconds = 0; ///< all of it took
};

} // namespace wedge::benchmark
