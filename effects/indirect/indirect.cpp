#include "effects/indirect/indirect.h"

#include "host/render/filters/gaussian.h"
#include "host/render/glass.h"
#include "kernels/shared/indirect.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/glm.hpp>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::writes;

std::vector<graph::Argument> sceneLights(const FrameBuilder& frame, Component component)
{
    const bool other = isOfEmitters(component) && frame.scene != nullptr && !frame.scene->sharedTerm.ofEmitters;
    return graph::together("lights",
        joined({ frame.ofScene("areaLights", "AreaLight", &DeviceScene::areaLights),
                   frame.ofScene("deltaLights", "DeltaLight", &DeviceScene::deltaLights),
                   frame.ofScene("emitters", "Emitter", other ? &DeviceScene::sharedLights : &DeviceScene::emitters),
                   frame.ofScene(
                       "emitterPicks", "float", other ? &DeviceScene::sharedPicks : &DeviceScene::emitterPicks) },
            frame.beyond(),
            Arguments { frame.environmentSamples ? reads("environmentSamples", *frame.environmentSamples)
                                                 : graph::absent("environmentSamples") }));
}

Target targetOf(Component component)
{
    const auto name = [&] {
        switch (component) {
        case Component::Diffuse:
            return "indirectDiffuse";
        case Component::Glossy:
            return "indirectGlossy";
        case Component::Ambient:
            return "ambient";
        case Component::Emitters:
            return "emitters";
        case Component::EmittersGlossy:
            return "emittersGlossy";
        case Component::Environment:
            return "environment";
        case Component::EnvironmentGlossy:
            break;
        }
        return "environmentGlossy";
    };
    const bool bounces = component == Component::Diffuse || component == Component::Glossy;
    return { name(), bounces }; // what is found by bounces has outliers
}

shared::PathParams pathParams(const FrameBuilder& frame, Component component)
{
    const Settings& settings = frame.settings;
    shared::PathParams p {};
    p.component = static_cast<std::uint32_t>(component);
    p.bounces = static_cast<std::uint32_t>(std::max(1, settings.bounces));
    p.sampler = static_cast<std::uint32_t>(settings.sampler);
    p.lightSampling = static_cast<std::uint32_t>(settings.lightSampling);
    p.firstPass = settings.method == Method::AxisAligned ? firstPathsOf(component, settings) : 0;
    p.ambientDistance = settings.indirect.ambientDistance > 0 ? settings.indirect.ambientDistance
                                                              : std::numeric_limits<float>::infinity();
    const DeviceScene* scene = frame.scene;
    const bool direct = isOfEmitters(component), quads = !direct || (scene != nullptr && scene->sharedTerm.quads);
    p.areaLights = quads ? static_cast<std::uint32_t>(frame.description.areaLights.size()) : 0;
    p.deltaLights = scene != nullptr ? scene->deltaLightCount : 0;
    p.emitters = scene == nullptr ? 0 : direct ? scene->sharedTerm.count : scene->emitterCount;
    p.emitterShare = frame.scene != nullptr ? frame.scene->emitterShare : 0.0f;
    p.environmentShare = frame.scene != nullptr ? frame.scene->environmentShare : 0.0f;
    p.precomputed = frame.environmentSamples ? 1 : 0;
    p.relative = isRelative(component, settings) ? 1 : 0;
    p.fractions = isOfFractions(frame, component) ? 1 : 0;
    p.occluders = isByCurvature(component, settings) ? 1 : 0;
    p.skipsMirrors = component != Component::Ambient ? 1 : 0;
    p.sceneDiameter = frame.scene != nullptr ? frame.scene->diameter : 0.0f;
    p.mostMirrored = static_cast<std::uint32_t>(settings.maxSurfaces);
    if (scene != nullptr && frame.description.traits().touchingGlass > 0.0f) {
        p.touching = frame.description.traits().touchingGlass;
        const std::vector<std::uint32_t> media = mediaAt(frame.description, scene::middleCamera(frame.description).eye);
        p.mediaCount = static_cast<std::uint32_t>(media.size());
        std::ranges::copy(media, p.media);
    }
    if (scene != nullptr) {
        const glm::vec3 &low = scene->sharedTerm.low, &high = scene->sharedTerm.high;
        p.emittersLow = shared::vec3(low.x, low.y, low.z);
        p.emittersHigh = shared::vec3(high.x, high.y, high.z);
        p.directedWithin = scene->sharedTerm.directedWithin;
    }
    return p;
}

