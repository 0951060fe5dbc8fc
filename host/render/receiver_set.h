#pragma once

#include "host/render/frame_builder.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace wedge::render {

/// Points that light is gathered at, as passes take them: the pixels of a frame, or the receivers of one of its waves.
class ReceiverSet {
public:
    ReceiverSet() = default;
    virtual ~ReceiverSet() = default;
    ReceiverSet(const ReceiverSet&) = delete;
    ReceiverSet& operator=(const ReceiverSet&) = delete;

    /// FrameParams of a launch over them.
    virtual graph::Argument frame() const = 0;
    virtual const Surfaces& surfaces() const = 0;
    /// By the names of WEDGE_RECEIVER_ARGUMENTS.
    virtual Arguments arguments() const = 0;
    /// Which of its pixel's samples each is; absent where it has all of them.
    virtual graph::Argument sampleOf() const = 0;
    /// Samples to take of each, of light that is added as it is sampled. None: a receiver is itself one sample of its
    /// pixel.
    virtual std::optional<std::uint32_t> samples() const = 0;

    /// Counts of the rays that are traced for them: all, and those of paths.
    virtual graph::Argument tallyRays() = 0;
    virtual graph::Argument tallyPathRays() = 0;

    /// A pass over tiles of them, of light that is added as it is sampled. workUnits: of a launch over all pixels; in
    /// waves all work is the camera's and the terms'.
    virtual void trace(std::string name, graph::KernelName kernel, Arguments arguments,
        const std::function<double(const graph::Launch&)>& workUnits) = 0;
};

/// The pixels of a frame, each of which is a receiver.
class PixelReceivers : public ReceiverSet {
public:
    explicit PixelReceivers(FrameBuilder& frame);

    graph::Argument frame() const override { return f_.frame(rows_); }
    const Surfaces& surfaces() const override { return f_.surfaces; }
    Arguments arguments() const override;
    graph::Argument sampleOf() const override { return graph::absent("sampleOf", graph::counts); }
    std::optional<std::uint32_t> samples() const override { return static_cast<std::uint32_t>(f_.settings.spp); }
    graph::Argument tallyRays() override;
    graph::Argument tallyPathRays() override;
    void trace(std::string name, graph::KernelName kernel, Arguments arguments,
        const std::function<double(const graph::Launch&)>& workUnits) override;

    /// Has passes after it sample those of a launch's pixels alone.
    void limit(RowsOf rows) { rows_ = std::move(rows); }
    const RowsOf& rows() const { return rows_; }

    /// Adds what was tallied to the frame's totals, after a pass that traced some; and begins anew, so that nothing of
    /// it takes memory until there are more.
    void countRays();

private:
    void begin();

    FrameBuilder& f_;
    RowsOf rows_;
    graph::Handle<Count> rays_, pathRays_;
    bool tallied_ = false, pathsTallied_ = false; ///< by a pass: counting alone has nobody clear a plane
};

} // namespace wedge::render
