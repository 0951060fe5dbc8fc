#include "effects/area_lights/shadow_filter.h"

#include "effects/area_lights/maaf.h"
#include "effects/area_lights/soft_shadows.h"
#include "host/render/sinks.h"

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr FilterRun filterRun { "filter", PassKind::Filter };

/// The separable Gaussian of kernels/filter/gather.h.
class GaussianShadows : public ShadowFilter {
public:
    using ShadowFilter::ShadowFilter;

    void gather(const shared::FilterParams& params, const shared::AnalysisParams& /*analysis*/, const LightSamples& of,
        const graph::Handle<Metres>& beta, Gathered& out) override
    {
        gaussianFilter(f_, filterRun, channels(), params, of.value, beta, out);
    }
};

/// Those that know how visibility changes with where on the light a point is.
class ShadowsOfGradients : public ShadowFilter {
public:
    ShadowsOfGradients(FrameBuilder& frame, const shared::AreaLight& light, const graph::Format& format,
        const std::optional<Maaf>& maaf)
        : ShadowFilter(frame, light)
        , format_(format)
        , maaf_(maaf)
        , gradients_(frame.graph.plane<Value>("gradients", format))
    {
    }

    void start() override { f_.zero(gradients_); }
    /// By counts and where shadows are wide.
    void narrow(const shared::AnalysisParams& analysis, const LightSamples& of, graph::Handle<Metres>& beta) override
    {
        const Narrowing narrowing = narrowingOf(f_.settings, maaf_);
        slopeWidth_ = f_.graph.plane<Metres>("width by slopes", shortFloats);
        f_.pixels("filter", PassKind::Filter, { "analysis/shear.cl", "narrowSheared" },
            { f_.rectangle(analysis), value("mean", static_cast<float>(f_.settings.spp)),
                value("countPower", narrowing.countPower), value("wideBlur", narrowing.wideBlur),
                value("blurPower", narrowing.blurPower), reads("taken", of.taken),
                reads("pixelSize", f_.surfaces.pixelSize), writes("slopeWidth", slopeWidth_), updates("beta", beta) });
    }

protected:
    /// Makes gradients of what samples added up; each: numbers of a channel.
    void gradientsOfSums(
        const shared::AnalysisParams& analysis, std::uint32_t each, float first, const LightSamples& of)
    {
        f_.blocks("filter", PassKind::Filter, { "analysis/shear.cl", "shadowGradients" },
            { f_.rectangle(analysis), value("each", each), value("first", first), value("second", WEDGE_ORDER2),
                reads("sums", of.sums), updates("gradients", gradients_) });
    }

    graph::Format format_;
    std::optional<Maaf> maaf_;
    graph::Handle<Value> gradients_;
    graph::Handle<Metres> slopeWidth_;
};

/// Sheared (kernels/filter/gather_sheared.h).
class ShearedShadows : public ShadowsOfGradients {
public:
    ShearedShadows(FrameBuilder& frame, const shared::AreaLight& light)
        : ShadowsOfGradients(frame, light, gradientsOf(frame.specular() ? 2 : 1), {})
    {
    }

    void keep(std::vector<graph::Sink>& sinks, Arguments& sunk) override
    {
        sinks.push_back(sinks::scores());
        sunk.push_back(value("score", scoreOf(light_).score));
        sunk.push_back(updates("gradients", gradients_));
    }
    shared::AnalysisParams withWidths(shared::AnalysisParams p) const override
    {
        return withShearedWidths(p, f_.settings, light_);
    }
    void narrow(const shared::AnalysisParams& analysis, const LightSamples& of, graph::Handle<Metres>& beta) override
    {
        gradientsOfSums(analysis, 2, 1.0f, of);
        ShadowsOfGradients::narrow(analysis, of, beta);
    }
    void gather(const shared::FilterParams& params, const shared::AnalysisParams& analysis, const LightSamples& of,
        const graph::Handle<Metres>& beta, Gathered& out) override
    {
        shearedFilter(f_, filterRun, channels(), withShear(params, analysis, light_), of.value, beta,
            { gradients_, slopeWidth_, format_, false }, out);
    }
};

