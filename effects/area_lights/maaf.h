#pragma once

#include "effects/area_lights/light_widths.h"
#include "host/render/effect.h"
#include "host/render/filters/filter_graph.h"
#include "host/render/frame_builder.h"
#include "host/render/settings.h"
#include "kernels/shared/components.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/light.h"

#include <cstdint>
#include <optional>
#include <string>

namespace wedge::render {

// Multiple axis-aligned filters of area lights where the pixels are the receivers, docs/maaf.md.

/// The filters that method maaf has for a light; none where its filter is that of method aaf.
std::optional<Maaf> maafOf(const Settings& settings, const shared::AreaLight& light);

/// Which lights have such filters, for people.
std::string lightOf(Maaf maaf);

/// What its samples are expanded in by filters of both slopes. Scores have the profile's own moments: the first of
/// order 1, the second of order 2, cut as the profile is.
shared::LightMoments momentsOf(const shared::AreaLight& light);
/// And by components.
shared::LightAxes axesOf(const shared::AreaLight& light, int components);

/// How many numbers a pixel keeps of its samples, 16 bits each.
graph::Format momentsFormat(std::uint32_t channels);
graph::Format componentsFormat(int components, std::uint32_t channels);

/// The analysis' parameters with the widths of filters of both slopes, where these are the same.
shared::AnalysisParams withTwoSlopeWidths(shared::AnalysisParams params, const shared::AreaLight& light);

/// The gather's parameters with what neighbours' moments count for. analysis: as above
shared::FilterParams withTwoSlopes(
    shared::FilterParams params, const shared::AnalysisParams& analysis, const shared::AreaLight& light);

/// The layer of what each pair of components along u and along v (which runs fastest) has of a light's visibility.
LayerInfo componentsLayer(const Settings& settings);

/// Over which pixels slopes are taken together: by components as the paper has it, plain means over 5 x 5 pixels.
/// maaf: maafOf() of the light
SlopeWindow slopeWindowOf(const std::optional<Maaf>& maaf);

/// How filters that follow gradients narrow by counts and where shadows are wide, narrowSheared() of
/// kernels/analysis/shear.cl. Filters of both slopes have a blur and a power of their own, chosen in docs/maaf.md:
/// their error is of higher order, so that kinks of shadows show sooner. Components narrow by neither.
struct Narrowing {
    float countPower = 0, wideBlur = 1, blurPower = 0;
};
Narrowing narrowingOf(const Settings& settings, const std::optional<Maaf>& maaf);

/// What the filter of components takes besides values and widths.
struct ComponentTerm {
    graph::Handle<Sums> sums;
    graph::Handle<Value> components;
    graph::Handle<Metres> slopeWidth;
    graph::Handle<Share> ratio;
};

/// The gather's parameters of components: neighbours as the paper has them.
shared::FilterParams withComponents(shared::FilterParams params);

/// Declares the filter of components (kernels/filter/components.cl) into planes that were there. params: of
/// withComponents(). parts: planes of componentsLayer(); null where nobody wants them
void componentFilter(FrameBuilder& frame, const shared::FilterParams& params, const shared::AnalysisParams& analysis,
    const shared::AreaLight& light, const graph::Handle<Value>& shown, const graph::Handle<Metres>& beta,
    const ComponentTerm& term, Gathered& out, graph::Handle<Value>* parts);

} // namespace wedge::render
