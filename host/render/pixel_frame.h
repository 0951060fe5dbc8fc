#pragma once

#include "host/graph/execution.h"
#include "host/render/frame_builder.h"

#include <memory>
#include <string>
#include <vector>

namespace wedge::render {

/// A frame whose pixels are the receivers of light, through a pinhole, with nothing that moves: as a graph. Its passes
/// refer to it and to what it was made of.
class PixelFrame {
public:
    /// deviceScene: null for a graph that is planned and not run. keepLayers: the widths of the terms' filters are
    /// wanted, too.
    PixelFrame(const scene::Scene& scene, const DeviceScene* deviceScene, const Settings& settings,
        std::size_t packetSize, const cl::Buffer& unused, bool keepLayers);
    PixelFrame(const PixelFrame&) = delete;
    PixelFrame& operator=(const PixelFrame&) = delete;

    const graph::Graph& graph() const { return graph_; }
    bool keepsLayers() const { return keepsLayers_; }

    /// What is to be read of a run.
    std::unique_ptr<Frame> outputs(const graph::Execution& execution) const;

    /// One of termNames() each, in their order.
    struct TermWidths {
        std::shared_ptr<TermState> state;
        graph::Handle<Metres> beta; ///< wanted only of layers
    };
    const std::vector<TermWidths>& terms() const { return terms_; }

private:
    void primary(bool lit);
    void deltaLights();
    void fallBack(Sum& sum);
    template <class Declare>
    void term(const std::string& name, bool keepWidths, const Declare& declare);
    void wantOutputs(bool keepLayers);

    bool keepsLayers_;
    Settings settings_;
    graph::Graph graph_;
    FrameBuilder f_;
    std::vector<TermWidths> terms_;
};

} // namespace wedge::render
