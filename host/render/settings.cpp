#include "host/render/settings.h"

#include "host/error.h"
#include "host/render/filter_chain.h"
#include "kernels/shared/camera.h"
#include "kernels/shared/frame.h"
#include "kernels/shared/indirect.h"
#include "kernels/shared/rng.h"
#include "kernels/shared/wedge.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace wedge::render {
namespace {

// Where the default setting was tuned, and how width and count go together from there.
constexpr float referenceSpp = 28.0f;
constexpr float referenceMu = 1.5f;
// Bias of a kernel of width beta grows as beta^2; its noise falls with beta and, faster than plain Monte Carlo's, with
// the count: widths that keep both in step go as a power of the count. Measured from 9 to 448 samples on two scenes,
// with about five samples of the first pass, which it spends where nothing is in shadow, left out.
constexpr float widthExponent = 1.0f / 3.0f;
constexpr float evenSamples = 5.0f;
// The same for indirect light.
constexpr float referenceIndirectMu = 1.0f;
constexpr float publishedMu = 2.0f, publishedIndirectMu = 0.9f, publishedDistributedMu = 1.0f;
constexpr int largestSpp = 1 << 20;
constexpr int leastProgressiveSpp = 16; // two halves' first paths

/// How much larger mu is with `to` samples a pixel than with `from`.
float widthRatio(float from, float to)
{
    return std::pow(std::max(1.0f, to - evenSamples) / std::max(1.0f, from - evenSamples), widthExponent);
}

/// The same of indirect light. Its noise falls no faster than plain Monte Carlo's, and is most of the error: beyond the
/// reference's samples mu goes as (n - 5)^(1/16), so that what is gathered hardly shrinks.
float indirectWidthRatio(float from, float to)
{
    const auto fromReference = [](float spp) {
        const float ratio = widthRatio(referenceSpp, spp);
        return ratio > 1.0f ? std::pow(ratio, 3.0f / 16.0f) : ratio;
    };
    return fromReference(to) / fromReference(from);
}

/// What the error that taking apart may make (5.30) is multiplied by at a count: it goes with the noise, or no number
/// of samples would bring it down.
float factoringRatio(int spp) { return std::min(1.0f, std::sqrt(referenceSpp / static_cast<float>(std::max(spp, 1)))); }

/// Samples of the first pass of distributed frames: beyond 64 an eighth, less than what every pixel takes anyway. What
/// is found of them says where texture and irradiance can be taken apart, and the more samples the less error that may
/// make.
int firstPathsAt(int spp) { return std::clamp(spp / 8, DistributedSettings().firstPaths, mostDistributedSpp); }

void requireRange(bool inRange, const std::string& what, const std::string& value, const std::string& range)
{
    if (!inRange) {
        throw UsageError(what + " is out of range", value, "give " + range);
    }
}

void validateDistributed(const DistributedSettings& d)
{
    const auto atLeast = [](float value, float least) { return std::isfinite(value) && value >= least; };
    const auto counts = [](int value, int least) { return value >= least && value <= mostDistributedSpp; };
    requireRange(counts(d.firstPaths, 2), "samples of the first pass", fmt::format("{}", d.firstPaths),
        fmt::format("a whole number from 2 to {}", mostDistributedSpp));
    requireRange(d.maxSpp >= d.firstPaths && d.maxSpp <= mostPixelSpp, "most samples of a pixel",
        fmt::format("{}", d.maxSpp), fmt::format("{} (those of the first pass) to {}", d.firstPaths, mostPixelSpp));
    requireRange(counts(d.mixedPaths, 1), "samples where motions differ", fmt::format("{}", d.mixedPaths),
        fmt::format("a whole number from 1 to {}", mostDistributedSpp));
    requireRange(std::isfinite(d.mu) && d.mu >= 0.01f && d.mu <= 1000.0f, "mu", fmt::format("{}", d.mu),
        "a number from 0.01 to 1000");
    requireRange(atLeast(d.factoringError, 0) && d.factoringRadius >= 0 && d.factoringRadius <= WEDGE_MAX_RADIUS,
        "factoring", fmt::format("error {} radius {}", d.factoringError, d.factoringRadius),
        fmt::format("an error of at least 0, a radius from 0 to {} pixels", WEDGE_MAX_RADIUS));
    requireRange(atLeast(d.blurWidth, 0) && atLeast(d.shutterWidth, 0) && atLeast(d.irradianceWidth, 0),
        "filter widths", fmt::format("{} {} {}", d.blurWidth, d.shutterWidth, d.irradianceWidth),
        "numbers of at least 0");
    requireRange(atLeast(d.blurExponent, 0) && atLeast(d.shutterExponent, 0) && atLeast(d.countExponent, 0),
        "exponents", fmt::format("{} {} {}", d.blurExponent, d.shutterExponent, d.countExponent),
        "numbers of at least 0");
    requireRange(atLeast(d.leastRadius, 1e-3f), "least radius of a blur", fmt::format("{}", d.leastRadius),
        "pixels, 0.001 or more");
    requireRange(atLeast(d.varianceSpread, 0) && d.varianceSpread <= 1, "spread of variances",
        fmt::format("{}", d.varianceSpread), "a number from 0 to 1");
    requireRange(
        atLeast(d.oneVelocity, 0), "difference of motions", fmt::format("{}", d.oneVelocity), "a number of at least 0");
}

/// Of method aaf.
void validateCounts(const Settings& s, bool distributed)
{
    const int least = leastSpp(s, distributed);
    requireRange(s.spp >= least && s.maxSpp >= least && (!tracesPaths(s) || s.indirect.maxSpp >= least),
        "samples a pixel", fmt::format("{} (at most {})", s.spp, tracesPaths(s) ? s.indirect.maxSpp : s.maxSpp),
        fmt::format("{} or more{}: the first pass takes {}", least,
            tracesPaths(s) && !distributed ? " with indirect light" : "", least));
    requireRange(!distributed || s.progressive || s.spp <= mostDistributedSpp, "samples a pixel",
        fmt::format("{}", s.spp),
        fmt::format("{} or less through a lens or shutter, or with antialiasing", mostDistributedSpp));
}

/// Of lights that stand for a map.
void validateShadows(const Settings& s, bool distributed)
{
    const ShadowSettings& shadows = s.environment.shadows;
    requireRange(shadows.lights >= 1 && shadows.lights <= mostShadowLights, "lights for the environment's shadows",
        fmt::format("{}", shadows.lights), fmt::format("a whole number from 1 to {}", mostShadowLights));
    requireRange(shadows.chosen >= 0 && shadows.chosen <= std::min(shadows.lights, mostChosenLights),
        "lights that a pixel traces rays to", fmt::format("{}", shadows.chosen),
        fmt::format("a whole number up to {}, and not more than lights", mostChosenLights));
    const int side = shadows.blockSide;
    requireRange(side == 1 || side == 2 || side == 4 || side == 32, "pixels along a side of those of which one traces",
        fmt::format("{}", side), "1, 2, 4 or 32");
    if (shadows.shadows != Shadows::Sampled && s.width * s.height < side * side) {
        throw UsageError("scale of shadows leaves less than a pixel of the image",
            fmt::format("--shadow-scale {}, {}x{}", shadowScaleText(shadows), s.width, s.height),
            "take a larger share or a larger image");
    }
    if (shadows.shadows != Shadows::Sampled && distributed) {
        throw UsageError("shadows of lights are of frames through a pinhole where nothing moves, neither antialiased "
                         "nor progressive",
            "--shadows " + shadowsName(shadows.shadows),
            "leave it out, or leave out --antialias, --progressive, the lens and what moves");
    }
}

/// Names of the filters of samples that frames of several receivers a pixel can have: "a, b or c".
std::string filtersOfBins()
{
    std::vector<std::string> names;
    for (const std::unique_ptr<const Filter>& filter : registeredFilters()) {
        if (filter->stage() == Stage::Samples && static_cast<const SampleFilter&>(*filter).kernelOfBins()) {
            names.push_back(filter->name());
        }
    }
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
    }
    return text;
}

