#pragma once

#include "effects/area_lights/light_widths.h"
#include "host/render/filters/filter_graph.h"
#include "host/render/frame_builder.h"
#include "kernels/shared/light.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace wedge::render {

/// A light's samples, where the pixels are the receivers.
struct LightSamples {
    graph::Handle<Sums> sums;
    graph::Handle<Value> value; ///< means
    graph::Handle<Count> taken;
};

/// How a light's shadows are filtered where the pixels are the receivers: what samples keep for it besides their sums,
/// what that makes of widths, and what gathers neighbours. There is one for each light.
class ShadowFilter {
public:
    ShadowFilter(FrameBuilder& frame, const shared::AreaLight& light)
        : f_(frame)
        , light_(light)
    {
    }
    virtual ~ShadowFilter() = default;
    ShadowFilter(const ShadowFilter&) = delete;
    ShadowFilter& operator=(const ShadowFilter&) = delete;

    /// Declares what samples add to, as nothing.
    virtual void start() { }
    /// Adds what becomes of each sample, and what that is handed.
    virtual void keep(std::vector<graph::Sink>& /*sinks*/, Arguments& /*sunk*/) { }
    /// The analysis' parameters with its widths.
    virtual shared::AnalysisParams withWidths(shared::AnalysisParams p) const { return p; }
    /// Of one that takes both slopes of occluders; else null.
    virtual const BothSlopes* bothSlopes() { return nullptr; }
    /// Whether its widths may be widened by what samples say (kernels/analysis/widening.cl).
    virtual bool widens() const { return true; }
    /// Narrows the filter once all samples are there, before any widening. analysis: of withWidths()
    virtual void narrow(
        const shared::AnalysisParams& /*analysis*/, const LightSamples& /*of*/, graph::Handle<Metres>& /*beta*/)
    {
    }
    /// Filters the means into planes that were there. params: of filterParams() of the light
    virtual void gather(const shared::FilterParams& params, const shared::AnalysisParams& analysis,
        const LightSamples& of, const graph::Handle<Metres>& beta, Gathered& out) = 0;
    /// What its layer shows, 0 until it has filtered; of no graph where it has none or nobody reads it.
    virtual graph::Handle<Value> shown() { return {}; }

protected:
    std::uint32_t channels() const { return f_.specular() ? 2 : 1; }

    FrameBuilder& f_;
    shared::AreaLight light_;
};

/// The one that the settings have for a light: by an axis-aligned Gaussian, sheared along gradients, by both slopes of
/// occluders, or by components.
std::unique_ptr<ShadowFilter> shadowFilterOf(FrameBuilder& frame, const shared::AreaLight& light);

} // namespace wedge::render
