#pragma once

#include "host/graph/plan.h"

#include <string>

namespace wedge::graph {

/// A table for people: the passes that are run, with kernel, window and what they use, and those that are not; the
/// resources with format, bytes, lifetime and place; the memory.
std::string explain(const Plan& plan);

/// The same as a drawing, SVG: a row a resource, a column a pass; bars are lifetimes, marks what is read and written.
std::string drawing(const Plan& plan);

} // namespace wedge::graph
