#include "host/render/distributed_frame.h"

#include "host/render/filters/gaussian.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wedge::render {

using device::PassKind;

namespace {

// Samples of a pixel between two looks at what the image would be if the render stopped.
constexpr std::uint32_t monteCarloRound = 16;

} // namespace

bool isDistributed(const Settings& settings, const scene::Scene& scene)
{
    return scene.camera.apertureRadius > 0 || scene::geometryMoves(scene) || scene::cameraMoves(scene)
        || settings.antialias || settings.progressive;
}

DistributedFrame::DistributedFrame(const TermContext& context, Waves& waves,
    const std::vector<std::unique_ptr<Term>>& terms, std::size_t lights, const shared::CameraParams& camera,
    bool keepLayers)
    : c_(context)
    , waves_(waves)
    , terms_(terms)
    , camera_(camera)
    , keepLayers_(keepLayers)
    , lit_(context.settings.integrator == Integrator::Path)
{
    for (std::uint32_t i = 0; i < lights; ++i) {
        lights_.emplace_back(context, *terms[i], i);
    }
    const std::vector<IndirectTerm> components = indirectTerms(context.settings, context.scene.specular);
    for (std::size_t i = 0; i < components.size(); ++i) {
        paths_.emplace_back(context, *terms[lights + i], components[i].component);
    }
}

bool DistributedFrame::render(const std::atomic<bool>* stop)
{
    begin();
    const bool complete = refine(stop);
    compose();
    return complete;
}

void DistributedFrame::begin()
{
    eachTerm([&](Term& term, float) { term.clear(c_.passes.queue()); });
    analysed_ = false;
    taken_ = 0;
}

bool DistributedFrame::refine(const std::atomic<bool>* stop)
{
    stop_ = stop;
    try {
        return c_.settings.method == Method::MonteCarlo ? monteCarlo() : adaptive();
    } catch (const device::Cancelled&) {
        return false;
    }
}

bool DistributedFrame::monteCarlo()
{
    const auto spp = static_cast<std::uint32_t>(c_.settings.spp);
    c_.frame.primaryWanted.fill(c_.passes.queue(), spp);
    eachTerm([&](Term& term, float) { term.wanted.fill(c_.passes.queue(), spp); });
    while (taken_ < spp) {
        const std::uint32_t round = std::min(monteCarloRound, spp - taken_);
        if (!sample(c_.sampledFrame, taken_ + round, false, round)) {
            return false;
        }
        taken_ += round;
        if (c_.passes.rehearsal()) {
            break;
        }
    }
    return true;
}

bool DistributedFrame::firstPass(std::uint32_t first)
{
    if (!c_.frame.shape.packed()) {
        c_.frame.primaryWanted.fill(c_.passes.queue(), first);
        eachTerm([&](Term& term, float) { term.wanted.fill(c_.passes.queue(), first); });
    }
    return sample(c_.fullFrame, first, true, first);
}

std::uint32_t DistributedFrame::firstPaths() const
{
    return static_cast<std::uint32_t>(std::min(c_.settings.distributed.firstPaths, c_.settings.spp));
}

bool DistributedFrame::adaptive()
{
    const std::uint32_t first = firstPaths();
    if (taken_ < first) {
        if (!firstPass(first)) {
            return false;
        }
        taken_ = first;
    }
    if (c_.settings.distributed.published) {
        publishedCounts();
    } else {
        widths();
        demands();
        counts();
        if (c_.settings.progressive) {
            limitStep();
        }
    }
    Waves::limitTiles(c_.passes, c_.fullFrame, c_.frame);
    analysed_ = c_.settings.filtering != Filtering::None;
    const auto spp = static_cast<std::uint32_t>(c_.settings.spp);
    const double units = spp - static_cast<double>(taken_);
    if (!sample(c_.sampledFrame, std::numeric_limits<std::uint32_t>::max(), false, units)) {
        return false;
    }
    taken_ = std::max(taken_, spp);
    return true;
}

bool DistributedFrame::sample(const shared::FrameParams& frame, std::uint32_t last, bool slopes, double workUnits)
{
    shared::WaveParams settings {};
    settings.sampler = samplerOf(c_);
    settings.published = c_.settings.method == Method::AxisAligned && c_.settings.distributed.published ? 1 : 0;
    if (c_.frame.shape.lean) {
        settings.omits = WEDGE_OMITS_LAYERS | (c_.frame.shape.ofMotion() == 1 ? 0u : WEDGE_OMITS_MOTION)
            | (slopes ? 0u : WEDGE_OMITS_ANALYSIS) | (slopes && c_.frame.shape.packed() ? WEDGE_OMITS_COUNTS : 0u);
        settings.packed = c_.frame.shape.packed() ? 1 : 0;
        settings.oneVelocity = c_.settings.distributed.oneVelocity;
    }
    const std::vector<shared::WaveParams> waves = waves_.schedule(c_.passes, frame, camera_, c_.frame, settings, last);
    for (const shared::WaveParams& wave : waves) {
        if (stop_ != nullptr && *stop_) {
            return false;
        }
        sampleWave(wave, slopes, workUnits / static_cast<double>(waves.size()));
    }
    return true;
}

