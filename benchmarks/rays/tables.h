#pragma once

#include "benchmarks/rays/results.h"

#include <string>

namespace wedge::benchmark {

/// Tables in Markdown, as docs/traversal.md has them. "" where there is nothing to show.

std::string throughputTables(const RayResults& results); ///< Mrays/s of every column, a table a scene
std::string ratioTable(const RayResults& results); ///< ours over Embree's columns that goals are about
std::string modelTable(const RayResults& results); ///< nodes, blocks, cycles and the distance to the port limit
std::string differenceTable(const RayResults& results); ///< hits that differ, by kind
std::string frameTable(const RayResults& results);
std::string growthTable(const RayResults& results);
std::string goalTable(const RayResults& results);

} // namespace wedge::benchmark
