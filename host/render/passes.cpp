#include "host/render/passes.h"

#include <algorithm>

namespace wedge::render {

device::Kernel& Passes::find(const std::string& file, const std::string& kernel)
{
    const std::string key = file + ":" + kernel;
    const auto found = kernels_.find(key);
    if (found != kernels_.end()) {
        return found->second;
    }
    return kernels_.emplace(key, library_.kernel(file, kernel)).first->second;
}

std::size_t Passes::localSize(const device::Kernel& kernel, std::size_t most)
{
    std::size_t size = most;
    while (size > kernel.workGroupLimit() && size > 1) {
        size /= 2;
    }
    return size;
}

image::Window blockWindow(const image::Window& window, int margin, int width, int height)
{
    constexpr int block = static_cast<int>(WEDGE_BLOCK_PIXELS);
    const int left = std::max(0, window.x0 - margin);
    const int right = window.x1 + margin;
    return { left / block * block, std::max(0, window.y0 - margin),
        std::min(width, (right + block - 1) / block * block), std::min(height, window.y1 + margin) };
}

} // namespace wedge::render