void DistributedFrame::sampleWave(const shared::WaveParams& wave, bool slopes, double workUnits)
{
    const double units = workUnits / (1.0 + static_cast<double>(lights_.size() + paths_.size()));
    waves_.trace(c_.passes, c_.scene, c_.frame, wave, lit_, units);
    for (SoftShadows& light : lights_) {
        light.sampleWave(waves_, wave, slopes, units);
    }
    if (lit_ && c_.scene.deltaLightCount > 0) {
        deltaLights(wave);
    }
    for (Indirect& path : paths_) {
        path.sampleWave(waves_, wave, units);
    }
    waves_.accumulateSurfaces(c_.passes, c_.frame, wave);
}

void DistributedFrame::deltaLights(const shared::WaveParams& wave)
{
    const DeviceScene& s = c_.scene;
    waves_.radiance.fill(c_.passes.queue(), 0.0f);
    c_.passes.tiles("point and directional lights", PassKind::Trace, "delta_lights.cl", "deltaLights",
        waves_.receiverParams(wave), 0.0, s.deltaLights, s.deltaLightCount, s.diameter, s.nodes, s.blocks,
        waves_.receivers(), waves_.diffuse, waves_.specular, waves_.radiance, waves_.radianceNoisy, waves_.rays);
    waves_.pixels(c_.passes, "accumulateDelta", wave, waves_.pixelFirst, waves_.pixelCount, c_.frame.primaryTaken,
        waves_.objectId, waves_.radiance, c_.frame.delta, c_.frame.deltaSquares);
}

shared::DistributedParams DistributedFrame::params(const image::Window& window) const
{
    const DistributedSettings& d = c_.settings.distributed;
    shared::DistributedParams p {};
    setRectangle(p, window);
    p.width = c_.fullFrame.width;
    p.height = c_.fullFrame.height;
    p.stride = c_.fullFrame.stride;
    p.planeSize = c_.fullFrame.planeSize;
    p.factoringError = d.factoringError;
    p.factoringRadius = static_cast<std::uint32_t>(d.factoringRadius);
    p.blurWidth = d.blurWidth;
    p.blurExponent = d.blurExponent;
    p.shutterWidth = d.shutterWidth;
    p.shutterExponent = d.shutterExponent;
    p.leastRadius = d.leastRadius;
    p.irradianceWidth = d.irradianceWidth;
    p.countExponent = d.countExponent;
    p.varianceSpread = d.varianceSpread;
    p.oneVelocity = d.oneVelocity;
    p.published = d.published ? 1 : 0;
    p.packed = c_.frame.shape.packed() ? 1 : 0;
    p.still = c_.frame.shape.ofMotion() == 0 ? 1 : 0;
    p.frames = static_cast<float>(d.frames);
    p.never = d.factoring == Factoring::Never ? 1 : 0;
    return p;
}

void DistributedFrame::widths()
{
    // The error of taking a term apart comes first: in lean frames widths take the place of what it is made of.
    for (std::size_t i = 0; i < terms_.size(); ++i) {
        Term& term = *terms_[i];
        const bool packed = c_.frame.shape.packed();
        const device::Buffer<float>& error = packed ? term.plain : c_.scratch.error;
        if (!packed) {
            c_.passes.rows("widths", PassKind::Analysis, "distributed.cl", "factoringError", params(c_.full()), 1,
                term.texture, term.value, term.plain, error);
        }
        if (i < lights_.size()) {
            lights_[i].widths();
        } else {
            paths_[i - lights_.size()].widths();
        }
        const device::Buffer<float>& width = packed ? c_.scratch.width : term.beta;
        c_.passes.rows("widths", PassKind::Analysis, "distributed.cl", "factoredWidths", params(c_.full()), 1, error,
            c_.frame.confusion, c_.frame.pixelSize, c_.frame.objectId, width);
        if (packed) {
            c_.passes.rows(
                "widths", PassKind::Analysis, "distributed.cl", "copyPlane", params(c_.full()), 1, width, term.beta);
        }
    }
    // Packed motions are still means of which there will be more.
    blurWidths(static_cast<float>(c_.settings.spp),
        c_.frame.shape.packed() ? c_.scratch.motionDirection : c_.frame.motionDirection);
}

