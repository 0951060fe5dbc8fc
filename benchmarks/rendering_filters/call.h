#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/common/measure_plan.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace wedge::benchmark {

/// What calls of every subject of the program have.
struct CommonCall {
    std::vector<std::string> scenes;
    std::string device, json, size;
};

/// Their options, into a call and a plan, whose values so far are the defaults that the help tells.
void addCommonOptions(CLI::App& parser, CommonCall& call, MeasurePlan& plan);
/// Those of subjects that are measured against an image.
void addReferenceOptions(CLI::App& parser, MeasurePlan& plan);

/// The size that was asked for into the plan, and even samples of references; and whether results can be written.
/// Throws Error.
void applyCommonOptions(const CommonCall& call, MeasurePlan& plan);

/// Those claims that have a goal, beside it; every goal is an upper bound. Empty where there are none.
std::string goalsTable(const std::vector<Claim>& claims);

/// Prints a scene's table, and writes the results so far where the call wants them.
void tellScene(const CommonCall& call, const Json& results, const std::string& table);

} // namespace wedge::benchmark
