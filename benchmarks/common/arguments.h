#pragma once

#include "benchmarks/common/measure_plan.h"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace wedge::benchmark {

/// The command line of a benchmark that measures errors.
struct Arguments {
    bool quick = false, list = false, timingOnly = false;
    std::vector<std::string> scenes;
    std::string json, device, size;
    std::string references; ///< folder
    int referenceSpp = 0; ///< 0: the plan's
};

/// table: of the thesis, whose times --timing-only keeps; plan and quick: for the defaults in the help.
void addOptions(CLI::App& parser, Arguments& a, const std::string& table, const MeasurePlan& plan,
    const MeasurePlan& quick, const std::string& quickMeans);

/// "64x48" into a plan's size. Throws UsageError.
void setSize(MeasurePlan& plan, const std::string& text);

/// What the arguments change in a plan. spp of references become a multiple of `halves`. Throws UsageError.
void apply(const Arguments& arguments, MeasurePlan& plan, int halves);

} // namespace wedge::benchmark
