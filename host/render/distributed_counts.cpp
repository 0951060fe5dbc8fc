// Which samples of a distributed frame are worth most: the counts of primary and secondary samples.
#include "host/render/distributed_frame.h"
#include "host/render/filters/gaussian.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wedge::render {

using device::PassKind;

namespace {

/// Of one kind of samples, as the device has them.
struct Demand {
    std::vector<float> values;
    std::vector<std::uint32_t> taken; ///< which no count goes below
    float rays; ///< of a sample
    float least; ///< samples of a pixel
    float room; ///< new samples of a tile's pixels together, at most
};

/// Samples of all pixels, where those have `scale` times what they ask for, `most` at most.
double samplesAt(float scale, const Demand& demand, float most, const shared::FrameParams& frame)
{
    double sum = 0;
    std::vector<float> added((frame.width + WEDGE_TILE - 1) / WEDGE_TILE);
    for (std::uint32_t top = 0; top < frame.height; top += WEDGE_TILE) {
        std::ranges::fill(added, 0.0f);
        for (std::uint32_t y = top; y < std::min(top + WEDGE_TILE, frame.height); ++y) {
            const std::size_t row = shared::pixelIndex(0, y, frame.stride);
            float before = 0;
            for (std::size_t x = 0; x < frame.width; ++x) {
                const float wanted = std::clamp(scale * demand.values[row + x], demand.least, most);
                const auto taken = static_cast<float>(demand.taken[row + x]);
                before += taken;
                added[x / WEDGE_TILE] += std::max(wanted - taken, 0.0f);
            }
            sum += before;
        }
        for (const float tile : added) {
            sum += std::min(tile, demand.room);
        }
    }
    return sum;
}

} // namespace

void DistributedFrame::publishedCounts()
{
    const DistributedSettings& d = c_.settings.distributed;
    shared::DistributedParams p = params(c_.full());
    const auto flags = [&](const Term& term) {
        c_.passes.rows("widths", PassKind::Analysis, "published.cl", "publishedFlags", p, 1, term.texture, term.value,
            term.radiance, c_.scratch.demand);
    };
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        flags(*terms_[i]);
        lights_[i].publishedWidths(p, c_.scratch.demand);
    }
    for (std::size_t i = 0; i < paths_.size(); ++i) {
        flags(*terms_[lights_.size() + i]);
        paths_[i].publishedWidths(p, c_.scratch.demand);
    }
    const auto most = static_cast<std::uint32_t>(d.maxSpp);
    c_.passes.rows("counts", PassKind::Analysis, "published.cl", "publishedPrimary", p, 1, d.mu,
        static_cast<float>(d.mixedPaths), c_.frame.confusion, c_.frame.motion, c_.frame.primaryDemand);
    c_.passes.rows("counts", PassKind::Analysis, "published.cl", "publishedCounts", p, 1, most, c_.frame.primaryDemand,
        c_.frame.primaryTaken, c_.frame.primaryTaken, c_.frame.primaryWanted);
    eachTerm([&](Term& term, float) {
        c_.passes.rows("counts", PassKind::Analysis, "published.cl", "publishedCounts", p, 1, most, term.demand,
            c_.frame.primaryWanted, term.taken, term.wanted);
    });
}

const device::Buffer<float>& DistributedFrame::motionWidth() const
{
    return c_.frame.shape.packed() ? c_.scratch.motionWidth : c_.frame.motionWidth;
}

void DistributedFrame::demandOf(Term& term, float rays, bool light)
{
    shared::DistributedParams p = params(c_.full());
    p.values = light ? 1 : 3;
    p.rays = rays;
    const Scratch& scratch = c_.scratch;
    c_.passes.rows("counts", PassKind::Analysis, "distributed.cl", "splitVariance", p, 1, term.texture,
        term.textureSquares, term.value, term.squares, c_.frame.primaryTaken, scratch.ofTexture, scratch.logs);
    c_.passes.rows(
        "counts", PassKind::Analysis, "distributed.cl", "addPlane", p, 1, scratch.ofTexture, scratch.ofAllTextures);
    // For the effective counts alone.
    gaussianFilter(c_.passes, { "pixels gathered", PassKind::Analysis, "filter_variance.cl" },
        filterParams(c_.settings, c_.fullFrame, c_.full()), c_.full(), c_.frame, c_.scratch.logs, term.beta, c_.scratch,
        c_.scratch.filtered);
    c_.passes.rows("counts", PassKind::Analysis, "distributed.cl", "sampleDemand", p, 1, c_.scratch.logs,
        c_.scratch.effective, term.beta, c_.frame.lensWidth, motionWidth(), term.demand);
}

