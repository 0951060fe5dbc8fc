#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace wedge::image {

/// One scalar per pixel, row-major.
template <typename T>
struct Plane {
    int width = 0;
    int height = 0;
    std::vector<T> values;

    Plane(int w, int h)
        : width(w)
        , height(h)
        , values(static_cast<std::size_t>(w) * h)
    {
    }
    T* row(int y) { return values.data() + static_cast<std::size_t>(y) * width; }
    const T* row(int y) const { return values.data() + static_cast<std::size_t>(y) * width; }
};

/// A one-dimensional kernel of odd size; the middle is its centre.
template <typename T>
using Kernel = std::vector<T>;

/// Correlation with the kernel along x, pixels beyond the border repeating the border's.
template <typename T>
Plane<T> filterRows(const Plane<T>& in, const Kernel<T>& kernel)
{
    assert(kernel.size() % 2 == 1);
    const int radius = static_cast<int>(kernel.size() / 2);
    Plane<T> out(in.width, in.height);
    std::vector<T> padded(static_cast<std::size_t>(in.width + 2 * radius));
    for (int y = 0; y < in.height; ++y) {
        const T* from = in.row(y);
        std::fill_n(padded.begin(), radius, from[0]);
        std::copy_n(from, in.width, padded.begin() + radius);
        std::fill_n(padded.end() - radius, radius, from[in.width - 1]);
        T* to = out.row(y);
        for (std::size_t tap = 0; tap < kernel.size(); ++tap)
            for (int x = 0; x < in.width; ++x)
                to[x] += kernel[tap] * padded[tap + x];
    }
    return out;
}

/// The same along y.
template <typename T>
Plane<T> filterColumns(const Plane<T>& in, const Kernel<T>& kernel)
{
    assert(kernel.size() % 2 == 1);
    const int radius = static_cast<int>(kernel.size() / 2);
    Plane<T> out(in.width, in.height);
    for (int y = 0; y < in.height; ++y) {
        T* to = out.row(y);
        for (int tap = -radius; tap <= radius; ++tap) {
            const T weight = kernel[static_cast<std::size_t>(tap + radius)];
            const T* from = in.row(std::clamp(y + tap, 0, in.height - 1));
            for (int x = 0; x < in.width; ++x)
                to[x] += weight * from[x];
        }
    }
    return out;
}

} // namespace wedge::image
