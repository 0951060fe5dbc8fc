#pragma once

#include "benchmarks/rendering_filters/call.h"
#include "benchmarks/rendering_filters/shadow_lab.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace wedge::benchmark {

/// Of an environment's light by lights that stand for its map.
struct ShadowCall : CommonCall {
    ShadowPlan plan;
    std::vector<std::string> ways;
};

/// The subcommand and its options, into a call that must outlive the parser.
CLI::App& addShadowLights(CLI::App& parser, ShadowCall& call);

/// Measures what the call asks for; the exit status. Throws Error.
int runShadowLights(const ShadowCall& call);

} // namespace wedge::benchmark
