#include "host/render/effects/soft_shadows.h"

#include "host/render/filters/gaussian.h"
#include "host/render/sample_counts.h"
#include "kernels/shared/light.h"
#include "kernels/shared/wedge.h"

#include <algorithm>
#include <cmath>

namespace wedge::render {

using device::PassKind;

namespace {

// Samples of a pixel between two looks at the cancel flag; also what one launch over one tile may cost.
constexpr std::uint32_t monteCarloSlice = 64;
constexpr std::uint32_t secondPassSlice = 256;

float gaussianScale(float sigma)
{
    constexpr float log2e = 1.44269504f;
    return sigma > 0 ? -0.5f * log2e / (sigma * sigma) : 0.0f;
}

} // namespace

TermShape SoftShadows::termShape(bool specular, bool analysed)
{
    const std::uint32_t channels = specular ? 2 : 1;
    return { 2 * channels, channels, 2, analysed };
}

SoftShadows::SoftShadows(Passes& passes, const DeviceScene& scene, Frame& frame, Term& term, const Settings& settings,
    const shared::FrameParams& fullFrame, const shared::FrameParams& sampledFrame, const image::Window& window)
    : passes_(passes)
    , scene_(scene)
    , frame_(frame)
    , term_(term)
    , settings_(settings)
    , fullFrame_(fullFrame)
    , sampledFrame_(sampledFrame)
    , full_ { 0, 0, static_cast<int>(frame.layout.width), static_cast<int>(frame.layout.height) }
    , window_(window)
{
}

bool SoftShadows::render(std::uint32_t index)
{
    index_ = index;
    analysed_ = false;
    term_.clear(passes_.queue());
    const bool complete = sample();
    if (analysed_ && settings_.filtering != Filtering::None) {
        gaussianFilter(passes_, { "filter", PassKind::Filter, "filter.cl" },
            filterParams(settings_, fullFrame_, light(), window_), window_, frame_, term_.value, term_, term_.filtered);
        shade(term_.filtered);
    } else {
        shade(term_.value);
    }
    return complete;
}

bool SoftShadows::sample()
{
    if (settings_.method == Method::MonteCarlo) {
        uniformCounts();
        return secondPass(0);
    }
    if (!firstPass()) {
        return false;
    }
    widthsAndCounts();
    analysed_ = true;
    return secondPass(WEDGE_FIRST_PASS_RAYS);
}

shared::SampleParams SoftShadows::sampleParams() const
{
    return { static_cast<std::uint32_t>(settings_.shading), static_cast<std::uint32_t>(settings_.sampler), index_,
        settings_.method == Method::AxisAligned ? WEDGE_FIRST_PASS_RAYS : 0, lightSampling(), {} };
}

std::uint32_t SoftShadows::lightSampling() const
{
    // A filtered term is visibility of points on the light, and so is a ratio: directions have no part in them.
    const bool plain = settings_.method == Method::MonteCarlo && settings_.shading == Shading::Inside;
    return plain ? static_cast<std::uint32_t>(settings_.lightSampling) : WEDGE_LIGHTS_SAMPLED;
}

bool SoftShadows::firstPass()
{
    try {
        // All of the frame even for a crop: the counts' scale comes from all pixels, and a crop is to be the same
        // pixels as the whole image.
        passes_.tiles("first pass", PassKind::Trace, "area_light.cl", "firstPass", fullFrame_,
            WEDGE_FIRST_PASS_RAYS, sampleParams(), light(), scene_.nodes, scene_.blocks, frame_.position, frame_.normal,
            frame_.origin, frame_.objectId, frame_.gloss, term_.sums, term_.taken, term_.value, term_.extremes, frame_.rays);
    } catch (const device::Cancelled&) {
        return false;
    }
    return true;
}

bool SoftShadows::secondPass(std::uint32_t from)
{
    const bool plain = settings_.method == Method::MonteCarlo;
    const std::uint32_t slice = plain ? monteCarloSlice : secondPassSlice;
    const std::uint32_t most = static_cast<std::uint32_t>(
        settings_.sampling == Sampling::Uniform ? settings_.spp : std::max(settings_.maxSpp, settings_.spp));
    const double units = std::max(1.0, static_cast<double>(settings_.spp) - from);
    try {
        for (std::uint32_t last = from; last < most;) {
            // Most pixels are done at twice the mean; the slices up to the cap count for what little is left.
            const double knee = std::min<double>(most, std::max(2.0 * settings_.spp, from + 1.0));
            const auto done = [&](double n) {
                return 0.9 * std::min(n - from, knee - from) / (knee - from) + 0.1 * (n - from) / (most - from);
            };
            const double share = done(std::min(last + slice, most)) - done(last);
            last += std::min(slice, most - last);
            passes_.tiles(plain ? "shadow rays" : "second pass", PassKind::Trace, "area_light.cl", "secondPass",
                sampledFrame_, units * share, sampleParams(), light(), scene_.nodes, scene_.blocks, frame_.position,
                frame_.normal, frame_.origin, frame_.objectId, frame_.gloss, term_.wanted, last, term_.sums,
                term_.taken, term_.value, frame_.rays);
            if (passes_.rehearsal()) {
                break;
            }
        }
    } catch (const device::Cancelled&) {
        return false;
    }
    return true;
}

shared::AnalysisParams SoftShadows::analysisParams(const image::Window& window) const
{
    shared::AnalysisParams p {};
    setRectangle(p, window);
    p.width = fullFrame_.width;
    p.height = fullFrame_.height;
    p.stride = fullFrame_.stride;
    p.planeSize = fullFrame_.planeSize;
    p.sigma = light().sigma;
    // A_l = (2 sigma)^2, as section 3.5.1 takes the light's effective width.
    p.lightSize = 2.0f * light().sigma;
    p.k = settings_.k;
    p.mu = settings_.mu;
    p.alpha = settings_.alpha;
    p.fillRadius = static_cast<std::uint32_t>(settings_.fillRadius);
    p.fillScale = gaussianScale(settings_.fillSigma);
    p.countCap = static_cast<std::uint32_t>(settings_.maxSpp);
    p.fixedWidth = settings_.filtering == Filtering::Fixed ? settings_.fixedWidth : 0.0f;
    p.countExponent = settings_.countExponent;
    p.varianceFloor = settings_.varianceFloor;
    p.varianceSpread = settings_.varianceSpread;
    p.lightCentre = light().centre;
    p.leastCount = WEDGE_FIRST_PASS_RAYS;
    return p;
}

void SoftShadows::widthsAndCounts()
{
    const bool spectrum = settings_.sampling == Sampling::Adaptive && settings_.counts == Counts::Spectrum;
    if (spectrum || settings_.slopes == Slopes::Published) {
        publishedWidths();
    }
    if (settings_.slopes == Slopes::Smoothed) {
        smoothedWidths();
    }
    if (settings_.sampling == Sampling::Uniform) {
        uniformCounts();
    } else if (settings_.counts == Counts::Variance) {
        countsFromVariance();
    }
}

void SoftShadows::publishedWidths()
{
    const shared::AnalysisParams p = analysisParams(full_);
    constexpr std::uint32_t planes = 4;
    passes_.rows("widths", PassKind::Analysis, "analysis.cl", "publishedDistances", p, WEDGE_BLOCK_PIXELS, term_.extremes,
        frame_.position, frame_.objectId, term_.logs);
    passes_.rows("widths", PassKind::Analysis, "analysis.cl", "spreadRows", p, WEDGE_BLOCK_PIXELS, planes,
        term_.logs, term_.rowsSpread);
    passes_.rows("widths", PassKind::Analysis, "analysis.cl", "spreadColumns", p, WEDGE_BLOCK_PIXELS, planes,
        term_.rowsSpread, term_.spread);
    passes_.rows("widths", PassKind::Analysis, "analysis.cl", "publishedWidths", p, 1, term_.extremes, term_.spread,
        frame_.objectId, frame_.pixelSize, term_.sums, term_.beta, term_.wanted);
}

void SoftShadows::smoothedWidths()
{
    const shared::AnalysisParams p = analysisParams(full_);
    constexpr std::uint32_t planes = 2;
    // The plane of demands is free until the counts are made.
    passes_.rows("widths", PassKind::Analysis, "analysis.cl", "erodeSlopes", p, WEDGE_BLOCK_PIXELS, term_.extremes,
        frame_.objectId, term_.demand);
    passes_.rows("widths", PassKind::Analysis, "analysis.cl", "smoothSlopes", p, WEDGE_BLOCK_PIXELS, term_.demand,
        frame_.objectId, term_.logs);
    passes_.rows("widths", PassKind::Analysis, "analysis.cl", "spreadRows", p, WEDGE_BLOCK_PIXELS, planes,
        term_.logs, term_.rowsSpread);
    passes_.rows("widths", PassKind::Analysis, "analysis.cl", "spreadColumns", p, WEDGE_BLOCK_PIXELS, planes,
        term_.rowsSpread, term_.spread);
    passes_.rows("widths", PassKind::Analysis, "analysis.cl", "widths", p, 1, term_.logs, term_.spread,
        frame_.objectId, frame_.pixelSize, term_.sums, term_.beta);
}

void SoftShadows::countsFromVariance()
{
    const shared::AnalysisParams p = analysisParams(full_);
    if (settings_.filtering == Filtering::None) {
        term_.effective.fill(passes_.queue(), 1.0f);
    } else {
        gaussianFilter(passes_, { "filter of first pass", PassKind::Analysis, "filter.cl" },
            filterParams(settings_, fullFrame_, light(), full_), full_, frame_, term_.value, term_, term_.filtered);
    }
    const device::Buffer<float>& visibility = settings_.filtering == Filtering::None ? term_.value : term_.filtered;
    passes_.rows("counts", PassKind::Analysis, "counts.cl", "countDemand", p, WEDGE_BLOCK_PIXELS, visibility,
        term_.effective, term_.beta, frame_.objectId, term_.demand);
    render::countsFromDemand(passes_, p, static_cast<float>(settings_.spp), frame_.objectId, term_);
}

void SoftShadows::uniformCounts()
{
    const image::Window& counted = settings_.method == Method::MonteCarlo ? window_ : full_;
    render::uniformCounts(passes_, analysisParams(blockWindow(counted, 0, full_.x1, full_.y1)),
        static_cast<std::uint32_t>(settings_.spp), frame_.objectId, term_);
}

void SoftShadows::shade(const device::Buffer<float>& value)
{
    const image::Window window = blockWindow(window_, 0, full_.x1, full_.y1);
    const shared::AnalysisParams p = analysisParams(window);
    passes_.rows("composite", PassKind::Composite, "composite.cl", "addDiffuse", p, WEDGE_BLOCK_PIXELS, sampleParams(),
        light(), scene_.quadratures[index_], frame_.position, frame_.normal, frame_.objectId, frame_.diffuse, value,
        term_.value, term_.taken, frame_.direct, frame_.directNoisy, frame_.samples);
    if (scene_.specular) {
        passes_.rows("composite", PassKind::Composite, "composite.cl", "addSpecular", p, 1, sampleParams(), light(),
            fullFrame_, scene_.quadratures[index_], frame_.position, frame_.normal, frame_.objectId, frame_.gloss,
            frame_.specular, value, term_.value, term_.sums, term_.taken, frame_.direct, frame_.directNoisy);
    }
}

} // namespace wedge::render
