#pragma once

#include "benchmarks/distributed/scenes.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// A benchmark of frames whose pixels have several receivers.
struct DistributedBenchmark {
    std::string program; ///< its name
    std::string subject; ///< one line, for its help
    std::string table; ///< of the thesis, whose columns times have
    std::vector<DistributedScene> scenes;
};

/// Its main(): reads the command line, measures, prints tables. Returns the exit status.
int runDistributedBenchmark(int argc, char** argv, const DistributedBenchmark& benchmark);

} // namespace wedge::benchmark