shared::ReflectorParams reflectorParams(const FrameBuilder& frame, Component component)
{
    const Settings& settings = frame.settings;
    const IndirectSettings& in = settings.indirect;
    shared::ReflectorParams p {};
    p.component = static_cast<std::uint32_t>(component);
    p.mu = in.mu;
    p.alpha = in.alpha;
    p.widthScale = isOfEnvironment(component) ? settings.environment.widthScale : in.widthScale;
    p.leastReflector = in.leastReflector;
    p.meanFraction = in.meanFraction;
    p.fractions = isOfFractions(frame, component) ? 1 : 0;
    p.countCap = static_cast<std::uint32_t>(in.maxSpp);
    p.fixedWidth = settings.filtering == Filtering::Fixed ? settings.fixedWidth : 0.0f;
    p.width = frame.layout.width;
    p.height = frame.layout.height;
    p.stride = frame.layout.stride;
    p.planeSize = static_cast<std::uint32_t>(frame.layout.size);
    p.extent = in.extent == ReflectorExtent::Scene && frame.scene != nullptr ? frame.scene->largestDimension : 0.0f;
    return p;
}

namespace {

// The corrected recipe: more than the clamped cosine's bandwidth of 2.36 on curvature, and B_e of soft maps.
constexpr float correctedCurvedBand = 6.0f, correctedLightBand = 4.0f;
constexpr float correctedNormalDegrees = 20.0f;
constexpr std::uint32_t correctedRadius = 15;

} // namespace

shared::CurvatureParams curvatureParams(const FrameBuilder& frame, Component component)
{
    shared::CurvatureParams p {};
    p.component = static_cast<std::uint32_t>(component);
    p.cosineBand = 1.0f;
    p.hiddenLobes = 2.0f;
    if (frame.settings.environment.widths == EnvironmentWidths::Corrected) {
        p.curvedBand = correctedCurvedBand;
        p.lightBand = correctedLightBand;
        p.leastPixels = 1.0f;
        p.mostPixels = 5.0f;
        return p;
    }
    if (frame.settings.environment.widths == EnvironmentWidths::LightTransport) {
        // (2 kappa + 1/z) B_rho, which is the cosine's B_f of diffuse reflection, whatever the map's band.
        p.cosineBand = isGlossy(component) ? 0.0f : 1.0f;
        p.curvedBand = 2.0f * p.cosineBand;
        p.hiddenLobes = 1.0f;
    } else {
        p.curvedBand = 1.0f;
        p.lightBand = frame.scene != nullptr ? frame.scene->environmentBandwidth.value() : 0.0f;
    }
    p.isSigned = 1;
    // No bounds but of numbers: filters end at maxRadius.
    p.leastPixels = 1e-3f;
    p.mostPixels = 1e3f;
    return p;
}

shared::FilterParams pathFilterParams(const FrameBuilder& frame, Component component)
{
    shared::FilterParams p = filterParams(frame.settings, frame.wholeFrame(), frame.graph.image());
    if (component == Component::Environment) {
        p.normalCosine = std::cos(glm::radians(frame.settings.environment.normalDegrees));
    } else if (component == Component::Ambient || isOfFractions(frame, component)) {
        p.most = 1.0f;
    }
    if (isByCurvature(component, frame.settings)) {
        p.fitted = 0;
    }
    if (isByCurvature(component, frame.settings) && frame.settings.environment.widths == EnvironmentWidths::Corrected) {
        p.maxRadius = correctedRadius;
        p.normalCosine =
            std::cos(glm::radians(isGlossy(component) ? frame.settings.normalDegrees : correctedNormalDegrees));
    }
    return p;
}

float wideningOf(Component component, const Settings& settings)
{
    return component == Component::EnvironmentGlossy ? settings.environment.lobeWidening : settings.indirect.widening;
}

bool isOfFractions(const FrameBuilder& frame, Component component)
{
    constexpr int mostSpp = 128; // of more samples plain means are as near
    const Settings& s = frame.settings;
    return component == Component::EnvironmentGlossy && s.method == Method::AxisAligned && s.environment.relative
        && usesFallback(s) && s.spp <= mostSpp && frame.narrowLobes;
}

