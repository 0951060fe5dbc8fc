// One pass of a frame by itself, as the product declares it: its planes are filled and read by the names that its
// kernel has them by, whatever format they are stored in.
#pragma once

#include "host/graph/execution.h"
#include "host/render/device_scene.h"
#include "host/render/halves.h"
#include "host/render/kernel_types.h"
#include "host/render/renderer.h"
#include "tests/render_support.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wedge::test {

/// A frame that is declared and not run, of a scene that is on the device; of a progressive one its first step.
class DeclaredFrame {
public:
    DeclaredFrame(const device::Device& device, const scene::Scene& scene, const render::Settings& settings,
        bool keepLayers = false, const render::Options& options = renderOptions());

    const graph::Graph& graph() const { return declared_->graph(); }
    const render::PreparedScene& scene() const { return renderer.scene(); }

    render::Renderer renderer; ///< of its programs and its queue
    render::PlaneLayout layout;
    const render::Hierarchy tree;
    const render::DeviceScene onDevice;

private:
    render::HalfMemories memories_;
    std::unique_ptr<render::FrameGraph> declared_;
};

/// One of a frame's passes. Planes are vectors of all their elements, padding included, and lists likewise; those of
/// several parts have one part after the other. All are 0 at first. A name that the pass has not, a wrong type, a wrong
/// size, and what a kernel writes before or behind its planes, or beside its window, are a std::logic_error, which
/// fails the test.
class PassBench {
public:
    /// The pass that has that kernel: the first, or the nth, of those called `pass`, or of all.
    PassBench(DeclaredFrame& frame, const std::string& kernel, const std::string& pass = "", std::size_t nth = 0)
        : PassBench(frame.renderer, frame.graph(), kernel, pass, nth)
    {
    }
    /// Of a graph that the renderer's programs run, and which this does not refer to.
    PassBench(render::Renderer& renderer, const graph::Graph& graph, const std::string& kernel,
        const std::string& pass = "", std::size_t nth = 0);

    /// Whether the pass hands its kernel a plane of that name.
    bool has(const std::string& name) const;
    /// Of a plane or a list; all of its parts have as many.
    std::size_t elements(const std::string& name) const;

    /// Fills a plane, as exactly as its format holds numbers.
    void plane(const std::string& name, const std::vector<float>& values);
    void plane(const std::string& name, const std::vector<std::uint32_t>& values);
    void plane(const std::string& name, const std::vector<std::uint64_t>& values);
    template <class T>
    void plane(const std::string& name, const Planes<T>& planes)
    {
        plane(name, planes.values);
    }
    /// Fills all planes that `from` has by the same names with what they hold there.
    void take(const PassBench& from);
    /// What a plane holds: as it was filled, or after run().
    template <class T>
    std::vector<T> read(const std::string& name) const;
    /// The same of pixels.
    template <class T>
    Planes<T> pixels(const std::string& name) const
    {
        return planesOf(layout, read<T>(name));
    }

    /// Replaces a value that the pass hands its kernel.
    template <device::KernelValue T>
    void value(const std::string& name, const T& instead)
    {
        setValue(name, graph::kernelType<T>, std::as_bytes(std::span(&instead, 1)));
    }
    /// The value that the pass hands it itself. planned: as in rehearsals, for what is known in the midst of a frame
    /// alone.
    template <device::KernelValue T>
    T own(const std::string& name, bool planned = false) const
    {
        const std::vector<std::byte> bytes = ownValue(name, graph::kernelType<T>, planned);
        T out;
        std::memcpy(&out, bytes.data(), sizeof(T));
        return out;
    }

    struct List {
        std::string name;
        graph::Format format;
        std::uint64_t elements;
    };
    /// Has other sinks take the samples of a kernel that takes some. Of these values, and of these lists, which are 0
    /// at first, it is handed what the sinks are.
    void sinks(const std::vector<graph::Sink>& becoming, const std::vector<graph::Argument>& values,
        const std::vector<List>& lists);

    /// The pixels that are covered; else all.
    void window(const Window& pixels) { window_ = pixels; }
    /// Tiles or items of a list, in place of the pass's own count.
    void items(std::size_t count) { items_ = count; }

    void run();

    const render::PlaneLayout layout;

private:
    const graph::Argument& argument(const std::string& name) const;
    const graph::Resource& planeOf(const std::string& name) const;
    Window covered() const;
    graph::Graph emptyGraph() const; ///< of the frame's size
    void setValue(const std::string& name, std::string_view type, std::span<const std::byte> bytes);
    std::vector<std::byte> ownValue(const std::string& name, std::string_view type, bool planned) const;
    const graph::Argument& valueOf(const std::string& name, std::string_view type) const;
    void execute(graph::Graph& graph, bool planned) const;
    /// Whether a pass that covers its window and no more has changed anything else of a plane.
    bool changesBeside(const std::string& name, const std::vector<std::byte>& contents) const;
    /// Calls add() inside of that many loops, which run once.
    template <class Add>
    void inLoops(graph::Graph& graph, std::size_t loops, const Add& add) const;

    render::Renderer& renderer_;
    graph::Pass pass_;
    std::size_t loops_ = 0; ///< that it is in
    std::map<std::string, graph::Resource> planes_;
    std::map<std::string, std::vector<std::byte>> contents_; ///< of planes, as they are stored
    std::map<std::string, std::vector<std::byte>> values_; ///< replaced
    std::optional<Window> window_;
    std::optional<std::size_t> items_;
};

template <>
std::vector<float> PassBench::read(const std::string& name) const;
template <>
std::vector<std::uint32_t> PassBench::read(const std::string& name) const;
template <>
std::vector<std::uint64_t> PassBench::read(const std::string& name) const;

/// So many numbers, all different from 0.
inline std::vector<float> someNumbers(std::mt19937& random, std::size_t count, double least = -1, double most = 1)
{
    std::vector<float> out(count);
    std::ranges::generate(out, [&] { return static_cast<float>(uniform(random, least, most)); });
    return out;
}
/// So many whole numbers below `end`.
inline std::vector<std::uint32_t> someCounts(std::mt19937& random, std::size_t count, std::uint32_t end)
{
    std::vector<std::uint32_t> out(count);
    std::ranges::generate(out, [&] { return static_cast<std::uint32_t>(random() % end); });
    return out;
}

} // namespace wedge::test
