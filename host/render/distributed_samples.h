#pragma once

#include "host/render/effect.h"
#include "host/render/frame_builder.h"
#include "host/render/sample_memory.h"
#include "host/render/waves.h"
#include "kernels/shared/distributed.h"

#include <memory>
#include <optional>
#include <vector>

namespace wedge::render {

/// Whether pixels of such a frame have several receivers: through a lens, a shutter, or all of their square.
bool isDistributed(const Settings& settings, const scene::Scene& scene);

/// What pixels of frames of these settings keep of their samples.
/// apart: as SampleShape has it, of frames whose layers are not read, too.
SampleShape sampleShape(const Settings& settings, const scene::Scene& scene, bool keepLayers, bool apart = false);

/// Samples of pixels that have several receivers each, and the image that is made of them, declared in a graph.
/// Defocus, motion blur and antialiasing together with the other effects: thesis chapter 5 and appendix B,
/// docs/multiple-effects.md. A first pass finds circles of confusion, motion, slopes and distances; those make widths,
/// and variances the counts of primary and secondary samples; a second pass takes them; irradiances are filtered where
/// they can be taken apart from textures, then the image by what lens and shutter have blurred.
class DistributedSamples {
public:
    /// What there is already.
    struct Before {
        SampleMemory* memory = nullptr; ///< where it is, and what is added to it stays; null: there is nothing
        std::uint32_t taken = 0; ///< samples of a pixel, their mean
        bool guides = false; ///< demands stay, too, for others to follow in the next graph
    };

    /// frame: of these samples alone, whose surfaces and totals are filled in.
    DistributedSamples(FrameBuilder& frame, const SampleShape& shape, const Before& before);

    /// Takes samples up to the settings' mean count. The analysis is made anew of all that there are, and what is
    /// sampled are the differences. Stops between waves, which are then whole.
    /// guide: counts follow the demands of other samples of the same terms: counts that know nothing of what they are
    /// for leave means unbiased. null: their own.
    void take(const DistributedSamples* guide);

    /// Makes the image: totals. Of layers emission, direct and indirect
    /// are filtered, too, so that they sum to the beauty.
    void compose();

    const std::vector<std::unique_ptr<WaveTerm>>& terms() const { return terms_; }
    const FrameBuilder& frame() const { return f_; }
    /// Once composed, of samples that stay: the image before any filter.
    const graph::Handle<Radiance>& plainImage() const { return plain_; }
    /// Once composed: adds all that layers show of it, or, without layers, the image and what it counts.
    void show(Outputs& to);
    const graph::Handle<Count>& taken() const { return counts_.taken; }
    /// Whether terms are.
    bool filters() const { return shape_.analysed && f_.settings.filtering != Filtering::None; }
    const graph::Handle<Count>& hits() const { return hits_; }

    /// Filled in by a run.
    struct State : TermState {
        bool complete = false; ///< once all samples that a frame, or a step of it, asks for were taken
    };
    const std::shared_ptr<State>& state() const { return state_; }

    /// Of kernels over the pixels, their rectangle to come.
    shared::DistributedParams params() const;

private:
    /// What is added up: a plane, or a list of so many elements; from step to step where there is memory for it.
    template <class Quantity>
    graph::Handle<Quantity> kept(const std::string& name, const graph::Format& format, std::uint64_t elements = 0);
    void keepPixels();
    void keepTerm(WaveTerm& term);
    void keepBins(WaveTerm& term);
    std::uint32_t firstPaths() const; ///< samples of the first pass
    /// Whether counts are chapter 6's, of antialiased frames that nothing else lights or blurs, whatever is found: four
    /// primary samples, and of each as many of a term as make it WaveTerm::publishedSamples().
    bool hasFixedCounts() const;
    /// Motions are.
    bool keepsMotion() const { return shape_.layers || shape_.published || (shape_.moves && shape_.analysed); }

