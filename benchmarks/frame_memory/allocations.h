#pragma once

#include <cstdint>

namespace wedge::benchmark {

/// Bytes of the OpenCL buffers that a program has at the same time, counted where each is created and freed: the
/// program that links this has its own clCreateBuffer(), which calls the library's. Whoever creates a buffer is
/// counted, whether anybody planned it or not. Parts of buffers are no memory of their own.
class Allocations {
public:
    /// Forgets the largest sum, but not what there is.
    static void restart();
    static std::uint64_t largest(); ///< since restart()
    static std::uint64_t current();
};

} // namespace wedge::benchmark
