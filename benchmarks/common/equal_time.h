#pragma once

#include <vector>

namespace wedge::benchmark {

/// A count of samples or lights, and the milliseconds of a frame with so many.
struct CountTime {
    int count = 0;
    double milliseconds = 0;
};

/// The count that is expected to take `wanted` milliseconds, not rounded: by the line through the two whose times are
/// nearest, in proportion to the nearest where there is no rising line. One or more, of times above 0.
double countOfTime(std::vector<CountTime> timed, double wanted);

} // namespace wedge::benchmark
