#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace wedge::bvh::detail {

/// Items [0, size) in chunks that depend on size alone, so that what is computed from them does not depend on the
/// threads; one chunk where a task would cost more than it brings.
class Chunks {
public:
    static constexpr std::size_t most = 256;

    /// atMost: for work that pays for each chunk.
    explicit Chunks(std::size_t size, std::size_t atMost = most)
        : size_(size)
        , count_(size < 16384 ? 1 : std::min(atMost, size / 4096))
    {
    }

    std::size_t count() const { return count_; }
    std::size_t begin(std::size_t chunk) const { return size_ * chunk / count_; }
    std::size_t end(std::size_t chunk) const { return begin(chunk + 1); }

    /// Calls body(chunk) for each, in parallel where there are several.
    template <typename Body>
    void forEach(const Body& body) const
    {
        if (count_ == 1)
            body(std::size_t { 0 });
        else
            tbb::parallel_for(std::size_t { 0 }, count_, body);
    }

private:
    std::size_t size_, count_;
};

} // namespace wedge::bvh::detail
