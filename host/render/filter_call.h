#pragma once

#include "host/render/settings.h"

#include <string>

namespace wedge::render {

/// A filter as users write it: "median", "bilateral:sigma=2,tolerance=0.5,on=direct+indirect". Parameters that it does
/// not name have their defaults. option: what it is the value of, "--add-filter". Throws UsageError for unknown filters
/// and parameters, which it names the nearest of, and for values out of range.
ChosenFilter filterCall(const std::string& option, const std::string& text);

/// The filters and their parameters, for --help: a line each, with ranges and defaults.
std::string filterList();

} // namespace wedge::render
