#pragma once

#include "host/render/frame_builder.h"
#include "host/render/sample_bins.h"
#include "host/render/waves.h"
#include "kernels/shared/distributed.h"
#include "kernels/shared/filter_params.h"

#include <cstdint>
#include <optional>
#include <string>

namespace wedge::render {

/// What pixels of several receivers keep of a term, see kernels/waves/accumulate.h. Those that a frame has no need of
/// are of no graph.
struct TermMeans {
    graph::Handle<Texture> texture;
    graph::Handle<Value> value;
    graph::Handle<Value> plain; ///< mean
    graph::Handle<Value> error; ///< of lean frames, in its place
    graph::Handle<Squares> squares, textureSquares;
    /// Of compact frames, in their place: standard deviations of a sample's radiance and of its texture.
    graph::Handle<Deviation> spreads;
    graph::Handle<Extremes> extreme; ///< the one that widths are made of, where it says all
    // Of lights, where things move:
    graph::Handle<Pixels> shadowSums; ///< of shadows' motions
    graph::Handle<Pixels> shadowMotion; ///< of lean frames: their mean
    graph::Handle<Radiance> radiance; ///< as published
    graph::Handle<Deviation> deviation;
    graph::Handle<Extremes> extremes; ///< slopes, or distances
    graph::Handle<Count> taken; ///< samples; where none are kept they are the primary ones, between two passes
    graph::Handle<Count> wanted;
    // Made of these:
    graph::Handle<Metres> beta; ///< width of the filter
    graph::Handle<Demand> demand;
    graph::Handle<Uncertainty> uncertainty; ///< of the pixel's own samples
};

/// What a frame is to have of its pixels, and in which shape.
struct SampleShape {
    bool analysed = false; ///< filters and counts of their own
    bool published = false; ///< as thesis chapter 5 has them
    bool layers = false; ///< what only they show, too
    /// Direct and indirect light, filtered and not, and what reflects them: of frames whose layers are read, or parts
    /// filtered, and of those that are filtered over time.
    bool apart = false;
    bool parts = false; ///< direct and indirect light and what is emitted are outputs of their own
    /// Terms' counts, and sums of all samples, which layers show, steps of a progressive frame go on with, and other
    /// than the default analysis asks for; else pixels keep what one image is made of.
    bool full = false;
    /// In fewer bits: of analysed frames, where no layers are shown and no other than the default analysis asks for
    /// more.
    bool compact = false;
    bool moves = false; ///< something moves while the shutter is open
    bool geometryMoves = false;

    bool measures() const { return layers || analysed; } ///< what the analysis is made of, and layers of pixels' sizes
    bool lean() const { return compact && !full; }
};

/// What blurMotion of distributed.cl asks of filters along motions: standard deviations and unit vectors, or, of lean
/// frames, both in one.
std::vector<graph::Argument> readsMotion(
    const FrameBuilder& frame, const graph::Handle<Pixels>& along, const graph::Handle<Pixels>& directions);

/// How one sampling adds to what there is.
struct Adding {
    bool first = false; ///< the analysis is made of these samples
    bool measures = false; ///< what the analysis is made of, and not the means alone
    bool probes = false; ///< of the term as many as primary ones, which are added to nothing
};

/// What filters made of a term's value.
struct FilteredTerm {
    graph::Handle<Value> value;
    graph::Handle<Share> shares; ///< how far it falls back to the term's own; of no graph where it does not
};

/// A term of a frame whose pixels have several receivers: what an effect declares for it.
class WaveTerm {
public:
    /// values: numbers of what is filtered, 1 where the texture has all colour, or 3; ofSample: its rays; sum: what the
    /// term is part of.
    WaveTerm(FrameBuilder& frame, const SampleShape& shape, Sum& sum, std::uint32_t values, float ofSample)
        : rays(ofSample)
        , f_(frame)
        , shape_(shape)
        , sum_(sum)
        , values_(values)
    {
    }
    virtual ~WaveTerm() = default;
    WaveTerm(const WaveTerm&) = delete;
    WaveTerm& operator=(const WaveTerm&) = delete;

