#pragma once

#include "benchmarks/harness/benchmark.h"

namespace wedge::benchmark {

/// A row of Table 3.1 or 4.1: milliseconds at 640x480 on the thesis' GPU. samplesSaved: where it says so.
Paper thesisRow(const char* name, double triangles, double spp, double firstPass, double secondPass, double tracing,
    double analysis, double filter, double overhead, double total, double fpsWith, double fpsWithout,
    std::optional<double> samplesSaved = {});

/// Columns of the two tables. heading, column: of what comes before the first pass.
std::vector<TableColumn> thesisTable(const char* heading, const char* column);

} // namespace wedge::benchmark
