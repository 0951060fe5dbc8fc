#pragma once

#include "benchmarks/rendering_filters/call.h"
#include "benchmarks/rendering_filters/stylized_lab.h"

#include <CLI/CLI.hpp>

namespace wedge::benchmark {

/// Of hard shadows in a style.
struct StylizedCall : CommonCall {
    StylizedPlan plan;
};

/// The subcommand and its options, into a call that must outlive the parser.
CLI::App& addStylized(CLI::App& parser, StylizedCall& call);

/// Measures what the call asks for; the exit status. Throws Error.
int runStylized(const StylizedCall& call);

} // namespace wedge::benchmark
