#pragma once

#include <cstdint>

namespace wedge::graph {

/// Where pixels lie in a plane: rows padded so that a gather may run past their ends (kernels/shared/frame.h).
struct PlaneLayout {
    /// Of an image, and so many pixels more beyond each of its borders.
    PlaneLayout(int imageWidth, int imageHeight, int margin = 0);

    std::uint32_t width, height; ///< pixels, margins included
    std::uint32_t margin; ///< pixels
    std::uint32_t stride; ///< elements from row to row
    std::uint64_t size; ///< elements of a plane, whole parts of buffers (device::partAlignment)

    /// Where a plane has a pixel of the image.
    std::uint32_t index(int x, int y) const;
    /// Its height without margins, pixels.
    std::uint32_t imageHeight() const { return height - 2 * margin; }
    bool operator==(const PlaneLayout&) const = default;
};

} // namespace wedge::graph
