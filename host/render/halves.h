#pragma once

#include "host/render/distributed_samples.h"
#include "host/render/frame_graph.h"

#include <array>
#include <memory>
#include <vector>

namespace wedge::render {

/// What is known of the mean squared error of an image, over pixels and channels; not numbers where nothing is.
struct ErrorEstimate {
    double noise; ///< variance
    double bias; ///< squared bias: unbiased itself, and so below 0 at times

    /// Root of the mean squared error.
    double rmse() const;
};

/// What the halves of a progressive frame keep from step to step.
using HalfMemories = std::array<SampleMemory, 2>;

/// One step of a progressive frame. Its two halves are samples that are independent of each other, both of which keep
/// what they have sampled from step to step. The image is their mean, and they tell its error: see errorOfHalves in
/// kernels/frame/progressive.cl.
class HalvesFrame : public FrameGraph {
public:
    /// As DistributedFrame. settings: of the last step. memories: of both halves, rewound. before, spp: samples a pixel
    /// of both together that there are, 0 at the first step, and that there are to be; each half has half of them,
    /// rounded down, but one at least.
    HalvesFrame(const PreparedScene& scene, const DeviceScene* deviceScene, const Settings& settings,
        std::size_t packetSize, bool keepLayers, HalfMemories& memories, int before, int spp);

    /// Of the image shown, over its window.
    ErrorEstimate error(const graph::Execution& execution, device::TimedQueue& queue) const;

private:
    struct Half {
        Settings settings;
        std::unique_ptr<FrameBuilder> frame;
        std::unique_ptr<DistributedSamples> samples;
    };

    // Outputs of both halves become one. They are of the kinds that Join has.
    graph::Version mean(const graph::Version& one, const graph::Version& other);
    graph::Version sum(const graph::Version& one, const graph::Version& other);
    graph::Version sumOfTraced(const graph::Version& one, const graph::Version& other);
    Surfaces joinedSurfaces();
    void join();
    void estimateError(bool analysed);

    std::array<Half, 2> halves_;
    graph::Handle<Squares> noise_, bias_;
};

} // namespace wedge::render
