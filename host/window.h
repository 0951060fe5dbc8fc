#pragma once

#include <algorithm>

namespace wedge {

/// A rectangle of pixels, half open: x0 <= x < x1, y0 <= y < y1.
struct Window {
    int x0 = 0;
    int y0 = 0;
    int x1 = 0;
    int y1 = 0;

    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    bool empty() const { return x0 >= x1 || y0 >= y1; }
    bool operator==(const Window&) const = default;

    bool contains(const Window& part) const { return x0 <= part.x0 && y0 <= part.y0 && x1 >= part.x1 && y1 >= part.y1; }

    /// What is in both.
    Window within(const Window& other) const
    {
        return { std::max(x0, other.x0), std::max(y0, other.y0), std::min(x1, other.x1), std::min(y1, other.y1) };
    }

    /// The smallest that holds both.
    Window with(const Window& other) const
    {
        if (empty() || other.empty()) {
            return empty() ? other : *this;
        }
        return { std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1), std::max(y1, other.y1) };
    }
};

} // namespace wedge
