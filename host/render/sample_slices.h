#pragma once

#include "host/graph/execution.h"
#include "host/graph/graph.h"

#include <algorithm>
#include <cstdint>
#include <functional>

namespace wedge::render {

/// The samples of a pass from one count to another in slices, between which a frame may be stopped, and which bound
/// what a launch over one tile may cost. In a graph, the iterations of a loop.
class SampleSlices {
public:
    /// mean: of the counts that pixels want, for the progress.
    SampleSlices(std::uint32_t from, std::uint32_t most, std::uint32_t slice, double mean)
        : from_(from)
        , most_(most)
        , slice_(slice)
        // Most pixels are done at twice the mean; the slices up to the cap count for what little is left.
        , knee_(std::min<double>(most, std::max(2.0 * mean, from + 1.0)))
    {
    }

    std::function<std::size_t(graph::Run&)> counter() const
    {
        const std::size_t count = most_ > from_ ? (most_ - from_ + slice_ - 1) / slice_ : 0;
        return [count](graph::Run&) { return count; };
    }

    /// The argument that says up to which sample the iteration goes.
    graph::Argument last() const
    {
        return graph::made("lastSample",
            [slices = *this](const graph::Launch& launch) { return slices.lastOf(launch.run.iteration()); });
    }

    /// The iteration's share of `units`.
    std::function<double(const graph::Launch&)> workUnits(double units) const
    {
        return [slices = *this, units](const graph::Launch& launch) {
            const std::size_t i = launch.run.iteration();
            const std::uint32_t before = i == 0 ? slices.from_ : slices.lastOf(i - 1);
            return units * (slices.done(slices.lastOf(i)) - slices.done(before));
        };
    }

private:
    std::uint32_t lastOf(std::size_t iteration) const
    {
        const std::uint64_t last = from_ + (iteration + 1) * std::uint64_t { slice_ };
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(most_, last));
    }
    double done(double n) const
    {
        return 0.9 * std::min(n - from_, knee_ - from_) / (knee_ - from_) + 0.1 * (n - from_) / (most_ - from_);
    }

    std::uint32_t from_, most_, slice_;
    double knee_;
};

} // namespace wedge::render
