// What the tests of blur.cl, published.cl and distributed.cl share: planes with something else beside the image, and
// launches that check that nothing was written but the window.
#pragma once

#include "kernels/shared/distributed.h"
#include "tests/render_support.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace wedge::test {

/// An image and the window of it that kernels fill.
struct Region {
    Region(int imageWidth, int imageHeight)
        : Region(imageWidth, imageHeight, { 0, 0, imageWidth, imageHeight })
    {
    }
    Region(int imageWidth, int imageHeight, image::Window filled)
        : layout(imageWidth, imageHeight)
        , window(filled)
        , width(imageWidth)
        , height(imageHeight)
    {
    }
    bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }

    render::PlaneLayout layout;
    image::Window window;
    int width, height;
};

/// The least images first, then windows amid and at the end of an image.
inline std::vector<Region> regions()
{
    return { { 1, 1 }, { 1, 37 }, { 53, 1 }, { 2, 3 }, { 45, 29 }, { 45, 29, { 16, 3, 41, 20 } },
        { 45, 29, { 16, 20, 45, 29 } } };
}

/// Calls test(bench, region, random) for every device and each of regions(), with random numbers that go on from region
/// to region.
template <class Test>
void onEveryRegion(unsigned seed, const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        KernelBench bench(device);
        std::mt19937 random(seed);
        for (const Region& region : regions())
            test(bench, region, random);
    });
}

inline double luminanceOf(glm::dvec3 c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

template <class Visit>
void everyPixel(const image::Window& window, const Visit& visit)
{
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            visit(x, y);
}

/// value(x, y, plane) in each pixel of the image, `beside` in the padding: nothing is to come from there.
template <class T, class Value>
Planes<T> filledPlanes(const Region& region, std::size_t planes, T beside, const Value& value)
{
    Planes<T> out(region.layout, planes, beside);
    for (std::size_t plane = 0; plane < planes; ++plane)
        everyPixel({ 0, 0, region.width, region.height },
            [&](int x, int y) { out.at(x, y, plane) = static_cast<T>(value(x, y, plane)); });
    return out;
}

/// What output planes hold before a launch.
template <class T>
T untouched()
{
    return std::is_same_v<T, float> ? static_cast<T>(-7) : static_cast<T>(1000000007);
}

/// Planes before a launch and what they are after it.
template <class T>
class Output {
public:
    Output(KernelBench& bench, const Region& region, std::size_t planes)
        : Output(bench, region, Planes<T>(region.layout, planes, untouched<T>()))
    {
    }
    Output(KernelBench& bench, const Region& region, const Planes<T>& before)
        : bench_(bench)
        , region_(region)
        , before_(before)
        , buffer_(bench.buffer(before.values))
    {
    }
    const device::Buffer<T>& buffer() const { return buffer_; }

    /// The planes; fails if anything beside the window has changed.
    Planes<T> read()
    {
        Planes<T> after = planesOf(region_.layout, bench_.read(buffer_));
        std::vector<char> inside(region_.layout.size, 0);
        everyPixel(region_.window, [&](int x, int y) { inside[after.index(x, y)] = 1; });
        std::size_t written = 0;
        for (std::size_t i = 0; i < after.values.size(); ++i)
            written += inside[i % inside.size()] == 0 && after.values[i] != before_.values[i] ? 1 : 0;
        REQUIRE(written == 0);
        return after;
    }

private:
    KernelBench& bench_;
    Region region_;
    Planes<T> before_;
    device::Buffer<T> buffer_;
};

/// Parameters of that region, the settings as frames have them by default.
inline shared::DistributedParams paramsOf(const Region& region)
{
    shared::DistributedParams p {};
    p.x0 = static_cast<std::uint32_t>(region.window.x0);
    p.y0 = static_cast<std::uint32_t>(region.window.y0);
    p.x1 = static_cast<std::uint32_t>(region.window.x1);
    p.y1 = static_cast<std::uint32_t>(region.window.y1);
    p.width = region.layout.width;
    p.height = region.layout.height;
    p.stride = region.layout.stride;
    p.planeSize = static_cast<std::uint32_t>(region.layout.size);
    p.factoringError = 0.01f;
    p.factoringRadius = 2;
    p.blurWidth = 0.65f;
    p.blurExponent = 0.176f;
    p.shutterWidth = 0.86f;
    p.shutterExponent = 0.25f;
    p.leastRadius = 2;
    p.irradianceWidth = 0.18f;
    p.rays = 1;
    p.values = 1;
    p.oneVelocity = 0.1f;
    p.frames = 1;
    return p;
}

/// Launches a kernel with one work-item a pixel of the window. Arguments are to outlive the launch.
template <class... Args>
void launchPixels(KernelBench& bench, const std::string& file, const std::string& kernel,
    const shared::DistributedParams& p, const Args&... args)
{
    bench.passes.rows("test", device::PassKind::Analysis, file, kernel, p, 1, args...);
}

/// Within a fraction of b, or a little of 0.
inline bool agree(double a, double b, double relative = 1e-5, double absolute = 1e-7)
{
    return std::fabs(a - b) <= relative * std::fabs(b) + absolute;
}

} // namespace wedge::test
