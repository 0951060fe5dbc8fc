// Settings as names and values, for metadata and reports.
#include "host/render/filter_chain.h"
#include "host/render/settings.h"

#include <fmt/format.h>

namespace wedge::render {
namespace {

using Descriptions = std::vector<std::pair<std::string, std::string>>;

void describeIndirect(const IndirectSettings& in, Descriptions& out)
{
    const auto number = [](auto value) { return fmt::format("{}", value); };
    constexpr const char* counts[] = { "uniform", "spectrum", "variance" };
    out.insert(out.end(),
        { { "indirectMu", number(in.mu) }, { "indirectAlpha", number(in.alpha) },
            { "indirectWidthScale", number(in.widthScale) },
            { "reflectorExtent", in.extent == ReflectorExtent::Scene ? "scene" : "visible" },
            { "leastReflector", number(in.leastReflector) }, { "meanFraction", number(in.meanFraction) },
            { "indirectCounts", counts[static_cast<int>(in.counts)] },
            { "indirectCountExponent", number(in.countExponent) }, { "indirectMaxSpp", number(in.maxSpp) } });
}

void describeDistributed(const DistributedSettings& d, Descriptions& out)
{
    const auto number = [](auto value) { return fmt::format("{}", value); };
    out.insert(out.end(),
        { { "distributedCounts", d.published ? "spectrum" : "variance" },
            { "distributedFirstPaths", number(d.firstPaths) }, { "distributedMaxSpp", number(d.maxSpp) },
            { "distributedMu", number(d.mu) }, { "mixedPaths", number(d.mixedPaths) },
            { "factoring", d.factoring == Factoring::Never ? "never" : "error" },
            { "factoringError", number(d.factoringError) }, { "factoringRadius", number(d.factoringRadius) },
            { "blur", number(d.blur) }, { "blurWidth", number(d.blurWidth) },
            { "blurExponent", number(d.blurExponent) }, { "shutterWidth", number(d.shutterWidth) },
            { "shutterExponent", number(d.shutterExponent) }, { "leastRadius", number(d.leastRadius) },
            { "leastShare", number(d.leastShare) }, { "leastTermShare", number(d.leastTermShare) },
            { "leastPrimaries", number(d.leastPrimaries) }, { "leastSecondaries", number(d.leastSecondaries) },
            { "irradianceWidth", number(d.irradianceWidth) }, { "distributedCountExponent", number(d.countExponent) },
            { "distributedVarianceSpread", number(d.varianceSpread) }, { "oneVelocity", number(d.oneVelocity) } });
}

void describeAnalysis(const Settings& s, Descriptions& out)
{
    const auto number = [](auto value) { return fmt::format("{}", value); };
    out.insert(out.end(),
        { { "counts", s.counts == Counts::Spectrum ? "spectrum" : "variance" },
            { "slopes", s.slopes == Slopes::Published ? "published" : "smoothed" }, { "mu", number(s.mu) },
            { "k", number(s.k) }, { "alpha", number(s.alpha) }, { "oblique", number(s.oblique) },
            { "narrower", number(s.narrower) }, { "surface", number(s.surface) }, { "fitted", number(s.fitted) },
            { "sheared", number(s.sheared) }, { "shearedWidth", number(s.shearedWidth) },
            { "countWidth", number(s.countWidth) }, { "wideBlur", number(s.wideBlur) },
            { "wideBlurExponent", number(s.wideBlurExponent) }, { "fallback", number(s.fallback) },
            { "widening", number(s.widening) }, { "normalDegrees", number(s.normalDegrees) }, { "cut", number(s.cut) },
            { "maxRadius", number(s.maxRadius) }, { "fillSigma", number(s.fillSigma) },
            { "fillRadius", number(s.fillRadius) }, { "countExponent", number(s.countExponent) },
            { "varianceFloor", number(s.varianceFloor) }, { "varianceSpread", number(s.varianceSpread) } });
}

void describeEnvironment(const EnvironmentSettings& e, Descriptions& out)
{
    const auto number = [](auto value) { return fmt::format("{}", value); };
    constexpr const char* widths[] = { "penumbrae", "curvature", "flt", "corrected" };
    out.insert(out.end(),
        { { "environmentRelative", number(e.relative) }, { "environmentNormalDegrees", number(e.normalDegrees) },
            { "environmentWidthScale", number(e.widthScale) }, { "environmentLobeWidening", number(e.lobeWidening) },
            { "environmentFirstShare", number(e.firstShare) }, { "environmentLeastShare", number(e.leastShare) },
            { "environmentWidths", widths[static_cast<int>(e.widths)] } });
}

void describeShadows(const ShadowSettings& s, Descriptions& out)
{
    if (s.shadows == Shadows::Sampled) {
        return;
    }
    out.emplace_back("shadows", shadowsName(s.shadows));
    out.emplace_back("shadowLights", shadowLightsText(s));
    if (s.blockSide > 1) {
        out.emplace_back("shadowScale", shadowScaleText(s));
    }
    if (s.shadows != Shadows::Additive) {
        constexpr const char* names[] = { "map", "prefiltered", "lights", "cache" };
        out.emplace_back("shadowComplete", names[static_cast<int>(s.whole)]);
    }
    if (s.shadows == Shadows::Subtractive) {
        out.emplace_back("shadowClamp", s.clamp ? "on" : "off");
    }
}

} // namespace

std::string shadowsName(Shadows shadows)
{
    constexpr const char* names[] = { "sampled", "additive", "subtractive", "ratio" };
    return names[static_cast<int>(shadows)];
}

std::string shadowLightsText(const ShadowSettings& s)
{
    return s.chosen > 0 ? fmt::format("{}:{}", s.lights, s.chosen) : fmt::format("{}", s.lights);
}

std::string shadowScaleText(const ShadowSettings& s)
{
    return s.blockSide > 1 ? fmt::format("1/{}", s.blockSide * s.blockSide) : "1";
}

std::string methodName(Method method) { return method == Method::MonteCarlo ? "mc" : "aaf"; }

std::string methodName(const Settings& settings) { return settings.maaf ? "maaf" : methodName(settings.method); }

std::vector<std::pair<std::string, std::string>> describe(const Settings& s)
{
    const auto number = [](auto value) { return fmt::format("{}", value); };
    constexpr const char* shadings[] = { "separate", "inside", "ratio" };
    constexpr const char* lightSamplings[] = { "both", "lights", "directions" };
    constexpr const char* filters[] = { "none", "fixed", "adaptive" };
    Descriptions out = {
        { "method", methodName(s) },
        { "setting", s.published ? "as published" : "default" },
        { "sampler", s.sampler == Sampler::Sobol ? "owen-sobol" : "stratified" },
        { "shading", shadings[static_cast<int>(s.shading)] },
        { "sampling", s.sampling == Sampling::Uniform ? "uniform" : "adaptive" },
        { "filter", filters[static_cast<int>(s.filtering)] },
        { "spp", number(s.spp) },
        { "maxSpp", number(s.maxSpp) },
        { "integrator", s.integrator == Integrator::Path ? "path" : "ao" },
        { "bounces", number(s.bounces) },
        { "lightSampling", lightSamplings[static_cast<int>(s.lightSampling)] },
        { "environmentSampling", s.environment.sampling == EnvironmentSampling::Map ? "map" : "precomputed" },
        { "progressive", s.progressive ? "true" : "false" },
    };
    if (s.integrator == Integrator::Path) {
        describeShadows(s.environment.shadows, out);
    }
    if (!s.styles) {
        out.emplace_back("styles", "off");
    }
    if (s.styles && s.styleMargin != Settings().styleMargin) {
        out.emplace_back("styleMargin", number(s.styleMargin));
    }
    if (s.sameNumbers) {
        out.emplace_back("sequence", "same random numbers");
    }
    if (s.maxSurfaces != Settings().maxSurfaces) {
        out.emplace_back("maxSurfaces", number(s.maxSurfaces));
    }
    if (s.temporal != Temporal::Off) {
        out.emplace_back("temporal", s.temporal == Temporal::On ? "on" : "published");
    }
    if (s.maaf) {
        constexpr const char* kinds[] = { "printed", "refitted", "two-slope" };
        out.emplace_back("maaf", kinds[static_cast<int>(*s.maaf)]);
        if (*s.maaf != Maaf::TwoSlope) {
            out.emplace_back("components", number(s.components));
        }
    }
    if (tracesPaths(s) && s.integrator == Integrator::AmbientOcclusion) {
        out.emplace_back("ambientDistance", number(s.indirect.ambientDistance));
    }
    if (s.method == Method::AxisAligned) { // all of it with maaf, too: lights that it has no filter for go by it
        describeAnalysis(s, out);
        // Bounces or not: light of meshes and environments goes by it, too.
        describeIndirect(s.indirect, out);
        describeEnvironment(s.environment, out);
        describeDistributed(s.distributed, out);
    }
    if (s.antialias) {
        constexpr const char* pixelFilters[] = { "box", "gaussian", "blackman-harris" };
        out.emplace_back("antialias", "true");
        out.emplace_back("pixelFilter", pixelFilters[static_cast<int>(s.pixelFilter)]);
    }
    if (!s.filters.empty()) {
        out.emplace_back("filters", describe(s.filters));
    }
    if (s.filtering == Filtering::Fixed) {
        out.emplace_back("fixedWidth", number(s.fixedWidth));
    }
    return out;
}

} // namespace wedge::render
