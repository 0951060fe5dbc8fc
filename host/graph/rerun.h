// Running part of a plan again: where a few values changed, and all else is as it was.
#pragma once

#include "host/graph/plan.h"

#include <cstddef>
#include <vector>

namespace wedge::graph {

/// The bytes of values that are changing(), pass by pass in the order of their arguments.
using ChangingValues = std::vector<std::vector<std::byte>>;

/// Of each pass of a plan whether it has to run where those in `first` do: since it goes by what they make, or since it
/// makes what they work on and what has been overwritten since. Empty where they cannot run by themselves: some are in
/// loops that repeat, or work on what outlives the frame.
std::vector<bool> dependents(const Graph& graph, const std::vector<PlannedPass>& passes, std::vector<bool> first);

/// Of each pass whether it has changing() values.
std::vector<bool> changingPasses(const std::vector<PlannedPass>& passes);

} // namespace wedge::graph
