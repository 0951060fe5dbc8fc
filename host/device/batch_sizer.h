#pragma once

#include <cstddef>

namespace wedge::device {

/// Chooses how many work-groups a bounded launch gets, from what the launches before it took.
class BatchSizer {
public:
    /// targetMilliseconds: what a batch should take. limit: most groups of a batch. firstGroups: the first batch of a
    /// pass of which nothing is known. millisecondsPerGroup: what the pass cost when it last ran, negative if unknown.
    BatchSizer(double targetMilliseconds, std::size_t limit, std::size_t firstGroups, double millisecondsPerGroup);

    /// Groups of the next batch, 1 to limit.
    std::size_t groups() const { return groups_; }
    /// Whether any batch has been measured, now or when the pass last ran.
    bool known() const { return millisecondsPerGroup_ >= 0.0; }
    double millisecondsPerGroup() const { return millisecondsPerGroup_; }

    /// Takes the time of a batch into account. The next is at most 8 times as large, since costs differ across an
    /// image.
    void measured(std::size_t groups, double milliseconds);

private:
    std::size_t groupsFor(double milliseconds) const;

    double target_;
    std::size_t limit_;
    double millisecondsPerGroup_;
    std::size_t groups_;
};

} // namespace wedge::device