    void monteCarlo();
    void adaptive(const DistributedSamples* guide);
    void sample(bool first, PrimaryCounts& counts, Waves::Sampling sampling);
    /// Rays of a primary sample of which all terms have one, its own among them.
    double raysOfPath() const;
    /// Primary samples after the first of a pixel at most, in the mean over tiles.
    double mostNew() const;
    /// What samples by brightness are exposed by, of a few samples of the whole image.
    void exposeBins();
    /// Terms' means become what a filter of samples keeps of them; returns them as they were.
    std::vector<TermMeans> keepSamples();
    /// Terms' means are all samples' again, for more to be added.
    void goOnWith(const std::vector<TermMeans>& all);
    void addUnfiltered(Waves& waves);
    void accumulateSurfaces(Waves& waves, const Adding& adding);
    /// all: terms' means of all samples, where a filter of samples has left some out of the terms' own.
    void widths(const std::vector<TermMeans>& all);
    void publishedCounts();
    void demands();
    void counts(const DistributedSamples& guide);
    /// Widths of the filters of lens and shutter.
    struct Blurs {
        graph::Handle<Pixels> lens, along, directions;
    };

    void demandOfRays(const graph::Argument& p, const graph::Version& variance, const graph::Version& effective,
        const graph::Handle<Metres>& beta, const Blurs& blurs, graph::Handle<Uncertainty>& uncertainty,
        graph::Handle<Demand>& demand);
    void demandOfTerm(WaveTerm& term, const Blurs& blurs, graph::Handle<Squares>& ofTextures);
    void countSamples();
    void startSums();
    void startParts();
    /// The image before any filter, of terms' means of all samples.
    void addPlain(const std::vector<TermMeans>& all);
    graph::Handle<Radiance> copyOf(const std::string& name, const graph::Handle<Radiance>& image);
    void addImage(const graph::Handle<Radiance>& image, graph::Handle<Radiance>& sum);
    void addOwn(WaveTerm& term, const TermMeans& means, graph::Handle<Radiance>& radiance, bool unlessAnalysed);
    /// own: blurs of the pixels.
    void addFiltered(WaveTerm& term, const FilteredTerm& filtered, const Blurs& own, graph::Handle<Radiance>& radiance);
    /// What filters that are on a term change of the image. filtered, filteredTexture: null where value and texture are
    /// shown as they are.
    void addTermFilters(WaveTerm& term, const FilteredTerm* filtered, const graph::Handle<Texture>* filteredTexture,
        graph::Handle<Radiance>& radiance);
    /// Adds terms to their sums, filtered where the frame is analysed. own: blurs of the pixels, which it declares.
    void filterTerms(Blurs& own);
    void blur(graph::Handle<Radiance>& image);
    /// The image, and its parts where these are apart, through the lens's filter.
    void blurImages();
    graph::Handle<Radiance>& sumOf(WaveTerm& term);

    /// Declares them, for `samples` of a pixel; 0: those that it has, over what there is.
    void blurs(float samples, Blurs& out);
    graph::Argument pixels() const { return f_.rectangle(params()); }
    /// True once the first pass is complete.
    std::function<bool(const graph::Run&)> analysed() const;

    FrameBuilder& f_;
    SampleShape shape_;
    Before before_;
    shared::CameraParams camera_;
    std::shared_ptr<State> state_ = std::make_shared<State>();
    bool lit_;
    std::vector<std::unique_ptr<WaveTerm>> terms_;
    std::size_t direct_ = 0; ///< the first of the terms, of direct light

    PrimaryCounts counts_;
    graph::Handle<Count> hits_; ///< primary samples that met a surface
    /// Least and largest signed radius of the circle of confusion.
    graph::Handle<Pixels> confusion_;
    graph::Handle<Pixels> motion_; ///< mean
    graph::Handle<Pixels> motionSpread_; ///< largest difference from it; lean frames have none, see accumulate.h
    graph::Handle<Squares> emissionSquares_; ///< mean squared luminance of a primary sample's emission
    /// Direct light that is not filtered.
    struct Added {
        Unfiltered of;
        graph::Handle<Radiance> radiance;
        graph::Handle<Squares> squares;
    };
    std::vector<Added> added_;
    graph::Handle<Demand> demand_; ///< of primary samples
    graph::Handle<Uncertainty> uncertainty_; ///< likewise, of each pixel's own
    graph::Handle<Radiance> emission_, plain_;
    std::optional<graph::Handle<Radiance>> seenLights_;
    graph::Handle<Pixels> lens_, along_;
};

} // namespace wedge::render
