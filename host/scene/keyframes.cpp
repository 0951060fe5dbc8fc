#include "host/scene/keyframes.h"

#include <algorithm>

#include <fmt/format.h>

namespace wedge::scene {

KeySpan spanAt(const std::vector<double>& times, double time)
{
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    const auto to = static_cast<std::size_t>(after - times.begin());
    if (to == 0)
        return { 0, 0, 0.0 };
    if (to == times.size())
        return { to - 1, to - 1, 0.0 };
    return { to - 1, to, (time - times[to - 1]) / (times[to] - times[to - 1]) };
}

double readKeyTime(TableReader& key, const std::vector<double>& before)
{
    const double time = key.require("time", key.number("time"));
    if (!before.empty() && !(time > before.back()))
        key.fail("time", "is not after that of the key before", fmt::format("{:g} and {:g}", before.back(), time),
            "write the keys in the order of their times");
    return time;
}

} // namespace wedge::scene