void DistributedFrame::blurWidths(float samples, const device::Buffer<float>& directions)
{
    shared::DistributedParams p = params(c_.full());
    p.samples = samples;
    c_.passes.rows("widths", PassKind::Analysis, "distributed.cl", "blurs", p, 1, c_.frame.confusion, c_.frame.motion,
        c_.frame.primaryTaken, c_.frame.lensWidth, motionWidth(), directions);
}

void DistributedFrame::copy(const device::Buffer<float>& image, device::Buffer<float>& to)
{
    c_.passes.rows("composite", PassKind::Composite, "progressive.cl", "copyImage", params(c_.full()), 1, image, to);
}

void DistributedFrame::addUnfiltered(device::Buffer<float>& direct, device::Buffer<float>& indirect)
{
    shared::DistributedParams p = params(c_.full());
    for (std::size_t i = 0; i < terms_.size(); ++i) {
        const Term& term = *terms_[i];
        p.values = i < lights_.size() ? 1 : 3;
        c_.passes.rows("composite", PassKind::Composite, "distributed.cl", "addTerm", p, 1, term.texture, term.value,
            term.radiance, i < lights_.size() ? direct : indirect);
    }
}

void DistributedFrame::startSums()
{
    if (c_.frame.shape.lean) {
        const bool analysed = c_.frame.shape.analysed;
        const std::uint32_t first = analysed ? firstPaths() : std::numeric_limits<std::uint32_t>::max();
        eachTerm([&](Term& term, float) {
            c_.passes.rows("composite", PassKind::Composite, "distributed.cl", "settleCounts", params(c_.full()), 1,
                first, c_.frame.primaryTaken, term.wanted);
        });
        // All that is reflected is added to what is emitted.
        if (c_.frame.shape.ofDeltaLights() == 1) {
            c_.passes.rows("composite", PassKind::Composite, "distributed.cl", "addImage", params(c_.full()), 1,
                c_.frame.delta, c_.frame.beauty);
        }
        return;
    }
    const auto start = [&](device::Buffer<float>& direct, device::Buffer<float>& indirect) {
        copy(c_.frame.delta, direct);
        indirect.fill(c_.passes.queue(), 0.0f);
    };
    start(c_.frame.direct, c_.frame.indirect);
    if (keepLayers_ || c_.settings.progressive) {
        start(c_.frame.directNoisy, c_.frame.indirectNoisy);
        addUnfiltered(c_.frame.directNoisy, c_.frame.indirectNoisy);
    }
}

void DistributedFrame::filter()
{
    startSums();
    if (!analysed_) {
        addUnfiltered(c_.frame.direct, c_.frame.indirect);
        return;
    }
    blurWidths(0.0f, c_.frame.motionDirection);
    shared::DistributedParams p = params(c_.full());
    p.values = 1;
    for (SoftShadows& light : lights_) {
        light.filterDistributed(p);
    }
    p.values = 3;
    for (Indirect& path : paths_) {
        path.filterDistributed(p);
    }
}

void DistributedFrame::compose(device::Buffer<float>* emission)
{
    if (!lit_) {
        c_.frame.emission.fill(c_.passes.queue(), 0.0f);
    }
    filter();
    if (!c_.frame.shape.lean) {
        c_.passes.rows("composite", PassKind::Composite, "distributed.cl", "addAll", params(c_.full()), 1,
            c_.frame.emission, c_.frame.direct, c_.frame.indirect, c_.frame.beauty);
    }
    if (emission != nullptr) {
        copy(c_.frame.emission, *emission);
    }
    if (!analysed_ || !c_.settings.distributed.blur) {
        return;
    }
    blur(c_.frame.beauty);
    if (keepLayers_) {
        device::Buffer<float>& emitted = emission != nullptr ? *emission : c_.frame.emission;
        for (device::Buffer<float>* part : { &emitted, &c_.frame.direct, &c_.frame.indirect }) {
            blur(*part);
        }
    }
}

void DistributedFrame::blur(device::Buffer<float>& image)
{
    const char* pass = "filter of lens and shutter";
    const shared::DistributedParams p = params(c_.full());
    if (camera_.apertureRadius > 0) {
        c_.passes.rows(
            pass, PassKind::Filter, "blur.cl", "blurRows", p, 1, c_.frame.lensWidth, image, c_.scratch.rowsFiltered);
        c_.passes.rows(
            pass, PassKind::Filter, "blur.cl", "blurColumns", p, 1, c_.frame.lensWidth, c_.scratch.rowsFiltered, image);
    }
}

} // namespace wedge::render
