// What the tests of kernels and of rendering share: devices, planes in their padded layout, parameters, pixels.
#pragma once

#include "host/device/buffer.h"
#include "host/device/program.h"
#include "host/device/queue.h"
#include "host/render/frame.h"
#include "host/render/hierarchy.h"
#include "host/render/renderer.h"
#include "host/scene/scene.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/packed.h"
#include "tests/device_testing.h"
#include "tests/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::test {

using device::Defines;

/// Kernels to test in place of the embedded ones; "" unless WEDGE_TEST_KERNEL_DIR names a folder.
inline std::string kernelDir()
{
    const char* folder = std::getenv("WEDGE_TEST_KERNEL_DIR");
    return folder != nullptr ? folder : "";
}

/// Calls test(device) for every usable device.
template <class Test>
void onEveryDevice(const Test& test)
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        test(device);
    }
}

/// A device with a queue and kernels, compiled with these defines.
class KernelBench {
public:
    explicit KernelBench(const device::Device& on, const Defines& defines = {}, const std::string& folder = kernelDir())
        : device(on)
        , queue(on)
        , library(on, { defines, false, folder })
    {
    }

    /// A buffer that holds the values.
    template <class T>
    device::Buffer<T> buffer(const std::vector<T>& values)
    {
        device::Buffer<T> out(device, values.size(), "values");
        if (!values.empty())
            out.upload(queue, std::span<const T>(values));
        return out;
    }

    /// `count` elements, each `value`.
    template <class T>
    device::Buffer<T> filled(std::size_t count, T value)
    {
        return buffer(std::vector<T>(count, value));
    }

    template <class T>
    std::vector<T> read(const device::Buffer<T>& from)
    {
        return from.downloadAll(queue);
    }

    device::Device device;
    device::TimedQueue queue;
    device::ProgramLibrary library;
};

/// Planes of one value a pixel in the layout of kernels/shared/frame.h, padding included.
template <class T>
class Planes {
public:
    Planes(const render::PlaneLayout& planeLayout, std::size_t count, T initial)
        : layout(planeLayout)
        , values(count * planeLayout.size, initial)
    {
    }
    std::size_t index(int x, int y, std::size_t plane = 0) const
    {
        return plane * layout.size
            + shared::pixelIndex(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), layout.stride);
    }
    T& at(int x, int y, std::size_t plane = 0) { return values[index(x, y, plane)]; }
    const T& at(int x, int y, std::size_t plane = 0) const { return values[index(x, y, plane)]; }
    void setVector(int x, int y, glm::dvec3 v) requires std::is_same_v<T, float>
    {
        for (int k = 0; k < 3; ++k)
            at(x, y, static_cast<std::size_t>(k)) = static_cast<float>(v[k]);
    }
    glm::dvec3 vector(int x, int y) const { return { at(x, y), at(x, y, 1), at(x, y, 2) }; }

    render::PlaneLayout layout;
    std::vector<T> values;
};

/// The same over values that a device wrote.
template <class T>
Planes<T> planesOf(const render::PlaneLayout& layout, std::vector<T> values)
{
    Planes<T> out(layout, 0, T {});
    out.values = std::move(values);
    return out;
}

/// Planes as kernels keep them in 16 bits each (kernels/core/packed_planes.h), in as many floats.
inline std::vector<float> inShorts(const Planes<float>& planes)
{
    std::vector<std::uint16_t> shorts(planes.values.size() + planes.values.size() % 2);
    std::ranges::transform(
        planes.values, shorts.begin(), [](float v) { return static_cast<std::uint16_t>(shared::packShort(v)); });
    std::vector<float> out(shorts.size() / 2);
    std::memcpy(out.data(), shorts.data(), shorts.size() * sizeof(std::uint16_t));
    return out;
}

inline double uniform(std::mt19937& random, double lo = 0, double hi = 1)
{
    return lo + (hi - lo) * (static_cast<double>(random()) + 0.5) / 4294967296.0;
}

