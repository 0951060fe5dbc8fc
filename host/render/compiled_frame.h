#pragma once

#include "host/device/memory_plan.h"
#include "host/graph/plan.h"
#include "host/render/frame_graph.h"

#include <memory>

namespace wedge::render {

/// A frame that is declared and planned, ready to be run any number of times. It refers to the scene, on the host and
/// on the device.
class CompiledFrame {
public:
    CompiledFrame(std::unique_ptr<FrameGraph> declared, const graph::SlabRules& slabs)
        : declared_(std::move(declared))
        , plan_(declared_->graph(), device::partAlignment, slabs)
    {
    }

    const FrameGraph& declared() const { return *declared_; }
    const graph::Plan& plan() const { return plan_; }
    bool isOf(const Settings& settings, bool keepLayers) const
    {
        return declared_->settings() == settings && declared_->keepsLayers() == keepLayers;
    }

private:
    std::unique_ptr<FrameGraph> declared_;
    graph::Plan plan_;
};

} // namespace wedge::render
