#include "host/graph/layout.h"

#include "host/device/buffer.h"
#include "kernels/shared/frame.h"

namespace wedge::graph {
namespace {

std::uint64_t strideFor(std::uint64_t width)
{
    const std::uint64_t blocks = (width + WEDGE_BLOCK_PIXELS - 1) / WEDGE_BLOCK_PIXELS;
    return blocks * WEDGE_BLOCK_PIXELS + WEDGE_ROW_PADDING;
}

std::uint64_t wholeParts(std::uint64_t elements)
{
    constexpr std::uint64_t part = device::partAlignment / sizeof(float);
    return (elements + part - 1) / part * part;
}

} // namespace

PlaneLayout::PlaneLayout(int imageWidth, int imageHeight, int marginPixels)
    : width(static_cast<std::uint32_t>(imageWidth + 2 * marginPixels))
    , height(static_cast<std::uint32_t>(imageHeight + 2 * marginPixels))
    , margin(static_cast<std::uint32_t>(marginPixels))
    , stride(static_cast<std::uint32_t>(strideFor(width)))
    , size(wholeParts(static_cast<std::uint64_t>(stride) * height + 2 * WEDGE_ROW_PADDING))
{
}

std::uint32_t PlaneLayout::index(int x, int y) const
{
    return shared::pixelIndex(static_cast<std::uint32_t>(x) + margin, static_cast<std::uint32_t>(y) + margin, stride);
}

} // namespace wedge::graph
