#pragma once

#include "filters/temporal/object_motion.h"
#include "host/device/device.h"
#include "host/render/frame_filter.h"
#include "host/render/settings.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace wedge::filters {

/// Frames that one is the mean of, itself among them, at most.
constexpr std::uint32_t temporalWindow = 8;

/// The same by this filter.
constexpr std::uint32_t windowOf(render::Temporal filter)
{
    return filter == render::Temporal::Published ? 2 : temporalWindow;
}

/// The first frame that frame n is made of. There are none before 0.
constexpr std::uint32_t firstOfWindow(std::uint32_t frame, render::Temporal filter)
{
    return frame - std::min(frame, windowOf(filter) - 1);
}

/// The filter over time (docs/temporal.md): keeps what frames of a sequence found, and makes of beauty, direct and
/// indirect light of a frame the means over those that are still in the window, each looked up where surfaces were in
/// it. Frames come in their order, each by its number Settings::frame. Those of another size or with other terms begin
/// a sequence anew. A frame that was stopped is not kept.
class TemporalFilter : public render::FrameFilter {
public:
    /// device must outlive this.
    explicit TemporalFilter(const device::Device& device);
    ~TemporalFilter() override;

    /// Of the next frame that is rendered. places: of the scene's objects in it; null where none ever moves. filters:
    /// false: it is kept for those after it, and left as it is.
    void next(std::shared_ptr<const ObjectPlaces> places, bool filters = true);

    bool filters(const render::Settings& settings) const override { return settings.temporal != render::Temporal::Off; }
    void addTo(
        device::MemoryPlan& plan, const render::Settings& settings, const render::PreparedScene& scene) const override;
    void allocate(const render::Settings& settings, const render::PreparedScene& scene) override;
    void declare(render::FrameBuilder& frame) override;

private:
    struct Kept;
    class Passes;

    const device::Device& device_;
    std::vector<Kept> kept_; ///< frame n at [n % window]
    std::shared_ptr<const ObjectPlaces> places_; ///< next()
    bool filters_ = true;
};

} // namespace wedge::filters
