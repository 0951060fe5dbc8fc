#pragma once

#include "benchmarks/soft_shadows/run.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// Table 3.1 with the thesis' rows; errors and samples saved where they were measured; goals.
std::string tablesOf(const std::vector<SceneResult>& results);

} // namespace wedge::benchmark