/// Of filters of samples.
void validateSampleFilter(const Settings& s, bool distributed)
{
    const auto [filter, values] = sampleFilterOf(s);
    if (filter == nullptr) {
        return;
    }
    if (distributed && !filter->kernelOfBins()) {
        throw UsageError("this filter of samples is of frames through a pinhole where nothing moves, neither "
                         "antialiased nor progressive",
            filter->name(), fmt::format("choose {}, or leave it out, a scene's with --no-filters", filtersOfBins()));
    }
    if (distributed && filter->comparesRgb(values)) {
        throw UsageError("colours are compared as RGB in frames through a pinhole where nothing moves, neither "
                         "antialiased nor progressive: all others know samples by their L*",
            filter->name(), "leave out rgb=1, a scene's filters with --no-filters");
    }
    if (distributed && s.method == Method::AxisAligned && s.distributed.published) {
        throw UsageError("filters of samples do not go with published frames through a lens or shutter, or antialiased",
            filter->name(), "leave it out, a scene's with --no-filters");
    }
    if (s.method == Method::AxisAligned && s.sampling == Sampling::Adaptive
        && s.indirect.counts == IndirectCounts::Spectrum) {
        throw UsageError("filters of samples do not go with counts from the spectrum, which know no samples",
            filter->name(), "add --counts variance or --sampling uniform, or leave it out");
    }
}

} // namespace