inline glm::dvec3 unitVector(std::mt19937& random)
{
    for (;;) {
        const glm::dvec3 v(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
        const double length = glm::length(v);
        if (length > 0.01 && length <= 1)
            return v / length;
    }
}

inline glm::dvec3 toGlm(shared::Vec3 v) { return { v.x, v.y, v.z }; }
inline shared::Vec3 toVec3(glm::dvec3 v)
{
    return shared::vec3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}
inline double luminanceOf(glm::dvec3 c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

inline glm::dvec3 faceNormal(const scene::Geometry& g, std::uint32_t triangle)
{
    const auto corner = [&](std::uint32_t k) {
        const std::size_t v = 3 * std::size_t { g.indices[3 * std::size_t { triangle } + k] };
        return glm::dvec3(g.positions[v], g.positions[v + 1], g.positions[v + 2]);
    };
    return glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
}

inline bool sameBits(const std::vector<float>& a, const std::vector<float>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// Renders one scene with one device's default and WEDGE_TEST_KERNEL_DIR's kernels.
inline render::Options renderOptions()
{
    render::Options options;
    options.kernelDir = kernelDir();
    return options;
}

/// R, G, B, or the one number, of the pixels of window, row by row, from the planes of a frame.
template <typename T>
std::vector<T> pixels(render::Renderer& renderer, const device::Buffer<T>& planes, image::Window window)
{
    const std::vector<T> values = planes.downloadAll(renderer.queue());
    const render::PlaneLayout& layout = renderer.frame().layout;
    const std::size_t count = values.size() / layout.size;
    std::vector<T> out;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            for (std::size_t plane = 0; plane < count; ++plane)
                out.push_back(values[plane * layout.size + layout.index(x, y)]);
    return out;
}

/// The same of what the frame shows by that name.
inline std::vector<float> pixels(render::Renderer& renderer, const std::string& name, const image::Window& window)
{
    return pixels(renderer, renderer.frame().planes(name), window);
}

/// The terms of a frame of which layers are kept that have filters.
inline std::vector<std::string> termsOf(const render::Renderer& renderer)
{
    std::vector<std::string> out;
    for (const render::Frame::Shown& shown : renderer.frame().shown)
        if (shown.output.layer == "filterWidth")
            out.push_back(shown.output.term);
    return out;
}

/// Standard deviations of a term's filter, metres, a plane; 0 where it is not filtered.
inline std::vector<float> widthsOf(render::Renderer& renderer, const std::string& term)
{
    std::vector<float> planes = renderer.frame().planes("filterWidth" + term).downloadAll(renderer.queue());
    planes.resize(renderer.frame().layout.size);
    return planes;
}

/// The beauty of the whole frame, rendered with these settings, or the last of a progressive one.
inline std::vector<float> renderPixels(
    render::Renderer& renderer, const render::Settings& settings, bool keepLayers = false)
{
    if (settings.progressive)
        renderer.renderProgressively(settings, {}, {}, keepLayers);
    else
        renderer.render(settings, {}, keepLayers);
    return pixels(renderer, "beauty", { 0, 0, settings.width, settings.height });
}

inline render::Settings sized(render::Settings settings, int width, int height)
{
    settings.width = width;
    settings.height = height;
    return settings;
}

/// Root of the mean squared difference.
inline double rmse(std::span<const float> a, std::span<const float> b)
{
    REQUIRE(a.size() == b.size());
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += (static_cast<double>(a[i]) - b[i]) * (static_cast<double>(a[i]) - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

/// How many values are NaN or infinite.
inline std::size_t notFinite(std::span<const float> values)
{
    std::size_t count = 0;
    for (const float v : values)
        count += std::isfinite(v) ? 0 : 1;
    return count;
}

/// Parameters of a whole image.
template <class Params = shared::AnalysisParams>
Params paramsOf(const render::PlaneLayout& layout)
{
    Params p {};
    p.x1 = p.width = layout.width;
    p.y1 = p.height = layout.height;
    p.stride = layout.stride;
    p.planeSize = static_cast<std::uint32_t>(layout.size);
    return p;
}

template <class Visit>
void everyPixel(const render::PlaneLayout& layout, const Visit& visit)
{
    for (int y = 0; y < static_cast<int>(layout.height); ++y)
        for (int x = 0; x < static_cast<int>(layout.width); ++x)
            visit(x, y);
}

} // namespace wedge::test
