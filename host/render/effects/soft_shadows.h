#pragma once

#include "host/render/device_scene.h"
#include "host/render/frame.h"
#include "host/render/passes.h"
#include "host/render/settings.h"
#include "kernels/shared/filter_params.h"

namespace wedge::render {

/// Direct light of area lights, thesis chapter 3: slopes, widths and counts (kernels/shared/wedge.h), samples, filter,
/// shading. One light at a time; each is a term of its own.
class SoftShadows {
public:
    /// What a light's term needs. specular: the scene reflects so; analysed: with filter.
    static TermShape termShape(bool specular, bool analysed);

    /// window: the pixels that the result is wanted for.
    SoftShadows(Passes& passes, const DeviceScene& scene, Frame& frame, Term& term, const Settings& settings,
        const shared::FrameParams& fullFrame, const shared::FrameParams& sampledFrame, const image::Window& window);

    /// Samples, filters and adds light `index` to frame.direct and directNoisy. Returns false if cancelled while
    /// sampling; what was sampled until then is filtered and added all the same.
    bool render(std::uint32_t index);

    /// Whether the last light got widths: not so in plain Monte Carlo, nor if its first pass was cancelled.
    bool analysed() const { return analysed_; }

private:
    bool sample();
    bool firstPass();
    bool secondPass(std::uint32_t from);
    void widthsAndCounts();
    void publishedWidths();
    void smoothedWidths();
    void countsFromVariance();
    void uniformCounts();
    void shade(const device::Buffer<float>& value);
    shared::AnalysisParams analysisParams(const image::Window& window) const;
    const shared::AreaLight& light() const { return scene_.areaLightList[index_]; }
    shared::SampleParams sampleParams() const;
    std::uint32_t lightSampling() const;

    Passes& passes_;
    const DeviceScene& scene_;
    Frame& frame_;
    Term& term_;
    const Settings& settings_;
    shared::FrameParams fullFrame_, sampledFrame_;
    image::Window full_, window_;
    std::uint32_t index_ = 0;
    bool analysed_ = false;
};

} // namespace wedge::render