    /// The samples of a wave's receivers, added to their pixels. counts, hits: of primary samples.
    virtual void sample(
        Waves& waves, const Adding& adding, const PrimaryCounts& counts, const graph::Handle<Count>& hits) = 0;
    /// What filters can be on it by (filter_chain.h).
    virtual Target target() const { return {}; }
    /// Of terms that filters of samples can be on, samples of probes, one of each receiver: sums, as lists.
    virtual graph::Handle<Sums> probe(Waves& /*waves*/, const PrimaryCounts& /*counts*/) { return {}; }
    /// means.beta, metres, from what was measured.
    virtual void widths() = 0;
    /// Samples that antialiased pixels take of it as published; 0: what the analysis says.
    virtual std::uint32_t publishedSamples() const { return 0; }
    /// widths() as published, and means.demand; flags: 1 where texture and value are taken apart.
    virtual void publishedWidths(const shared::DistributedParams& params, const graph::Handle<Share>& flags,
        const graph::Handle<Pixels>& confusion) = 0;
    /// Widens means.beta once the samples are complete, and filters the value.
    virtual FilteredTerm filtered(const shared::DistributedParams& params) = 0;

    /// Whether what is filtered is one number, from 0 to 1, and the texture a radiance; else it is an irradiance, and
    /// the texture a reflectance.
    bool isFraction() const { return values_ == 1; }
    Sum& sum() const { return sum_; }
    /// params with what the kernels ask for of the term.
    shared::DistributedParams of(shared::DistributedParams params) const;
    /// What pixels keep of extremes, and whether the one that widths are made of is enough.
    virtual graph::Format extremesFormat() const = 0;
    virtual bool oneExtreme() const = 0;
    /// Whether they keep shadows' motions besides: of lights, where things move.
    virtual bool shadowsMove() const { return false; }

    const float rays;
    TermMeans means;
    std::string termName = {}; ///< Term::name
    std::optional<SampleBins> bins = {}; ///< where a filter of samples is of the term

protected:
    const Settings& settings() const { return f_.settings; }
    /// shareSamples of waves.cl: the samples that each receiver takes, from the first to before the last.
    struct Shared {
        graph::Handle<Count> first, last;
        graph::Handle<Sums> sums;
        graph::Handle<Extremes> extremes;
    };
    /// Samples that pixels want of it; any plane of counts where the wave says how many they take.
    graph::Version wantedOf(const Adding& adding, const PrimaryCounts& counts) const;
    Shared share(Waves& waves, const Adding& adding, const PrimaryCounts& counts, std::uint32_t sums,
        std::uint32_t extremes) const;
    /// What receivers are added to: the term's means, extremes and counts of samples.
    std::vector<graph::Argument> accumulated(const Adding& adding, const PrimaryCounts& counts);
    /// Widens the filter by what one number a pixel says, which visibilityOf of distributed.cl makes.
    void widen(std::string_view pass, const shared::DistributedParams& params, const shared::FilterParams& filter,
        float pixels);
    /// filtered, and how far it falls back to the term's own values where it is off by more than noise
    /// (kernels/analysis/fallback.cl). filter: what made it, if pixels that seem to have no noise are to have that of
    /// the pixels that it gathers; else null.
    FilteredTerm fallingBack(const shared::FilterParams* filter, const graph::Handle<Value>& filtered) const;
    graph::Handle<Value> visibility(std::string_view pass, const shared::DistributedParams& params) const;
    /// The extremes that widths are made of, in floats.
    graph::Handle<Extremes> wholeExtremes() const;
    /// Luminance of the texture.
    graph::Handle<Share> weights(std::string_view pass, device::PassKind kind) const;

    FrameBuilder& f_;
    SampleShape shape_;
    Sum& sum_;
    std::uint32_t values_;
};

} // namespace wedge::render