std::uint32_t lobeRings(int spp)
{
    constexpr std::uint32_t fewest = 4;
    return std::max(static_cast<std::uint32_t>(1.5f * std::sqrt(static_cast<float>(spp))), fewest);
}

std::uint32_t firstPathsOf(Component component, const Settings& settings)
{
    // Fewer tell nothing of how much they vary.
    constexpr std::uint32_t fewest = 4;
    const float share = settings.environment.firstShare * static_cast<float>(settings.spp);
    return isOfEnvironment(component) && settings.environment.firstShare < 1.0f
            && !takesFirstPathsOnly(component, settings)
        ? std::clamp(static_cast<std::uint32_t>(share), fewest, WEDGE_INDIRECT_FIRST_RAYS)
        : WEDGE_INDIRECT_FIRST_RAYS;
}

shared::AnalysisParams pathCountParams(shared::AnalysisParams p, Component component, const Settings& settings)
{
    p.countCap = static_cast<std::uint32_t>(std::max(settings.indirect.maxSpp, settings.spp)); // not below the mean
    p.countExponent = settings.indirect.countExponent;
    p.varianceSpread = settings.varianceSpread;
    // Where the first paths met nothing bright there is still noise of what they may meet: rare, and large, but for
    // what lies beyond the scene, which is chosen by its brightness.
    const float share = isOfEnvironment(component) ? settings.environment.leastShare : 0.5f;
    p.leastCount = std::max(
        firstPathsOf(component, settings), static_cast<std::uint32_t>(share * static_cast<float>(settings.spp)));
    return p;
}

namespace {

/// Largest dimension of what the camera sees, metres.
graph::Handle<Metres> visibleExtent(FrameBuilder& frame, const graph::Argument& p)
{
    auto bounds = frame.graph.list<Metres>("visible bounds", graph::floats, 6 * WEDGE_EXTENT_STRIPES);
    auto extent = frame.graph.list<Metres>("visible extent", graph::floats, 1);
    frame.items("widths", PassKind::Analysis, { "paths/reflectors.cl", "visibleBounds" }, WEDGE_EXTENT_STRIPES,
        { p, reads("position", frame.surfaces.position), reads("objectId", frame.surfaces.objectId),
            writes("bounds", bounds) });
    frame.items("widths", PassKind::Analysis, { "paths/reflectors.cl", "visibleExtent" }, 1,
        { reads("bounds", bounds), writes("extent", extent) });
    return extent;
}

/// What kernels make widths or counts of.
std::vector<graph::Argument> found(FrameBuilder& frame, const shared::ReflectorParams& params,
    const graph::Handle<Extremes>& reflectors, const graph::Handle<Count>& taken)
{
    const Surfaces& s = frame.surfaces;
    const graph::Argument p = frame.rectangle(params);
    const graph::Reach near = graph::around(WEDGE_NEARNESS_REACH);
    return { p, reads("reflectors", reflectors, near), reads("objectId", s.objectId, near),
        reads("extent", visibleExtent(frame, p)), reads("pixelSize", s.pixelSize), reads("gloss", s.gloss),
        reads("taken", taken, near) };
}

} // namespace

void reflectorWidths(FrameBuilder& frame, const shared::ReflectorParams& params,
    const graph::Handle<Extremes>& reflectors, const graph::Handle<Count>& taken, graph::Handle<Metres>& beta)
{
    frame.blocks("widths", PassKind::Analysis, { "paths/reflectors.cl", "reflectorWidths" },
        joined(found(frame, params, reflectors, taken), Arguments { writes("beta", beta) }));
}

void reflectorCounts(FrameBuilder& frame, const shared::ReflectorParams& params,
    const graph::Handle<Extremes>& reflectors, const graph::Handle<Count>& taken, graph::Handle<Count>& wanted)
{
    frame.blocks("counts", PassKind::Analysis, { "paths/reflectors.cl", "reflectorCounts" },
        joined(found(frame, params, reflectors, taken), Arguments { writes("wanted", wanted) }));
}

Arguments pathSamples(
    const FrameBuilder& frame, const ReceiverSet& at, const shared::PathParams& params, Component component)
{
    return joined({ at.frame(), graph::value("params", params) }, frame.hierarchy(), frame.geometry(),
        sceneLights(frame, component), at.arguments(), Arguments { graph::reads("specular", at.surfaces().specular) });
}

} // namespace wedge::render
