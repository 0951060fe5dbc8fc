#pragma once

#include "benchmarks/common/lab.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// A picture of a quantity over the image, and what its colours mean.
struct Map {
    std::string file, quantity, unit;
    double low = 0, high = 0; ///< black; white: all but the largest 0.5 % lie below
    bool logarithmic = false;
};

/// Renders a frame and writes NAME.png of it into the folder, which is made where it is missing, and
/// NAME_<quantity>.png of its counts and filter widths, NAME being the lab's. Throws Error.
std::vector<Map> writeMaps(Lab& lab, render::Settings settings, const std::string& folder);

} // namespace wedge::benchmark
