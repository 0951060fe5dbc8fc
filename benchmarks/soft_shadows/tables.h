#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/soft_shadows/run.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// Table 3.1: a row a scene and setting, and the thesis' row beneath.
std::string timingTable(const std::vector<SceneResult>& results);

/// Errors, samples saved, and the references' noise; empty where only times were measured.
std::string errorTable(const std::vector<SceneResult>& results);

/// Claims that have a goal, and whether each is met. Goals of overhead and wall_gap are upper bounds.
std::string goalTable(const std::vector<SceneResult>& results);

} // namespace wedge::benchmark
