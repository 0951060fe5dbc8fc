// What the tests of blur.cl, published.cl and distributed.cl share: passes of frames whose pixels have several
// receivers, in images that are parts of their planes, with something else beside them; a pass is to write nothing but
// its window.
#pragma once

#include "kernels/shared/distributed.h"
#include "tests/pass_bench.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace wedge::test {

/// Of frames in whose planes images lie from the corner on.
inline const render::PlaneLayout& framesLayout()
{
    static const render::PlaneLayout layout(128, 96);
    return layout;
}

/// An image and the window of it that kernels fill.
struct Region {
    Region(int imageWidth, int imageHeight)
        : Region(imageWidth, imageHeight, { 0, 0, imageWidth, imageHeight })
    {
    }
    Region(int imageWidth, int imageHeight, image::Window filled, const render::PlaneLayout& planes = framesLayout())
        : layout(planes)
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

/// How a frame keeps its planes: all in floats, or those of one image in fewer bits.
enum class Kept { Full, Lean };

/// Of two area lights, a point light and paths on glossy surfaces, through a lens and a shutter while all moves.
class MovingFrame : public DeclaredFrame {
public:
    MovingFrame(const device::Device& device, Kept kept, const render::Settings& settings = render::axisAligned(16),
        const render::PlaneLayout& size = framesLayout())
        : DeclaredFrame(device, moving(), distributed(settings, size), kept == Kept::Full)
        , lean(kept == Kept::Lean)
    {
    }
    MovingFrame(const device::Device& device, Kept kept, const render::PlaneLayout& size)
        : MovingFrame(device, kept, render::axisAligned(16), size)
    {
    }

    const bool lean;

private:
    static scene::Scene moving()
    {
        scene::Scene out = smallScene();
        out.geometry.positionsAtClose = out.geometry.positions;
        for (float& coordinate : out.geometry.positionsAtClose)
            coordinate += 0.1f;
        out.geometry.normalsAtClose = out.geometry.normals;
        out.shutterClose = 1;
        out.materials[0].specular = glm::vec3(0.3f);
        out.pointLights.push_back({ glm::vec3(0, 3, 2), glm::vec3(1) });
        out.camera.apertureRadius = 0.05f;
        return out;
    }
    static render::Settings distributed(render::Settings settings, const render::PlaneLayout& size)
    {
        settings.antialias = true;
        settings.bounces = 1;
        return sized(settings, static_cast<int>(size.width), static_cast<int>(size.height));
    }
};

/// Numbers of terms' passes: each light has one, then paths.
inline std::size_t termOf(std::uint32_t values) { return values == 1 ? 0 : 2; }

/// Calls test(frame, region, random) for every device and each of regions(), with random numbers that go on from region
/// to region.
template <class Test>
void onEveryRegion(
    unsigned seed, Kept kept, const Test& test, const render::Settings& settings = render::axisAligned(16))
{
    onEveryDevice([&](const device::Device& device) {
        CAPTURE(kept);
        MovingFrame frame(device, kept, settings);
        std::mt19937 random(seed);
        for (const Region& region : regions())
            test(frame, region, random);
    });
}
/// Of both kinds of frames.
template <class Test>
void onEveryRegion(unsigned seed, const Test& test)
{
    for (const Kept kept : { Kept::Full, Kept::Lean })
        onEveryRegion(seed, kept, test);
}

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

/// A pass of a frame that writes planes of T, in a region.
template <class T = float>
class RegionPass : public PassBench {
public:
    /// outputs: planes that are not to change beside the window, with something in them.
    RegionPass(
        DeclaredFrame& frame, const std::string& kernel, const std::vector<std::string>& outputs, std::size_t nth = 0)
        : PassBench(frame, kernel, "", nth)
        , outputs_(outputs)
    {
        for (const std::string& name : outputs_)
            plane(name, std::vector<T>(read<T>(name).size(), static_cast<T>(7)));
    }

    /// Over the window; fails if anything beside it has changed.
    void runIn(const Region& region, const shared::DistributedParams& p)
    {
        std::vector<std::vector<T>> before;
        before.reserve(outputs_.size());
        for (const std::string& name : outputs_)
            before.push_back(read<T>(name));
        value("p", p);
        window(region.window);
        run();
        const std::size_t size = region.layout.size;
        std::vector<char> inside(size, 0);
        everyPixel(region.window, [&](int x, int y) { inside[Planes<T>(region.layout, 0, T {}).index(x, y)] = 1; });
        for (std::size_t k = 0; k < outputs_.size(); ++k) {
            const std::vector<T> after = read<T>(outputs_[k]);
            std::size_t written = 0;
            for (std::size_t i = 0; i < after.size(); ++i)
                written += inside[i % size] == 0 && after[i] != before[k][i] ? 1 : 0;
            REQUIRE(written == 0);
        }
    }
    Planes<float> floats(const std::string& name) const { return pixels<float>(name); }

private:
    std::vector<std::string> outputs_;
};

/// Parameters of that region, the settings as frames have them by default.
inline shared::DistributedParams paramsOf(const Region& region)
{
    shared::DistributedParams p {};
    p.x0 = static_cast<std::uint32_t>(region.window.x0);
    p.y0 = static_cast<std::uint32_t>(region.window.y0);
    p.x1 = static_cast<std::uint32_t>(region.window.x1);
    p.y1 = static_cast<std::uint32_t>(region.window.y1);
    p.width = static_cast<std::uint32_t>(region.width);
    p.height = static_cast<std::uint32_t>(region.height);
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

/// Within a fraction of b, or a little of 0.
inline bool agree(double a, double b, double relative = 1e-5, double absolute = 1e-7)
{
    return std::fabs(a - b) <= relative * std::fabs(b) + absolute;
}

} // namespace wedge::test
