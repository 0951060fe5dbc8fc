#pragma once

#include "effects/area_lights/shadow_filter.h"
#include "effects/area_lights/soft_shadows.h"
#include "host/render/filters/filter_graph.h"
#include "host/render/pixel_term.h"
#include "kernels/shared/light.h"
#include "kernels/shared/wedge.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace wedge::render {

/// Direct light of an area light where the pixels are the receivers, thesis chapter 3: slopes of occluders, widths and
/// counts, samples, filter, shading.
class LightPixels : public PixelTerm {
public:
    LightPixels(FrameBuilder& frame, const TermLight& light);

private:
    Sampler sampler() override;
    std::uint32_t firstSamples() const override { return WEDGE_FIRST_PASS_RAYS; }
    std::uint32_t mostSamples() const override;
    CountsFrom countsFrom() const override;
    bool keepsParts() const override { return f_.analysed(); }
    void keepMore(std::vector<graph::Sink>& sinks, Arguments& sunk) override;
    void start() override { filter_->start(); }
    void widths() override;
    Uncertain uncertainty() override;
    graph::Version mask() const override { return f_.surfaces.objectId; }
    void means() override { value_ = meansOf("filter", device::PassKind::Filter); }
    void addPlain() override { shade(value_, {}); }
    void addFiltered() override;

    /// What the samples that are there are filtered as.
    graph::Handle<Value> meansOf(const char* pass, device::PassKind kind);
    void widened();
    void filter(Gathered& filtered);
    void shade(const graph::Handle<Value>& shown, const std::function<bool(const graph::Run&)>& condition);
    /// Adds to the sum's change what an effect makes of what is seen.
    void changeVisibility(const graph::Handle<Value>& shown);
    /// What shading goes by of matt surfaces, and of lobes.
    Arguments ofMatt() const;
    Arguments ofLobes() const;

    LightSamples lightSamples() const { return { sums_, value_, taken_ }; }
    shared::FilterParams filterParams() const { return render::filterParams(s_, f_.wholeFrame(), light_, g_.image()); }
    shared::AnalysisParams analysisParams() const
    {
        return filter_->withWidths(lightParams(f_.analysisParams(), s_, light_));
    }
    graph::Argument sampleParams() const { return graph::value("params", lightSampleParams(s_, index_)); }
    graph::Argument light() const { return graph::value("light", light_); }

    std::uint32_t index_;
    std::string term_;
    std::uint32_t quad_; ///< its number among the scene's area lights, where there is a changer
    const Effect* changer_; ///< of what is seen; null: nothing changes it
    shared::AreaLight light_;
    std::uint32_t channels_; ///< of what is seen: diffuse, and where something is specular that, too
    std::unique_ptr<ShadowFilter> filter_;
};

} // namespace wedge::render
