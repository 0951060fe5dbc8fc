#pragma once

#include "benchmarks/indirect/run.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// Table 4.1 with the thesis' rows; errors, samples saved and biases where they were measured; goals.
std::string tablesOf(const std::vector<SceneResult>& results);

} // namespace wedge::benchmark
