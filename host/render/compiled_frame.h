#pragma once

#include "host/device/memory_plan.h"
#include "host/graph/plan.h"
#include "host/graph/rerun.h"
#include "host/render/frame_graph.h"

#include <memory>
#include <optional>

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
        Settings own = declared_->settings();
        own.frame = own.sameNumbers ? settings.frame : own.frame; // they are the same frame
        return own == settings && declared_->keepsLayers() == keepLayers;
    }
    /// The values of the last run, where that was whole and its memory is still as it left it.
    std::optional<graph::ChangingValues> kept;
    bool runsAgain = false; ///< its next run is of these, for the scene has changed in nothing but such values

private:
    std::unique_ptr<FrameGraph> declared_;
    graph::Plan plan_;
};

} // namespace wedge::render
