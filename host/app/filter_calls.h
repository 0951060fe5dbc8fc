#pragma once

#include "host/render/settings.h"

#include <string>
#include <vector>

namespace wedge::app {

/// A filter of the image from the value of --add-filter: "median", "bilateral:sigma=2,tolerance=0.5". Parameters that
/// it does not name have their defaults. Throws UsageError for unknown filters and parameters, which it names the
/// nearest of, and for values out of range.
render::ChosenFilter filterCall(const std::string& text);

/// The filters and their parameters, for --help: a line each, with ranges and defaults.
std::string filterList();

} // namespace wedge::app
