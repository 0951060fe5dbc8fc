#pragma once

#include "host/device/memory_plan.h"
#include "host/render/prepared_scene.h"
#include "host/render/settings.h"

namespace wedge::render {

struct FrameBuilder;

/// What is done to each frame of a sequence once it is made: passes of its graph, after its own, that may read what
/// earlier frames left and leave something for later ones.
class FrameFilter {
public:
    FrameFilter() = default;
    FrameFilter(const FrameFilter&) = delete;
    FrameFilter& operator=(const FrameFilter&) = delete;
    virtual ~FrameFilter() = default;

    /// Whether it is of frames of these settings.
    virtual bool filters(const Settings& settings) const = 0;
    /// Adds what it keeps from frame to frame, before anything of it is allocated.
    virtual void addTo(device::MemoryPlan& plan, const Settings& settings, const PreparedScene& scene) const = 0;
    /// Allocates that, where it is not there in this size. Throws Error where the device refuses.
    virtual void allocate(const Settings& settings, const PreparedScene& scene) = 0;
    /// Declares its passes over the frame's sums, before filters and after them, which it may change, and over
    /// position, normal, reflectances and object of its surfaces; of the others, and of sums' deviations, there are
    /// some where pixels are the receivers alone. Of a frame that is not run (frame.scene is null) nothing need be
    /// allocated.
    virtual void declare(FrameBuilder& frame) = 0;
};

} // namespace wedge::render