Settings monteCarlo(int spp)
{
    Settings s;
    s.method = Method::MonteCarlo;
    s.shading = Shading::Inside;
    s.sampling = Sampling::Uniform;
    s.filtering = Filtering::None;
    s.spp = spp;
    s.maxSpp = std::max(spp, s.maxSpp);
    s.indirect.maxSpp = s.maxSpp;
    return s;
}

Settings axisAligned(std::optional<int> spp, std::optional<float> mu)
{
    Settings s;
    if (spp) {
        s.spp = *spp;
        const auto count = static_cast<float>(*spp);
        s.mu = mu.value_or(referenceMu * widthRatio(referenceSpp, count));
        s.indirect.mu = mu.value_or(referenceIndirectMu * indirectWidthRatio(referenceSpp, count));
    } else if (mu) {
        s.mu = *mu;
        s.indirect.mu = *mu;
        const float count = referenceSpp * (*mu / referenceMu) * (*mu / referenceMu);
        s.spp = static_cast<int>(std::lround(std::clamp(count, static_cast<float>(WEDGE_FIRST_PASS_RAYS), 1e5f)));
    }
    // A pixel may take ten times the mean, but no more than validate() accepts.
    s.maxSpp = std::max(s.maxSpp, std::min(10 * std::min(s.spp, largestSpp), largestSpp));
    s.indirect.maxSpp = s.maxSpp;
    s.distributed.factoringError *= factoringRatio(s.spp);
    s.distributed.firstPaths = firstPathsAt(s.spp);
    // A bound that stood still would end what edges of lights gain from more samples.
    s.distributed.maxSpp =
        std::clamp(s.distributed.maxSpp * std::min(s.spp, mostDistributedSpp) / static_cast<int>(referenceSpp),
            s.distributed.maxSpp, mostPixelSpp);
    return s;
}

Settings multipleAxisAligned(Maaf maaf, std::optional<int> spp, std::optional<float> mu)
{
    Settings s = axisAligned(spp, mu);
    s.maaf = maaf;
    return s;
}

