#pragma once

#include "host/device/buffer.h"
#include "host/graph/execution.h"
#include "host/graph/graph.h"
#include "host/image/image.h"
#include "host/render/frame.h"

#include <optional>
#include <string>
#include <vector>

namespace wedge::render {

/// Which pixels of an output mean something; others are 0 in layers.
enum class Where { Everywhere, OnSurfaces };

/// What becomes of an output that both halves of a progressive frame have.
enum class Join {
    First, ///< the first half's
    Mean, ///< of colours, weighted by their primary samples
    Sum, ///< of counts, of pixels that are shown
    SumOfTraced, ///< of counts, of all that was traced, for whatever pixels
    Surface, ///< of what their primary rays met, see joinSurfaces of kernels/frame/progressive.cl
};

/// What a frame makes that is read when it is done: planes of pixels, or a list.
struct Output {
    std::string layer; ///< what it is called, of layers as those are (layers.h)
    std::string term = {}; ///< of layers that each term has one of: its name
    graph::Version version = {};
    Where where = Where::Everywhere;
    Join join = Join::First;

    std::string name() const { return layer + term; }
};

/// All outputs of a frame, in the order in which it makes them.
class Outputs {
public:
    /// The newest version is what will be read. Throws std::logic_error where there is one of that name.
    void add(Output output);
    void add(const std::string& layer, const graph::Version& version, Where where = Where::Everywhere,
        Join join = Join::First)
    {
        add({ layer, {}, version, where, join });
    }
    /// Shows another version in the place of one that there is; where: where that means something, if that changes.
    void replace(const std::string& name, const graph::Version& version, std::optional<Where> where = {});
    const std::vector<Output>& all() const { return all_; }
    /// Of that name; null where there is none.
    const Output* find(const std::string& name) const;
    /// Wants all of them of the graph, over those pixels.
    void want(graph::Graph& graph, const image::Window& window) const;

private:
    std::vector<Output> all_;
};

/// What is there of a frame once it has run: parts of the renderer's memory.
struct Frame {
    struct Shown {
        Output output;
        cl::Buffer memory;
        std::uint64_t bytes = 0;
        std::uint32_t planes = 0; ///< of whole numbers or floats, one of each pixel; 0 of lists and of what is packed
        bool whole = false; ///< of std::uint32_t; else of float
    };

    PlaneLayout layout;
    bool distributed = false; ///< pixels have several receivers, and these are means over them
    bool keepsLayers = false; ///< there is all that layers show
    std::vector<Shown> shown = {};

    bool has(const std::string& name) const;
    /// Of that name. Vectors are three planes one after the other. Throws std::logic_error where there is none.
    const Shown& find(const std::string& name) const;
    template <class T = float>
    device::Buffer<T> planes(const std::string& name) const
    {
        const Shown& of = find(name);
        return device::Buffer<T>::over(of.memory, of.bytes / sizeof(T), name);
    }
    device::Buffer<std::uint32_t> counts(const std::string& name) const { return planes<std::uint32_t>(name); }
};

} // namespace wedge::render
