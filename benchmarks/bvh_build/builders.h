#pragma once

#include "bvh/bvh.h"

#include <memory>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// Something that builds a hierarchy over a mesh: one of our modes or one of Embree's qualities.
class Builder {
public:
    virtual ~Builder() = default;

    /// Sets up what is not to be timed, with no hierarchy there.
    virtual void prepare(const bvh::Mesh& mesh) = 0;
    /// Builds.
    virtual void build() = 0;
    /// Of the hierarchy that was built last.
    virtual std::size_t bytes() const = 0;
    /// Frees the hierarchy.
    virtual void release() = 0;
};

struct NamedBuilder {
    std::string name; ///< of claims and tables
    std::string peer; ///< the one whose time it is divided by, "" for Embree's own
    std::unique_ptr<Builder> builder;
};

/// Ours and Embree's on that many threads; while they are there no task runs on more. Throws Error if Embree cannot
/// start.
std::vector<NamedBuilder> makeBuilders(unsigned threads);

} // namespace wedge::benchmark