Settings asPublished(std::optional<float> mu)
{
    const float direct = mu.value_or(publishedMu);
    Settings s;
    s.published = true;
    s.sampler = Sampler::Stratified;
    s.shading = Shading::Separate;
    s.counts = Counts::Spectrum;
    s.slopes = Slopes::Published;
    s.oblique = false;
    s.narrower = false;
    s.surface = false;
    s.sheared = false;
    s.fitted = false;
    s.fallback = false;
    s.widening = 0.0f;
    s.mu = direct;
    s.fillRadius = 5;
    s.fillSigma = 0.0f;
    // The thesis caps nothing explicitly; 100 suits its mu of 2, and counts grow with the square of mu.
    s.maxSpp = static_cast<int>(std::lround(std::clamp(100.0f * std::max(1.0f, direct * direct / 4.0f), 100.0f, 1e5f)));
    IndirectSettings& in = s.indirect;
    in.mu = mu.value_or(publishedIndirectMu);
    in.alpha = 0.3f;
    in.widthScale = 2.0f;
    in.extent = ReflectorExtent::Scene;
    in.leastReflector = 0.02f;
    in.meanFraction = 0.0f;
    in.counts = IndirectCounts::Spectrum;
    in.maxSpp = static_cast<int>(std::lround(std::clamp(100.0f * in.mu, 100.0f, 1e5f)));
    s.environment = { .sampling = EnvironmentSampling::Precomputed,
        .relative = false,
        .normalDegrees = s.normalDegrees,
        .widthScale = in.widthScale,
        .lobeWidening = 0.0f,
        .firstShare = 1.0f,
        .leastShare = 0.5f,
        .widths = EnvironmentWidths::Curvature,
        .shadows = {} };
    DistributedSettings& d = s.distributed;
    d.published = true;
    d.firstPaths = 16;
    d.mu = mu.value_or(publishedDistributedMu);
    d.blurWidth = d.shutterWidth = 0.177f / d.mu; // exp(-16 d^2 / r^2) of (5.33), whose bandwidth (5.29) scales
    d.blurExponent = 0.0f;
    d.shutterExponent = 0.0f;
    return s;
}

int leastSpp(const Settings& s, bool distributed)
{
    if (distributed) {
        return s.progressive ? leastProgressiveSpp : s.distributed.firstPaths;
    }
    return static_cast<int>(tracesPaths(s) ? WEDGE_INDIRECT_FIRST_RAYS : WEDGE_FIRST_PASS_RAYS);
}

void validate(const Settings& s, bool distributed)
{
    const auto text = [](auto value) { return fmt::format("{}", value); };
    requireRange(s.width >= 1 && s.height >= 1 && s.width <= 32768 && s.height <= 32768, "image size",
        fmt::format("{}x{}", s.width, s.height), "a width and a height from 1 to 32768");
    requireRange(s.crop.width() >= 0 && s.crop.height() >= 0 && s.crop.x0 >= 0 && s.crop.y0 >= 0 && s.crop.x1 <= s.width
            && s.crop.y1 <= s.height,
        "crop", fmt::format("{},{},{},{}", s.crop.x0, s.crop.y0, s.crop.x1, s.crop.y1),
        fmt::format("x0,y0,x1,y1 with x0 < x1 and y0 < y1 inside {}x{}", s.width, s.height));
    requireRange(s.spp >= 1 && s.spp <= largestSpp, "samples a pixel", text(s.spp), "a whole number from 1 to 1048576");
    requireRange(s.maxSpp >= 1 && s.maxSpp <= largestSpp, "largest sample count", text(s.maxSpp),
        "a whole number from 1 to 1048576");
    requireRange(
        std::isfinite(s.mu) && s.mu >= 0.01f && s.mu <= 1000.0f, "mu", text(s.mu), "a number from 0.01 to 1000");
    requireRange(s.k > 0 && s.alpha > 0 && s.cut > 0, "filter constants",
        fmt::format("k {} alpha {} cut {}", s.k, s.alpha, s.cut), "positive numbers");
    requireRange(
        s.normalDegrees >= 0 && s.normalDegrees <= 180, "normal test", text(s.normalDegrees), "degrees from 0 to 180");
    requireRange(s.maxRadius >= 1 && s.maxRadius <= WEDGE_MAX_RADIUS, "kernel radius", text(s.maxRadius),
        fmt::format("pixels from 1 to {}", WEDGE_MAX_RADIUS));
    requireRange(s.fillRadius >= 0 && s.fillRadius <= static_cast<int>(WEDGE_ROW_PADDING), "slope spreading radius",
        text(s.fillRadius), fmt::format("pixels from 0 to {}", WEDGE_ROW_PADDING));
    requireRange(s.filtering != Filtering::Fixed || s.fixedWidth > 0, "fixed filter width", text(s.fixedWidth),
        "pixels above 0");
    requireRange(s.bounces >= 0 && s.bounces <= mostBounces, "bounces", text(s.bounces),
        fmt::format("a whole number from 0 to {}", mostBounces));
    requireRange(s.maxSurfaces >= 1 && s.maxSurfaces <= mostSurfaces, "most mirrors and glass in a row",
        text(s.maxSurfaces), fmt::format("a whole number from 1 to {}", mostSurfaces));
    requireRange(
        s.integrator == Integrator::Path || s.bounces == 0, "bounces", text(s.bounces), "none with ambient occlusion");
    requireRange(s.styleMargin >= 0 && s.styleMargin <= 1, "margin of styles", text(s.styleMargin),
        "a part of the image's longer side, 0 to 1");
    const IndirectSettings& in = s.indirect;
    requireRange(
        std::isfinite(in.mu) && in.mu >= 0.01f && in.mu <= 1000.0f, "mu", text(in.mu), "a number from 0.01 to 1000");
    requireRange(in.alpha >= 0 && in.meanFraction >= 0 && in.widthScale > 0 && in.leastReflector > 0,
        "indirect filter constants",
        fmt::format("alpha {} width scale {} least reflector {}", in.alpha, in.widthScale, in.leastReflector),
        "positive numbers");
    requireRange(std::isfinite(in.ambientDistance) && in.ambientDistance >= 0, "ambient occlusion distance",
        text(in.ambientDistance), "metres above 0");
    validateDistributed(s.distributed);
    validateSampleFilter(s, distributed);
    validateShadows(s, distributed);
    requireRange(
        !s.progressive || !s.published, "progressive render", "as published", "counts that are not the published ones");
    requireRange(!s.progressive || s.method == Method::MonteCarlo || s.spp >= leastProgressiveSpp,
        "samples a pixel of a progressive render", text(s.spp), fmt::format("{} or more", leastProgressiveSpp));
    requireRange(s.components == 1 || s.components == 3 || s.components == 5 || s.components == 7,
        "components of filters", text(s.components), "3, 5 or 7");
    if (s.method == Method::AxisAligned) {
        validateCounts(s, distributed);
        requireRange(s.shading != Shading::Inside || s.counts != Counts::Variance || s.sampling == Sampling::Uniform,
            "adaptive counts", "from variance, with the cosine inside the filtered term",
            "counts from the spectrum, or uniform ones");
    }
}

