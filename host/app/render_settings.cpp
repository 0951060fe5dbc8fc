#include "host/app/render_settings.h"

#include "effects/area_lights/maaf.h"
#include "effects/styled_shadows/styled_lights.h"
#include "filters/image/filter_section.h"
#include "host/app/render_counts.h"
#include "host/app/shadow_settings.h"
#include "host/app/values.h"
#include "host/error.h"
#include "host/render/distributed_frame.h"
#include "host/render/effect.h"
#include "host/render/emitters.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::app {
namespace {

using render::Counts;
using render::Filtering;
using render::Integrator;
using render::Method;
using render::Sampling;

constexpr int defaultMonteCarloSpp = 64;

/// One of `methods`.
std::string resolveMethod(const RenderOptions& options, const scene::Scene& scene)
{
    if (options.method) {
        return *options.method;
    }
    return options.asPublished ? "aaf" : scene.settings.method.value_or("aaf");
}

/// Options that plain Monte Carlo has no use for are mistakes, not wishes to ignore.
void refuseFilterOptions(const RenderOptions& o)
{
    const std::pair<const char*, bool> given[] = { { "--as-published", o.asPublished }, { "--mu", o.mu.has_value() },
        { "--max-spp", o.maxSpp.has_value() }, { "--sampling", o.sampling.has_value() },
        { "--filter", o.filter.has_value() }, { "--filter-width", o.filterWidth.has_value() },
        { "--falloff", o.falloff.has_value() }, { "--counts", o.counts.has_value() },
        { "--environment-widths", o.environmentWidths.has_value() },
        { "--temporal", o.temporal.value_or(render::Temporal::Off) != render::Temporal::Off } };
    for (const auto& [name, isGiven] : given) {
        if (isGiven) {
            throw UsageError("option has no effect with method mc", name, "leave it out, or choose --method aaf");
        }
    }
}

/// What goes with method maaf alone, and what does not go with it.
void applyMaaf(const RenderOptions& o, const std::string& method, render::Settings& s)
{
    if (method != "maaf") {
        refuse(o.maaf.has_value(), "with method " + method, "--maaf", "choose --method maaf");
        refuse(o.components.has_value(), "with method " + method, "--components", "choose --method maaf");
        return;
    }
    s.maaf = o.maaf.value_or(render::Maaf::TwoSlope);
    refuse(o.components && *s.maaf == render::Maaf::TwoSlope, "with --maaf two-slope, whose filter is one",
        fmt::format("--components {}", o.components.value_or(0)), "choose --maaf refitted or printed");
    s.components = o.components.value_or(s.components);
    // Several filters follow from slopes, and are of visibilities.
    const std::pair<const char*, bool> given[] = { { "--as-published", o.asPublished },
        { "--filter none", o.filter == Filtering::None }, { "--filter fixed", o.filter == Filtering::Fixed },
        { "--falloff inside", o.falloff == render::Shading::Inside } };
    for (const auto& [name, isGiven] : given) {
        if (isGiven) {
            throw UsageError("option does not go with method maaf", name, "leave it out, or choose --method aaf");
        }
    }
}

/// The filters of method maaf, where they are named, have to be those of a light: without being asked for any, frames
/// in which no light has them go as with method aaf.
void refuseIdleMaaf(
    const RenderOptions& o, const render::PreparedScene& scene, bool distributed, const render::Settings& s)
{
    if (!s.maaf || !o.maaf) { // --components is refused without
        return;
    }
    const std::string option = "--maaf " + maafs[static_cast<std::size_t>(*o.maaf)];
    refuse(s.integrator == Integrator::AmbientOcclusion, "with integrator ao", option, "add --integrator path");
    refuse(s.progressive, "with --progressive", option, "render in one step");
    refuse(distributed, fmt::format("with method maaf {}", distributedFrames), option,
        "render through a pinhole what does not move, without antialiasing");
    const std::vector<render::OwnLight>& lights = scene.directLights().own;
    const auto anyHas = [&](render::Maaf maaf) {
        render::Settings of = s;
        of.maaf = maaf;
        return std::ranges::any_of(
            lights, [&](const render::OwnLight& light) { return render::maafOf(of, light.onDevice()).has_value(); });
    };
    refuse(!anyHas(*s.maaf), "without " + render::lightOf(*s.maaf), option,
        anyHas(render::Maaf::TwoSlope) ? "choose --maaf two-slope" : "give the scene such a light");
}

/// The mu of the thesis: 3, more conservative, where the light is not a Gaussian or the cosine is filtered along, and
/// else 2 (section 3.7, "Extensions", Fig. 3.11).
float publishedMu(const RenderOptions& o, const render::PreparedScene& scene)
{
    const bool uniform = std::ranges::any_of(scene.directLights().own,
        [](const render::OwnLight& light) { return light.quad.profile == scene::LightProfile::Uniform; });
    return uniform || o.falloff == render::Shading::Inside ? 3.0f : 2.0f;
}

render::Settings preset(const RenderOptions& o, const render::PreparedScene& scene, Method method)
{
    const std::optional<int> spp = o.progressive ? progressiveSpp(o, scene) : o.spp ? o.spp : scene.settings.spp;
    const std::optional<float> mu = o.mu ? o.mu : scene.settings.mu;
    if (method == Method::MonteCarlo) {
        return render::monteCarlo(spp.value_or(defaultMonteCarloSpp));
    }
    if (!o.asPublished) {
        return render::axisAligned(spp, mu);
    }
    render::Settings s = render::asPublished(mu.value_or(publishedMu(o, scene)));
    // Whose own mu no light changes.
    s.indirect = render::asPublished(mu).indirect;
    s.distributed = render::asPublished(mu).distributed;
    return s;
}

void applyPaths(const RenderOptions& o, const render::PreparedScene& scene, render::Settings& s)
{
    refuse(o.ambientDistance.has_value(), "with integrator path",
        fmt::format("--ao-distance {}", o.ambientDistance.value_or(0)), "add --integrator ao");
    const scene::Settings& file = scene.settings;
    s.bounces = o.bounces ? *o.bounces : file.bounces.value_or(0);
    refuse(o.maxSurfaces && !scene.traits().mirrors, "without mirrors and glass",
        fmt::format("--max-surfaces {}", o.maxSurfaces.value_or(0)), "give the scene some");
    s.maxSurfaces = o.maxSurfaces.value_or(s.maxSurfaces);
    const render::DirectLights& lights = scene.directLights();
    refuse(o.lightSampling && s.bounces == 0 && s.method == Method::AxisAligned && lights.panelTriangles.empty()
            && !lights.share,
        "without bounces", "--light-sampling", "add --bounces 1");
    if (o.lightSampling) {
        s.lightSampling = *o.lightSampling;
    } else if (file.lightSampling) {
        const std::size_t index = choice("light_sampling", *file.lightSampling, lightSamplings);
        s.lightSampling = static_cast<render::LightSampling>(index);
    }
    if (o.environmentSampling) {
        const std::string option = "--environment-sampling";
        refuse(scene.picture() == nullptr, "without an environment", option, "add [environment] to the scene");
        refuse(s.lightSampling == render::LightSampling::Directions, "with reflected directions alone", option,
            "add --light-sampling both");
        s.environment.sampling = *o.environmentSampling;
    }
    applyShadows(o, scene, s);
}

void applyAmbientOcclusion(const RenderOptions& o, const scene::Settings& file, render::Settings& s)
{
    const std::string remedy = "add --integrator path";
    refuse(o.bounces.has_value(), "with integrator ao", fmt::format("--bounces {}", o.bounces.value_or(0)), remedy);
    refuse(o.maxSurfaces.has_value(), "with integrator ao", fmt::format("--max-surfaces {}", o.maxSurfaces.value_or(0)),
        remedy);
    refuse(o.lightSampling.has_value(), "with integrator ao", "--light-sampling", remedy);
    refuse(o.environmentSampling.has_value(), "with integrator ao", "--environment-sampling", remedy);
    refuse(o.falloff.has_value(), "with integrator ao", "--falloff", remedy);
    refuseShadows(o, "with integrator ao", remedy);
    s.indirect.ambientDistance = o.ambientDistance ? *o.ambientDistance : file.ambientDistance.value_or(0.0f);
}

/// The integrator and what goes with it alone. Options for the other one are mistakes; what the file has for the other
/// one is overridden.
void applyIntegrator(const RenderOptions& o, const render::PreparedScene& scene, render::Settings& s)
{
    const scene::Settings& file = scene.settings;
    s.integrator = o.integrator.value_or(file.integrator == "ao" ? Integrator::AmbientOcclusion : Integrator::Path);
    if (s.integrator == Integrator::AmbientOcclusion) {
        applyAmbientOcclusion(o, file, s);
    } else {
        applyPaths(o, scene, s);
    }
}

/// Where the counts of indirect light come from follows what was asked for all terms, and else is the preset's.
void applyIndirectCounts(const RenderOptions& o, render::Settings& s)
{
    if (s.sampling == Sampling::Uniform) {
        s.indirect.counts = render::IndirectCounts::Uniform;
    } else if (o.sampling || o.counts) {
        s.indirect.counts =
            s.counts == Counts::Spectrum ? render::IndirectCounts::Spectrum : render::IndirectCounts::Variance;
    }
}

void applyAblations(const RenderOptions& o, const render::PreparedScene& scene, bool distributed, render::Settings& s)
{
    refuse(o.environmentWidths && scene.picture() == nullptr, "without light from beyond the scene",
        "--environment-widths", "give the scene an [environment]");
    refuse(o.environmentWidths && s.integrator == Integrator::AmbientOcclusion, "with integrator ao",
        "--environment-widths", "add --integrator path");
    s.sampling = o.sampling.value_or(s.sampling);
    s.filtering = o.filter.value_or(s.filtering);
    s.fixedWidth = o.filterWidth.value_or(s.fixedWidth);
    s.shading = o.falloff.value_or(s.shading);
    s.counts = o.counts.value_or(s.counts);
    s.environment.widths = o.environmentWidths.value_or(s.environment.widths);
    applyIndirectCounts(o, s);
    if (o.filterWidth && s.filtering != Filtering::Fixed) {
        throw UsageError(
            "option has no effect", fmt::format("--filter-width {}", *o.filterWidth), "add --filter fixed");
    }
    refuse(o.environmentWidths && s.filtering == Filtering::Fixed, "with --filter fixed", "--environment-widths",
        "choose --filter adaptive");
    if (o.counts && s.sampling == Sampling::Uniform) {
        throw UsageError("option has no effect with uniform sampling", "--counts", "leave it out");
    }
    if (o.spp && !meanIsGiven(s)) {
        throw UsageError("option has no effect where counts follow from the spectrum", fmt::format("--spp {}", *o.spp),
            distributed ? "set --mu, or leave out --as-published"
                        : "set --mu, or add --counts variance or --sampling uniform");
    }
}

/// In frames through a lens or a shutter, antialiased and progressive ones, method aaf has but one way to sample.
void refuseUndistributed(const RenderOptions& o, const std::string& method)
{
    const std::pair<const char*, bool> given[] = { { "--falloff", o.falloff.has_value() },
        { "--sampling", o.sampling.has_value() }, { "--counts", o.counts.has_value() },
        { "--sampler", o.sampler.has_value() }, { "--environment-widths", o.environmentWidths.has_value() } };
    for (const auto& [name, isGiven] : given) {
        if (isGiven) {
            throw UsageError("option has no effect with method " + method
                    + (o.progressive ? std::string(" and --progressive") : fmt::format(" {}", distributedFrames)),
                name, "leave it out");
        }
    }
}

/// What a call asks for filters on has to be there; a scene file's filters wait for it.
void refuseIdleTargets(const RenderOptions& o, const render::Settings& s, const render::PreparedScene& scene)
{
    const std::vector<render::Term> terms = render::frameTerms(s, scene);
    std::vector<std::string> there { render::targets::image };
    if (render::countOf(render::Part::Direct, terms) > 0 || !render::frameUnfiltered(s, scene).empty()) {
        there.emplace_back(render::targets::direct);
    }
    if (render::countOf(render::Part::Indirect, terms) > 0) {
        there.emplace_back(render::targets::indirect);
    }
    for (const render::Term& term : terms) {
        if (!term.target.empty()) {
            there.push_back(term.target);
        }
    }
    for (const render::ChosenFilter& filter : o.filters) {
        for (const std::string& target : filter.on) {
            if (std::ranges::find(there, target) == there.end()) {
                throw UsageError("filter is on light that the frame has not",
                    fmt::format("--add-filter {}:{}={}", filter.name, render::filterTargets, target),
                    fmt::format("the frame has: {}", fmt::join(there, ", ")));
            }
        }
    }
}

/// Filters of samples are of indirect light: where a call asks for one there has to be some. A scene file's waits for
/// it.
void refuseIdleSampleFilter(const RenderOptions& o, const render::Settings& s)
{
    const bool indirect = s.integrator == Integrator::Path && s.bounces > 0;
    render::Settings called = s;
    called.filters = o.filters;
    if (!indirect && render::sampleFilterOf(called).filter != nullptr) {
        throw UsageError("filter of samples has no effect without indirect light",
            fmt::format("--add-filter {}", o.filters.front().name),
            s.integrator == Integrator::Path ? "add --bounces 1 or more" : "add --integrator path --bounces 1");
    }
}

/// What goes with --progressive alone, and what does not go with it.
void checkProgressive(const RenderOptions& o)
{
    if (!o.progressive) {
        refuse(o.targetError.has_value(), "without --progressive",
            fmt::format("--target-error {}", o.targetError.value_or(0)), "add --progressive");
        return;
    }
    const std::pair<const char*, bool> given[] = { { "--as-published", o.asPublished },
        { "--max-spp", o.maxSpp.has_value() }, { "--counts spectrum", o.counts == Counts::Spectrum },
        { "--sampler stratified", o.sampler == render::Sampler::Stratified } };
    for (const auto& [name, isGiven] : given) {
        if (isGiven) {
            throw UsageError("option does not go with --progressive, whose counts grow from step to step", name,
                "leave one of them out");
        }
    }
}

} // namespace

