#pragma once

#include "benchmarks/common/statistics.h"
#include "bvh/bvh.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// One builder on one mesh and number of threads.
struct BuildTimes {
    std::string name, peer;
    std::vector<double> wallMs, cpuMs; ///< one a repetition
    std::size_t bytes = 0;
    std::optional<std::size_t> peakBytes; ///< on top of the mesh, hierarchy included
};

/// All builders, repetition by repetition one after the other.
struct BuildSet {
    unsigned threads = 1;
    std::vector<BuildTimes> builders;

    const BuildTimes& operator[](const std::string& name) const;
    /// Of each repetition, the time of one divided by that of another.
    Summary ratio(const std::string& name, const std::string& by, bool cpuTime) const;
};

struct SceneBuilds {
    std::string name;
    std::size_t triangles = 0;
    std::vector<BuildSet> sets; ///< one a number of threads
};

struct BuildPlan {
    int repeats = 9;
    double secondsEach = 20; ///< of a scene and number of threads; at least 3 repetitions all the same
    std::vector<unsigned> threads = { 1, 2 };
};

/// Warms up with one build of each, then measures.
SceneBuilds measureBuilds(const std::string& name, const bvh::Mesh& mesh, const BuildPlan& plan);

} // namespace wedge::benchmark
