#pragma once

#include "effects/area_lights/light_widths.h"
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

/// Settings::wideBlur and wideBlurExponent of filters of both slopes, whose error is of higher order, so that kinks of
/// shadows show sooner: constants as chosen in docs/maaf.md.
inline constexpr float twoSlopeWideBlur = 8.0f, twoSlopeWideBlurExponent = 0.5f;

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

/// Pairs of components along u by those along v.
std::uint32_t partPlanes(int components);

/// As the paper has it: plain means over 5 x 5 pixels.
inline constexpr SlopeWindow slopeWindowOfComponents { false, 2 };

/// What the filter of components takes besides values and widths.
struct ComponentTerm {
    graph::Handle<Sums> sums;
    graph::Handle<Value> components;
    graph::Handle<Metres> slopeWidth;
    graph::Handle<Share> ratio;
};

/// Declares the filter of components (kernels/filter/components.h) into planes that were there. parts: what each pair
/// of components has of a pixel's visibility, partPlanes() of them; null where nobody wants it
void componentFilter(FrameBuilder& frame, shared::FilterParams params, const shared::AnalysisParams& analysis,
    const shared::AreaLight& light, const graph::Handle<Value>& shown, const graph::Handle<Metres>& beta,
    const ComponentTerm& term, Gathered& out, graph::Handle<Value>* parts);

} // namespace wedge::render
