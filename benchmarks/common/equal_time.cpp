#include "benchmarks/common/equal_time.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace wedge::benchmark {

double countOfTime(std::vector<CountTime> timed, double wanted)
{
    std::ranges::sort(timed, std::less {}, [&](const CountTime& each) { return std::abs(each.milliseconds - wanted); });
    const CountTime& nearest = timed.front();
    const auto other = std::ranges::find_if(timed, [&](const CountTime& each) { return each.count != nearest.count; });
    if (other != timed.end()) {
        const double rise = (other->milliseconds - nearest.milliseconds) / (other->count - nearest.count);
        if (rise > 0) {
            return nearest.count + (wanted - nearest.milliseconds) / rise;
        }
    }
    return nearest.count * wanted / nearest.milliseconds;
}

} // namespace wedge::benchmark