void DistributedFrame::demands()
{
    shared::DistributedParams p = params(c_.full());
    p.rays = 1.0f;
    p.alongMotion = 1 - p.still;
    c_.passes.rows("counts", PassKind::Analysis, "distributed.cl", "emissionVariance", p, 1, c_.frame.emission,
        c_.frame.emissionSquares, c_.frame.primaryTaken, c_.scratch.ofAllTextures);
    if (c_.scene.deltaLightCount > 0) {
        c_.passes.rows("counts", PassKind::Analysis, "distributed.cl", "emissionVariance", p, 1, c_.frame.delta,
            c_.frame.deltaSquares, c_.frame.primaryTaken, c_.scratch.demand);
        c_.passes.rows("counts", PassKind::Analysis, "distributed.cl", "addPlane", p, 1, c_.scratch.demand,
            c_.scratch.ofAllTextures);
    }
    std::size_t next = 0;
    eachTerm([&](Term& term, float rays) { demandOf(term, rays, next++ < lights_.size()); });
    // Nothing but lens and shutter averages textures and what emits.
    c_.scratch.demand.fill(c_.passes.queue(), -1.0f);
    c_.passes.rows("counts", PassKind::Analysis, "distributed.cl", "sampleDemand", p, 1, c_.scratch.ofAllTextures,
        c_.scratch.effective, c_.scratch.demand, c_.frame.lensWidth, motionWidth(), c_.frame.primaryDemand);
    const DistributedSettings& d = c_.settings.distributed;
    const auto atLeast = [&](float apart, float together, const Term& term, const device::Buffer<float>& least,
                             const device::Buffer<float>& demand) {
        c_.passes.rows(
            "counts", PassKind::Analysis, "distributed.cl", "atLeast", p, 1, apart, together, term.beta, least, demand);
    };
    eachTerm([&](Term& term, float) {
        atLeast(d.leastPrimaries, d.leastPrimaries, term, term.demand, c_.frame.primaryDemand);
    });
    // Where a term is not taken apart its texture is known at receivers that sample it alone.
    eachTerm([&](Term& term, float) { atLeast(d.leastSecondaries, 1.0f, term, c_.frame.primaryDemand, term.demand); });
}

void DistributedFrame::counts()
{
    // The scale of all demands that makes the mean number of rays what uniform counts would have.
    const DistributedSettings& d = c_.settings.distributed;
    std::vector<Demand> demands;
    device::TimedQueue& queue = c_.passes.queue();
    const DistributedFrame& guide = guide_ != nullptr && guide_->taken_ > 0 ? *guide_ : *this;
    const float first = static_cast<float>(std::min(d.firstPaths, c_.settings.spp)),
                most = static_cast<float>(d.maxSpp);
    const auto leastOf = [&](float share) {
        return std::max(first, std::floor(share * static_cast<float>(c_.settings.spp)));
    };
    const float leastOfTerms = leastOf(std::max(d.leastShare, d.leastTermShare));
    // Samples of terms go to new receivers: one at least.
    const float least = std::min(std::max(leastOf(d.leastShare), first + 1.0f), static_cast<float>(c_.settings.spp));
    demands.push_back({ guide.c_.frame.primaryDemand.downloadAll(queue), c_.frame.primaryTaken.downloadAll(queue), 1.0f,
        least, static_cast<float>(Waves::capacity) }); // limitTiles()
    double perPath = 1.0;
    std::size_t next = 0;
    eachTerm([&](Term& term, float rays) {
        demands.push_back({ guide.terms_[next++]->demand.downloadAll(queue), term.taken.downloadAll(queue), rays,
            leastOfTerms, std::numeric_limits<float>::infinity() });
        perPath += rays;
    });
    const std::size_t pixels = std::size_t { c_.fullFrame.width } * c_.fullFrame.height;
    const double budget = perPath * c_.settings.spp * static_cast<double>(pixels);
    double low = 1e-12, high = 1e12;
    for (int step = 0; step < 40; ++step) {
        const double scale = std::sqrt(low * high);
        double rays = 0;
        for (const Demand& demand : demands) {
            rays += demand.rays * samplesAt(static_cast<float>(scale), demand, most, c_.fullFrame);
        }
        (rays > budget ? high : low) = scale;
    }
    const shared::DistributedParams p = params(c_.full());
    const auto scale = static_cast<float>(low);
    c_.passes.rows("counts", PassKind::Analysis, "distributed.cl", "scaleCounts", p, 1, scale,
        static_cast<std::uint32_t>(least), static_cast<std::uint32_t>(most), guide.c_.frame.primaryDemand,
        c_.frame.primaryTaken, c_.frame.primaryWanted);
    next = 0;
    eachTerm([&](Term& term, float) {
        c_.passes.rows("counts", PassKind::Analysis, "distributed.cl", "scaleCounts", p, 1, scale,
            static_cast<std::uint32_t>(leastOfTerms), static_cast<std::uint32_t>(most), guide.terms_[next++]->demand,
            term.taken, term.wanted);
    });
}

void DistributedFrame::limitStep()
{
    c_.passes.rows("counts", PassKind::Analysis, "distributed.cl", "limitStep", params(c_.full()), 1,
        c_.frame.primaryTaken, c_.frame.primaryWanted);
}

} // namespace wedge::render
