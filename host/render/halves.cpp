#include "host/render/halves.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wedge::render {

using device::PassKind;

namespace {

const char* const pass = "mean of halves";
const char* const file = "progressive.cl";

constexpr FrameShape frameOfHalf { true, false, true, true, true };

// Both halves' numbers are hashes of their seeds: any two seeds will do.
constexpr std::uint32_t secondSeed = 0x9e3779b9u;

} // namespace

double ErrorEstimate::rmse() const { return std::sqrt(noise + (std::isnan(bias) ? bias : std::max(bias, 0.0))); }

void Halves::plan(device::MemoryPlan& plan, const PlaneLayout& layout, const std::vector<TermShape>& terms)
{
    for (int half = 0; half < 2; ++half) {
        Frame::plan(plan, layout, frameOfHalf);
        for (const TermShape& shape : terms) {
            Term::plan(plan, layout, shape);
        }
        plan.addItems("emission layer of a half", layout.size, 12);
    }
}

Halves::Halves(const device::Device& device, device::TimedQueue& queue, const PlaneLayout& layout,
    const std::vector<TermShape>& terms)
{
    for (Half& half : halves_) {
        half.frame = std::make_unique<Frame>(device, queue, layout, frameOfHalf);
        for (const TermShape& shape : terms) {
            half.terms.push_back(std::make_unique<Term>(device, queue, *half.frame, shape));
        }
        half.emission = std::make_unique<device::Buffer<float>>(device, 3 * layout.size, "emission layer of a half");
    }
}

bool Halves::hold(const PlaneLayout& layout, const std::vector<TermShape>& terms) const
{
    const Half& half = halves_[0];
    return half.frame->layout == layout
        && std::ranges::equal(
            half.terms, terms, [](const auto& term, const TermShape& shape) { return term->shape.holds(shape); });
}

void Halves::begin(
    const TermContext& context, Waves& waves, std::size_t lights, const shared::CameraParams& camera, bool keepLayers)
{
    all_ = step_ = context.settings;
    sampled_ = 0;
    for (std::size_t i = 0; i < halves_.size(); ++i) {
        Half& half = halves_[i];
        half.frame->clear(context.passes.queue());
        TermContext own { context.passes, context.scene, *half.frame, context.scratch, step_, context.fullFrame,
            context.sampledFrame, context.window, context.shutter };
        own.fullFrame.seed = own.sampledFrame.seed =
            context.fullFrame.seed + static_cast<std::uint32_t>(i) * secondSeed;
        half.image = std::make_unique<DistributedFrame>(own, waves, half.terms, lights, camera, keepLayers);
        half.image->begin();
        if (i == 0) {
            context_ = std::make_unique<TermContext>(own);
        }
    }
    halves_[0].image->followDemandsOf(*halves_[1].image);
    halves_[1].image->followDemandsOf(*halves_[0].image);
}

bool Halves::refine(int spp, const std::atomic<bool>& stop)
{
    step_ = halfAt(all_, spp);
    for (std::size_t i = 0; i < halves_.size(); ++i) {
        if (!halves_[i].image->refine(&stop)) {
            return false;
        }
        sampled_ = std::max(sampled_, static_cast<int>(i) + 1);
    }
    return true;
}

shared::DistributedParams Halves::params() const
{
    shared::DistributedParams p {};
    setRectangle(p, context_->full());
    p.width = context_->fullFrame.width;
    p.height = context_->fullFrame.height;
    p.stride = context_->fullFrame.stride;
    p.planeSize = context_->fullFrame.planeSize;
    return p;
}

void Halves::show(Frame& shown)
{
    for (Half& half : halves_) {
        half.image->compose(half.emission.get());
    }
    Passes& passes = context_->passes;
    const shared::DistributedParams p = params();
    const Frame& a = *halves_[0].frame;
    const Frame& b = *halves_[1].frame;
    const auto mean = [&](const device::Buffer<float>& first, const device::Buffer<float>& second,
                          device::Buffer<float>& out) {
        passes.rows(pass, PassKind::Composite, file, "meanOfHalves", p, 1, 3u, a.primaryTaken, b.primaryTaken, first,
            second, out);
    };
    for (device::Buffer<float> Frame::*planes : { &Frame::beauty, &Frame::direct, &Frame::directNoisy, &Frame::indirect,
             &Frame::indirectNoisy, &Frame::diffuse, &Frame::specular }) {
        mean(a.*planes, b.*planes, shown.*planes);
    }
    mean(*halves_[0].emission, *halves_[1].emission, shown.emission);
    passes.rows(pass, PassKind::Composite, file, "joinSurfaces", p, 1, a.hits, b.hits, a.position, b.position, a.normal,
        b.normal, a.pixelSize, b.pixelSize, a.depth, b.depth, a.objectId, b.objectId, shown.position, shown.normal,
        shown.pixelSize, shown.depth, shown.objectId);
    for (device::Buffer<std::uint32_t> Frame::*counts :
        { &Frame::samples, &Frame::indirectSamples, &Frame::rays, &Frame::pathRays, &Frame::primaryTaken }) {
        passes.rows(pass, PassKind::Composite, file, "sumOfHalves", p, 1, a.*counts, b.*counts, shown.*counts);
    }
}

ErrorEstimate Halves::error(Frame& shown) const
{
    if (sampled_ < 2) {
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        return { unknown, unknown };
    }
    Passes& passes = context_->passes;
    const Frame& a = *halves_[0].frame;
    const Frame& b = *halves_[1].frame;
    passes.rows(pass, PassKind::Composite, file, "errorOfHalves", params(), 1, analysed() ? 1u : 0u, a.beauty,
        a.emission, a.directNoisy, a.indirectNoisy, b.beauty, b.emission, b.directNoisy, b.indirectNoisy,
        shown.lensWidth, shown.motionWidth);
    const std::vector<float> noise = shown.lensWidth.downloadAll(passes.queue());
    const std::vector<float> bias = shown.motionWidth.downloadAll(passes.queue());
    const image::Window window = context_->window;
    ErrorEstimate sum { 0, 0 };
    for (int y = window.y0; y < window.y1; ++y) {
        for (int x = window.x0; x < window.x1; ++x) {
            const std::size_t i =
                shared::pixelIndex(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), shown.layout.stride);
            sum.noise += noise[i];
            sum.bias += bias[i];
        }
    }
    const double pixels = static_cast<double>(window.width()) * window.height();
    return { sum.noise / pixels, sum.bias / pixels };
}

} // namespace wedge::render
