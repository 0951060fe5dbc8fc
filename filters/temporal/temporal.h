#pragma once

#include "filters/temporal/object_motion.h"
#include "host/device/memory_plan.h"
#include "host/graph/execution.h"
#include "host/render/renderer.h"
#include "host/render/settings.h"
#include "kernels/shared/frame.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
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

/// The filter over time (docs/temporal.md): keeps what frames of a sequence found, and takes means over those that are
/// still in the window, each looked up where surfaces were in it.
class TemporalFilter {
public:
    /// Frames are of one size, and of one filter. device must outlive this.
    explicit TemporalFilter(const device::Device& device);
    ~TemporalFilter();

    /// Device memory that it takes besides a frame's, before anything of it is allocated.
    static void addTo(device::MemoryPlan& plan, const render::Settings& settings, const render::PreparedScene& scene);

    /// Keeps the renderer's frame, of which all layers and the whole image are there, for those after it. Frames come
    /// in their order. places: of the scene's objects in this frame; null where none ever moves. statistics: of the
    /// frame, to which this adds what it takes.
    void keep(render::Renderer& renderer, const render::Settings& settings, std::shared_ptr<const ObjectPlaces> places,
        render::FrameStatistics& statistics);

    /// The same, and makes of beauty, direct and indirect light of the renderer's frame the means over the frames of
    /// the window that were kept.
    void filter(render::Renderer& renderer, const render::Settings& settings,
        std::shared_ptr<const ObjectPlaces> places, render::FrameStatistics& statistics);

    /// Launches its kernels over nothing, so that none is compiled later. After Renderer::rehearse().
    void rehearse(render::Renderer& renderer, const render::Settings& settings);
    /// Calls look() with all of its passes, and runs none: for tests of single ones. After Renderer::rehearse().
    void show(render::Renderer& renderer, const render::Settings& settings,
        const std::function<void(const graph::Graph&)>& look);

private:
    struct Kept;
    struct Handles;
    struct Declaration;

    Kept& slotOf(std::uint32_t frame, const render::Settings& settings);
    /// Its planes, where they are not there.
    void allocate(Kept& kept, const Declaration& d) const;
    /// Means of a frame, what it keeps being in the graph, and the frames before it. motions: memory that the graph
    /// reads.
    void declareMeans(Declaration& d, const Handles& handles, std::uint32_t number, bool rehearsal,
        std::vector<device::Buffer<float>>& motions);
    void run(render::Renderer& renderer, const render::Settings& settings, std::shared_ptr<const ObjectPlaces> places,
        bool filters, render::FrameStatistics* statistics, const std::function<void(const graph::Graph&)>& look = {});

    const device::Device& device_;
    std::vector<Kept> kept_;
    graph::Memory memory_;
};

} // namespace wedge::filters
