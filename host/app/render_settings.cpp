#include "host/app/render_settings.h"

#include "host/error.h"

#include <algorithm>

#include <fmt/format.h>

namespace wedge::app {
namespace {

using render::Counts;
using render::Filtering;
using render::Method;
using render::Sampling;

constexpr int defaultMonteCarloSpp = 64;

Method resolveMethod(const RenderOptions& options, const scene::Scene& scene)
{
    if (options.method) {
        return *options.method;
    }
    if (options.asPublished || !scene.settings.method) {
        return Method::AxisAligned;
    }
    const std::string& name = *scene.settings.method;
    for (const Method method : { Method::MonteCarlo, Method::AxisAligned }) {
        if (name == render::methodName(method)) {
            return method;
        }
    }
    throw Error("scene file " + scene.path + ": method is not available", name, "choose one with --method mc|aaf");
}

/// Options that plain Monte Carlo has no use for are mistakes, not wishes to ignore.
void refuseFilterOptions(const RenderOptions& o)
{
    const std::pair<const char*, bool> given[] = { { "--as-published", o.asPublished }, { "--mu", o.mu.has_value() },
        { "--max-spp", o.maxSpp.has_value() }, { "--sampling", o.sampling.has_value() },
        { "--filter", o.filter.has_value() }, { "--filter-width", o.filterWidth.has_value() },
        { "--falloff", o.falloff.has_value() }, { "--counts", o.counts.has_value() } };
    for (const auto& [name, isGiven] : given) {
        if (isGiven) {
            throw UsageError("option has no effect with method mc", name, "leave it out, or choose --method aaf");
        }
    }
}

render::Settings preset(const RenderOptions& o, const scene::Settings& file, Method method)
{
    const std::optional<int> spp = o.spp ? o.spp : file.spp;
    const std::optional<float> mu = o.mu ? o.mu : file.mu;
    if (method == Method::MonteCarlo) {
        return render::monteCarlo(spp.value_or(defaultMonteCarloSpp));
    }
    if (!o.asPublished) {
        return render::axisAligned(spp, mu);
    }
    render::Settings settings = mu ? render::asPublished(*mu) : render::asPublished();
    settings.spp = spp.value_or(settings.spp);
    return settings;
}

void applyAblations(const RenderOptions& o, render::Settings& s)
{
    s.sampling = o.sampling.value_or(s.sampling);
    s.filtering = o.filter.value_or(s.filtering);
    s.fixedWidth = o.filterWidth.value_or(s.fixedWidth);
    s.shading = o.falloff.value_or(s.shading);
    s.counts = o.counts.value_or(s.counts);
    if (o.filterWidth && s.filtering != Filtering::Fixed) {
        throw UsageError(
            "option has no effect", fmt::format("--filter-width {}", *o.filterWidth), "add --filter fixed");
    }
    if (o.counts && s.sampling == Sampling::Uniform) {
        throw UsageError("option has no effect with uniform sampling", "--counts", "leave it out");
    }
    if (o.spp && s.sampling == Sampling::Adaptive && s.counts == Counts::Spectrum) {
        throw UsageError("option has no effect where counts follow from the spectrum", fmt::format("--spp {}", *o.spp),
            "set --mu, or add --counts variance or --sampling uniform");
    }
}

} // namespace

render::Settings resolveSettings(const RenderOptions& o, const scene::Scene& scene)
{
    const scene::Settings& file = scene.settings;
    const Method method = resolveMethod(o, scene);
    if (method == Method::MonteCarlo) {
        refuseFilterOptions(o);
    }
    render::Settings s = preset(o, file, method);
    s.width = o.size ? o.size->first : file.width;
    s.height = o.size ? o.size->second : file.height;
    s.crop = o.crop.value_or(s.crop);
    s.seed = o.seed.value_or(file.seed);
    s.sampler = o.sampler.value_or(s.sampler);
    if (method == Method::AxisAligned) {
        const std::optional<int> most = o.maxSpp ? o.maxSpp : file.maxSpp;
        s.maxSpp = most.value_or(s.maxSpp);
        applyAblations(o, s);
    }
    render::validate(s);
    return s;
}

} // namespace wedge::app