/// By both slopes that bound an occluder's spectrum, with second derivatives.
class TwoSlopeShadows : public ShadowsOfGradients {
public:
    TwoSlopeShadows(FrameBuilder& frame, const shared::AreaLight& light)
        : ShadowsOfGradients(frame, light, momentsFormat(frame.specular() ? 2 : 1), Maaf::TwoSlope)
        , ratio_(frame.graph.plane<Share>("ratio of slopes", shortFloats))
    {
    }

    void keep(std::vector<graph::Sink>& sinks, Arguments& sunk) override
    {
        sinks.push_back(sinks::moments());
        sunk.push_back(value("scores", momentsOf(light_)));
        sunk.push_back(updates("moments", gradients_));
    }
    shared::AnalysisParams withWidths(shared::AnalysisParams p) const override { return withTwoSlopeWidths(p, light_); }
    const BothSlopes* bothSlopes() override { return &both_; }
    void narrow(const shared::AnalysisParams& analysis, const LightSamples& of, graph::Handle<Metres>& beta) override
    {
        gradientsOfSums(analysis, WEDGE_MOMENTS, -WEDGE_ORDER1, of);
        ShadowsOfGradients::narrow(analysis, of, beta);
        f_.pixels("filter", PassKind::Filter, { "analysis/two_slopes.cl", "widthOfMeanSlope" },
            { f_.rectangle(analysis), reads("ratio", ratio_), updates("slopeWidth", slopeWidth_) });
    }
    void gather(const shared::FilterParams& params, const shared::AnalysisParams& analysis, const LightSamples& of,
        const graph::Handle<Metres>& beta, Gathered& out) override
    {
        shearedFilter(f_, filterRun, channels(), withTwoSlopes(params, analysis, light_), of.value, beta,
            { gradients_, slopeWidth_, format_, true }, out);
    }

private:
    graph::Handle<Share> ratio_;
    BothSlopes both_ { ratio_, true, slopeWindowOf(Maaf::TwoSlope) };
};

/// By components along each axis of the light, which go by slopes alone.
class ShadowsOfComponents : public ShadowsOfGradients {
public:
    ShadowsOfComponents(FrameBuilder& frame, const shared::AreaLight& light, Maaf maaf)
        : ShadowsOfGradients(frame, light, componentsFormat(frame.settings.components, frame.specular() ? 2 : 1), maaf)
        , ratio_(frame.graph.plane<Share>("ratio of slopes", shortFloats))
        , both_ { ratio_, false, slopeWindowOf(maaf) }
    {
    }

    void keep(std::vector<graph::Sink>& sinks, Arguments& sunk) override
    {
        sinks.push_back(sinks::components(f_.settings.components));
        sunk.push_back(value("axes", axesOf(light_, f_.settings.components)));
        sunk.push_back(updates("components", gradients_));
    }
    const BothSlopes* bothSlopes() override { return &both_; }
    bool widens() const override { return false; }
    graph::Handle<Value> shown() override
    {
        if (f_.layers != nullptr && parts_.graph == 0) {
            const auto planes = static_cast<std::uint32_t>(componentsLayer(f_.settings).channels.size());
            parts_ = f_.graph.plane<Value>("components", graph::floatPlanes(planes));
            f_.zero(parts_);
        }
        return parts_;
    }
    void gather(const shared::FilterParams& params, const shared::AnalysisParams& analysis, const LightSamples& of,
        const graph::Handle<Metres>& beta, Gathered& out) override
    {
        componentFilter(f_, withComponents(params), analysis, light_, of.value, beta,
            { of.sums, gradients_, slopeWidth_, ratio_ }, out, parts_.graph != 0 ? &parts_ : nullptr);
    }

private:
    graph::Handle<Share> ratio_;
    BothSlopes both_;
    graph::Handle<Value> parts_; ///< what shown() declared
};

} // namespace

std::unique_ptr<ShadowFilter> shadowFilterOf(FrameBuilder& frame, const shared::AreaLight& light)
{
    const std::optional<Maaf> maaf = maafOf(frame.settings, light);
    if (maaf == Maaf::TwoSlope) {
        return std::make_unique<TwoSlopeShadows>(frame, light);
    }
    if (maaf) {
        return std::make_unique<ShadowsOfComponents>(frame, light, *maaf);
    }
    if (isSheared(frame.settings)) {
        return std::make_unique<ShearedShadows>(frame, light);
    }
    return std::make_unique<GaussianShadows>(frame, light);
}

} // namespace wedge::render
