#include "host/app/render_counts.h"

#include "host/error.h"

#include <algorithm>

#include <fmt/format.h>

namespace wedge::app {
namespace {

// Of progressive renders, without and with something else that ends them.
constexpr int defaultProgressiveSpp = 1024, openProgressiveSpp = 1 << 16;

/// A count that suits no method with a filter, whose first pass alone takes more. isOption: it is that option's value,
/// else the scene file's.
void requireFirstPass(bool isOption, const std::string& option, const std::string& key, const std::optional<int>& count,
    const scene::Scene& scene, const render::Settings& s, int least)
{
    if (!count || *count >= least) {
        return;
    }
    if (isOption) {
        throw UsageError("samples a pixel are too few for method " + render::methodName(s),
            fmt::format("{} {}", option, *count), fmt::format("give {} or more, or add --method mc", least));
    }
    throw Error(fmt::format("scene file {}: {} is too low for method {}", scene.path, key, render::methodName(s)),
        fmt::format("{}", *count), fmt::format("give {} or more, or method mc", least));
}

/// A value, of an option or of the scene file, that asks for more samples of a pixel than a distributed frame can take.
void refuseTooMany(bool isOption, const std::string& option, const std::string& key, const std::string& value,
    const scene::Scene& scene, const render::Settings& s, const std::string& remedy)
{
    if (isOption) {
        throw UsageError(
            fmt::format("samples a pixel are too many for method {} {}", render::methodName(s), distributedFrames),
            option + " " + value, remedy);
    }
    throw Error(fmt::format("scene file {}: {} is too high for method {} {}", scene.path, key, render::methodName(s),
                    distributedFrames),
        value, remedy);
}

/// The mean of distributed frames that are not progressive; the steps of those are no larger than that either way.
void requireDistributedMean(const RenderOptions& o, const scene::Scene& scene, const render::Settings& s)
{
    if (s.spp <= render::mostDistributedSpp) {
        return;
    }
    if (o.spp || scene.settings.spp) {
        refuseTooMany(o.spp.has_value(), "--spp", "spp", fmt::format("{}", s.spp), scene, s,
            fmt::format("give {} or less, or add --progressive or --method mc", render::mostDistributedSpp));
    }
    // What a mu alone asks for.
    refuseTooMany(o.mu.has_value(), "--mu", "mu", fmt::format("{}", o.mu ? *o.mu : scene.settings.mu.value_or(0)),
        scene, s, fmt::format("lower it, or give --spp, {} or less", render::mostDistributedSpp));
}

/// The most samples of a pixel of a distributed frame: as given, else the default's or twice the mean.
void applyDistributedMost(const RenderOptions& o, const scene::Scene& scene, const std::optional<int>& given,
    bool distributed, render::Settings& s)
{
    if (distributed && given && *given > render::mostPixelSpp) {
        refuseTooMany(o.maxSpp.has_value(), "--max-spp", "max_spp", fmt::format("{}", *given), scene, s,
            fmt::format("{} {} or less", o.maxSpp ? "give" : "give there, or as --max-spp,", render::mostPixelSpp));
    }
    render::DistributedSettings& d = s.distributed;
    d.maxSpp = std::clamp(given.value_or(std::max(d.maxSpp, 2 * s.spp)), d.firstPaths, render::mostPixelSpp);
}

void requireMeanBelowMost(const RenderOptions& o, const std::optional<int>& mean, const std::optional<int>& most)
{
    if (mean && most && *most < *mean) {
        throw UsageError("most samples of a pixel are below their mean",
            fmt::format("{} {} and {} {}", o.maxSpp ? "--max-spp" : "the scene file's max_spp", *most,
                o.spp ? "--spp" : "the scene file's spp", *mean),
            "raise --max-spp or lower --spp");
    }
}

} // namespace

int progressiveSpp(const RenderOptions& o, const scene::Scene& scene)
{
    const bool endsOtherwise = o.timeLimitSeconds > 0 || o.targetError;
    return o.spp ? *o.spp : endsOtherwise ? openProgressiveSpp : scene.settings.spp.value_or(defaultProgressiveSpp);
}

bool meanIsGiven(const render::Settings& s)
{
    return s.sampling == render::Sampling::Uniform || s.counts == render::Counts::Variance;
}

void applyCounts(const RenderOptions& o, const scene::Scene& scene, bool distributed, render::Settings& s)
{
    const scene::Settings& file = scene.settings;
    const int least = render::leastSpp(s, distributed);
    const bool oneImage = !o.progressive;
    // Counts of progressive renders grow from step to step without a bound of their own.
    const std::optional<int> most = o.maxSpp ? o.maxSpp : oneImage ? file.maxSpp : std::nullopt;
    requireFirstPass(o.maxSpp.has_value(), "--max-spp", "max_spp", most, scene, s, least);
    s.maxSpp = most.value_or(s.maxSpp);
    s.indirect.maxSpp = most.value_or(s.indirect.maxSpp);
    if (!meanIsGiven(s)) {
        s.spp = render::Settings().spp; // not used
        applyDistributedMost(o, scene, most, distributed && oneImage, s);
        return;
    }
    const std::optional<int> mean = o.spp ? o.spp : oneImage ? file.spp : progressiveSpp(o, scene);
    if (o.spp || mean == file.spp) {
        requireFirstPass(o.spp.has_value(), "--spp", "spp", mean, scene, s, least);
    }
    // mu alone may ask for fewer samples than the first pass takes.
    s.spp = mean.value_or(std::max(s.spp, least));
    if (distributed && oneImage) {
        requireDistributedMean(o, scene, s);
    }
    applyDistributedMost(o, scene, most, distributed && oneImage, s);
    requireMeanBelowMost(o, mean, most);
}

} // namespace wedge::app
