#pragma once

#include "host/render/filter_chain.h"
#include "host/render/receiver_set.h"
#include "kernels/shared/curvature.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/indirect.h"
#include "kernels/shared/path.h"

#include <cstdint>

namespace wedge::render {

/// What a term holds that is sampled by rays over the hemisphere.
enum class Component : std::uint32_t {
    Diffuse = WEDGE_COMPONENT_DIFFUSE,
    Glossy = WEDGE_COMPONENT_GLOSSY,
    Ambient = WEDGE_COMPONENT_AMBIENT,
    Emitters = WEDGE_COMPONENT_EMITTERS,
    EmittersGlossy = WEDGE_COMPONENT_EMITTERS_GLOSSY,
    Environment = WEDGE_COMPONENT_ENVIRONMENT,
    EnvironmentGlossy = WEDGE_COMPONENT_ENVIRONMENT_GLOSSY,
};

/// Whether a component is of the specular lobes.
constexpr bool isGlossy(Component c)
{
    return c == Component::Glossy || c == Component::EmittersGlossy || c == Component::EnvironmentGlossy;
}
/// Whether it is direct light of what the list of lights has.
constexpr bool isOfEmitters(Component c) { return c == Component::Emitters || c == Component::EmittersGlossy; }
/// Whether it is direct light from beyond the scene.
constexpr bool isOfEnvironment(Component c) { return c == Component::Environment || c == Component::EnvironmentGlossy; }
/// Whether it is direct light.
constexpr bool isDirect(Component c) { return isOfEmitters(c) || isOfEnvironment(c); }

/// What filters can be on it by.
Target targetOf(Component component);

/// Whether a component's samples are fractions of what would arrive if nothing were hidden, and its reflectance is
/// multiplied by that.
inline bool isRelative(Component c, const Settings& settings)
{
    return c == Component::Environment && settings.method == Method::AxisAligned && settings.environment.relative;
}

/// Whether its samples are such fractions by themselves: of lobes, where the pixels are the receivers and what lobes
/// would see is known well enough.
bool isOfFractions(const FrameBuilder& frame, Component component);

/// How well what lobes would see is known, of so many samples a pixel: unshadowedLobe() looks along twice the square of
/// this number of directions.
std::uint32_t lobeRings(int spp);

/// Whether the widths of a component's filter follow from curvatures, where the pixels are the receivers.
inline bool isByCurvature(Component c, const Settings& settings)
{
    return isOfEnvironment(c) && settings.method == Method::AxisAligned && settings.filtering != Filtering::Fixed
        && settings.environment.widths != EnvironmentWidths::Penumbrae;
}

/// Whether its samples are those of the analysis, 16 a pixel: of widths by curvatures no counts follow, unless from
/// variances; and where no more are asked for there is nothing to share out. Of what is beyond the scene the analysis
/// takes fewer.
inline bool takesFirstPathsOnly(Component c, const Settings& settings)
{
    const bool spectrum =
        settings.sampling == Sampling::Adaptive && settings.indirect.counts == IndirectCounts::Spectrum;
    return spectrum ? isByCurvature(c, settings)
                    : !isOfEnvironment(c) && settings.spp <= static_cast<int>(WEDGE_INDIRECT_FIRST_RAYS);
}

/// What these need besides where pixels lie.
shared::CurvatureParams curvatureParams(const FrameBuilder& frame, Component component);

/// The filter of a component where the pixels are the receivers, or their means.
shared::FilterParams pathFilterParams(const FrameBuilder& frame, Component component);

/// What the analysis of a component needs besides the rectangle.
shared::ReflectorParams reflectorParams(const FrameBuilder& frame, Component component);

/// The lights that a component's samples see, kernels/paths/indirect.cl.
std::vector<graph::Argument> sceneLights(const FrameBuilder& frame, Component component);

/// What samplePaths takes of a component and of receivers; next come counts of samples, and what these become.
Arguments pathSamples(
    const FrameBuilder& frame, const ReceiverSet& at, const shared::PathParams& params, Component component);

/// How paths are traced where the pixels are the receivers.
shared::PathParams pathParams(const FrameBuilder& frame, Component component);

/// Pixels: filters of a component that are narrower are compared with one of this width (kernels/analysis/widening.cl).
float wideningOf(Component component, const Settings& settings);

/// Samples that the analysis of a component begins with where the pixels are the receivers.
std::uint32_t firstPathsOf(Component component, const Settings& settings);

/// What counts of a component's paths need besides where pixels lie.
shared::AnalysisParams pathCountParams(shared::AnalysisParams params, Component component, const Settings& settings);

/// Declares how the widths of a component's filter, metres, follow from the distances of reflectors
/// (kernels/paths/reflectors.cl).
void reflectorWidths(FrameBuilder& frame, const shared::ReflectorParams& params,
    const graph::Handle<Extremes>& reflectors, const graph::Handle<Count>& taken, graph::Handle<Metres>& beta);

/// The same of the counts (4.21), as published.
void reflectorCounts(FrameBuilder& frame, const shared::ReflectorParams& params,
    const graph::Handle<Extremes>& reflectors, const graph::Handle<Count>& taken, graph::Handle<Count>& wanted);

} // namespace wedge::render
