#pragma once

#include "benchmarks/harness/scene_result.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

// Forms of numbers in columns.
std::string wholeNumber(double value);
std::string shortNumber(double value); ///< "145.0K"
std::string tenths(double value);
std::string hundredths(double value);
std::string secondsOf(double milliseconds);
std::string percent(double fraction);

/// Times with the thesis' rows; errors, what is saved and biases where they were measured; goals.
std::string tablesOf(const Benchmark& benchmark, const std::vector<SceneResult>& results);

} // namespace wedge::benchmark
