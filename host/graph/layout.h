#pragma once

#include <cstdint>

namespace wedge::graph {

/// Where pixels lie in a plane: rows padded so that a gather may run past their ends (kernels/shared/frame.h).
struct PlaneLayout {
    PlaneLayout(int width, int height);

    std::uint32_t width, height;
    std::uint32_t stride; ///< elements from row to row
    std::uint64_t size; ///< elements of a plane, whole parts of buffers (device::partAlignment)
    bool operator==(const PlaneLayout&) const = default;
};

} // namespace wedge::graph