void applyLens(const RenderOptions& o, scene::Scene& scene)
{
    const auto apply = [&](scene::Camera& camera) {
        camera.apertureRadius = o.aperture.value_or(camera.apertureRadius);
        camera.focusDistance = o.focus.value_or(camera.focusDistance);
    };
    apply(scene.camera);
    if (scene.cameraAtClose) {
        apply(*scene.cameraAtClose);
    }
    refuse(o.focus && scene.camera.apertureRadius == 0, "with a pinhole",
        fmt::format("--focus {}", o.focus.value_or(0)), "add --aperture");
}

render::Settings resolveSettings(const RenderOptions& o, const render::PreparedScene& scene)
{
    const scene::Settings& file = scene.settings;
    const std::string name = resolveMethod(o, scene);
    const Method method = name == "mc" ? Method::MonteCarlo : Method::AxisAligned;
    if (method == Method::MonteCarlo) {
        refuseFilterOptions(o);
    }
    checkProgressive(o);
    render::Settings s = preset(o, scene, method);
    applyMaaf(o, name, s);
    s.width = o.size ? o.size->first : file.width;
    s.height = o.size ? o.size->second : file.height;
    s.crop = o.crop.value_or(s.crop);
    s.seed = o.seed.value_or(file.seed);
    s.sampler = o.sampler.value_or(s.sampler);
    s.progressive = o.progressive;
    s.temporal = o.temporal.value_or(render::Temporal::Off);
    if (const auto wrong = render::wrongOrder(o.filters, "--add-filter")) {
        throw UsageError(wrong->what, wrong->value, wrong->remedy);
    }
    s.filters =
        render::inStages(o.noFilters ? std::vector<render::ChosenFilter>() : filters::filtersOf(scene), o.filters);
    applyIntegrator(o, scene, s);
    s.antialias = o.antialias.value_or(file.antialias);
    refuse(o.pixelFilter && !s.antialias, "without antialiasing", "--pixel-filter", "add --antialias");
    if (o.pixelFilter) {
        s.pixelFilter = *o.pixelFilter;
    } else if (file.pixelFilter) {
        s.pixelFilter = static_cast<render::PixelFilter>(choice("pixel_filter", *file.pixelFilter, pixelFilters));
    }
    s.styles = !o.noStyle;
    const bool distributed = render::isDistributed(s, scene);
    render::requireStylable(s, scene);
    refuseIdleMaaf(o, scene, distributed, s);
    if (method == Method::AxisAligned) {
        if (distributed) {
            refuseUndistributed(o, name);
        }
        applyAblations(o, scene, distributed, s);
        applyCounts(o, scene, distributed, s);
    }
    refuseIdleSampleFilter(o, s);
    refuseIdleTargets(o, s, scene);
    render::validate(s, distributed);
    return s;
}

} // namespace wedge::app