Settings halfAt(const Settings& settings, int spp)
{
    Settings s = settings;
    const auto from = static_cast<float>(settings.spp), to = static_cast<float>(spp);
    s.spp = std::max(1, spp / 2);
    s.mu *= widthRatio(from, to);
    s.indirect.mu *= indirectWidthRatio(from, to);
    s.distributed.frames = 2;
    s.distributed.factoringError *= factoringRatio(spp) / factoringRatio(settings.spp);
    s.distributed.firstPaths = firstPathsAt(0); // each step looks at all samples anew
    s.distributed.leastShare = 0.25f;
    s.distributed.leastPrimaries = 0.5f;
    s.distributed.maxSpp = std::max(s.distributed.maxSpp, std::min(10 * std::min(s.spp, largestSpp), largestSpp));
    return s;
}

std::uint32_t pixelFilterOf(const Settings& s)
{
    return s.antialias ? WEDGE_PIXEL_BOX + static_cast<std::uint32_t>(s.pixelFilter) : WEDGE_PIXEL_CENTRE;
}

std::uint32_t frameSeed(const Settings& settings)
{
    const std::uint32_t frame = settings.sameNumbers ? 0 : settings.frame.value_or(0);
    return frame == 0 ? settings.seed : shared::hashCombine(settings.seed, frame);
}

image::Window outputWindow(const Settings& s)
{
    const bool whole = s.crop.width() == 0 || s.crop.height() == 0;
    return whole ? image::Window { 0, 0, s.width, s.height } : s.crop;
}

bool tracesPaths(const Settings& s) { return s.bounces > 0 || s.integrator == Integrator::AmbientOcclusion; }

bool usesFallback(const Settings& s)
{
    return s.fallback && s.method == Method::AxisAligned && s.filtering == Filtering::Adaptive;
}

} // namespace wedge::render
