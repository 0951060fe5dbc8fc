#pragma once

#include "host/render/distributed_frame.h"

#include <array>
#include <atomic>
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

/// The two halves of a progressive frame: distributed frames of samples that are independent of each other, both of
/// which keep what they have sampled from step to step. The image is their mean, and they tell its error: see
/// errorOfHalves in kernels/progressive.cl.
class Halves {
public:
    /// terms: the shapes of a half's.
    static void plan(device::MemoryPlan& plan, const PlaneLayout& layout, const std::vector<TermShape>& terms);

    Halves(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout,
        const std::vector<TermShape>& terms);

    /// Whether the buffers serve frames of this layout and these terms.
    bool hold(const PlaneLayout& layout, const std::vector<TermShape>& terms) const;

    /// Starts anew. context: of all but the frame; its settings are those of the last step, and outlive the steps.
    /// lights: area lights among the terms.
    void begin(const TermContext& context, Waves& waves, std::size_t lights, const shared::CameraParams& camera,
        bool keepLayers);

    /// Takes samples up to spp a pixel of both halves together; each has half of them, rounded down, but one at least.
    /// Returns false if stopped.
    bool refine(int spp, const std::atomic<bool>& stop);

    /// Makes the image and everything that layers and statistics read, in `shown`, a distributed frame.
    void show(Frame& shown);

    /// Of the image shown, over the window of the context; parts of it go to planes of `shown` that have no other use.
    ErrorEstimate error(Frame& shown) const;

    /// Of the first half.
    const std::vector<std::unique_ptr<Term>>& terms() const { return halves_[0].terms; }
    bool analysed() const { return halves_[0].image->analysed(); }

private:
    struct Half {
        std::unique_ptr<Frame> frame;
        std::vector<std::unique_ptr<Term>> terms;
        std::unique_ptr<device::Buffer<float>> emission; ///< layer, filtered
        std::unique_ptr<DistributedFrame> image;
    };

    shared::DistributedParams params() const;

    std::array<Half, 2> halves_;
    std::unique_ptr<TermContext> context_; ///< of the first half
    Settings all_; ///< of the last step
    Settings step_; ///< of a half at the current one; the contexts refer to it
    int sampled_ = 0; ///< halves that have their first samples
};

} // namespace wedge::render
