#pragma once

#include "host/render/filters/filter_graph.h"
#include "host/render/frame_builder.h"
#include "host/render/receiver_set.h"
#include "host/render/stored_samples.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace wedge::render {

/// A term of a frame whose pixels are the receivers: what an effect declares for it. All have the same stages in the
/// same order, of which declare() is the list. Where the frame is not analysed there are sample() and addPlain() alone.
class PixelTerm {
public:
    virtual ~PixelTerm() = default;
    PixelTerm(const PixelTerm&) = delete;
    PixelTerm& operator=(const PixelTerm&) = delete;

    /// Declares samples of the analysis, widths and counts, the rest of the samples, the filter, and what is added to
    /// the frame's sums.
    void declare();

    /// Filled in while the graph runs.
    const std::shared_ptr<TermState>& state() const { return state_; }
    /// Widths of the filter, metres, which are written where the state says that it is analysed.
    const graph::Handle<Metres>& beta() const { return beta_; }
    /// Of terms whose samples a filter has gone over, and layers: what their means lost, and their mean isolation; else
    /// of no graph.
    const graph::Handle<Radiance>& rejected() const { return rejected_; }
    const graph::Handle<Share>& density() const { return density_; }

protected:
    /// What its stages and its passes of samples are called.
    struct Names {
        std::string stages, plain, first, rest;
    };
    /// Numbers that are kept of the samples: of their sums, of their mean and of what the analysis asks for; and the
    /// format of the mean of a part of them.
    struct Kept {
        std::uint32_t sums, values, extremes;
        graph::Format part;
    };
    /// The kernel that takes samples.
    struct Sampler {
        graph::KernelName kernel; ///< its sinks are to come
        Arguments arguments; ///< up to the counts of samples
        Arguments rays; ///< tallies
        graph::Sink measures; ///< what the analysis asks for: extremes
        const char* measured; ///< their name in the kernel
        std::uint32_t slice; ///< samples of a pixel between two looks at the cancel flag
        double workUnits; ///< of a sample
    };
    /// What counts of the samples after the first follow from; Nothing: there are none.
    enum class CountsFrom { Nothing, Mean, Variance, Spectrum };
    /// How well a pixel's value is known after the first samples, and who has a part in what it asks for.
    struct Uncertain {
        graph::Handle<Uncertainty> uncertainty;
        shared::AnalysisParams params;
        Demanding demanding;
    };

    /// sum: what it is part of.
    PixelTerm(FrameBuilder& frame, Names names, Sum& sum, const Kept& kept);

    virtual Sampler sampler() = 0;
    virtual std::uint32_t firstSamples() const = 0; ///< of the analysis, of each pixel that has the term
    virtual std::uint32_t mostSamples() const = 0; ///< of a pixel
    virtual CountsFrom countsFrom() const = 0;
    /// Whether samples leave the mean of a part of them, and means() makes that of all; else they leave the latter.
    virtual bool keepsParts() const = 0;
    /// What filters can be on it by (filter_chain.h).
    virtual Target target() const { return {}; }
    /// The settings' filter of samples that is on it.
    ChosenSampleFilter sampleFilter() const;
    /// Adds what else becomes of samples, and what that is handed.
    virtual void keepMore(std::vector<graph::Sink>& /*sinks*/, Arguments& /*sunk*/) { }

    /// What is there before any sample is, besides what samples are added to.
    virtual void start() { }
    /// beta_; and wanted_, where counts follow from the spectrum.
    virtual void widths() = 0;
    virtual Uncertain uncertainty() = 0;
    /// Pixels where it is 0 want no more samples.
    virtual graph::Version mask() const { return taken_; }
    /// value_, what samples are filtered as.
    virtual void means() = 0;
    /// Adds that to both images of the sum, as it is, or filtered and not.
    virtual void addPlain() = 0;
    virtual void addFiltered() = 0;

    /// True once the first samples are complete.
    std::function<bool(const graph::Run&)> analysed() const;

    FrameBuilder& f_;
    graph::Graph& g_;
    const Settings& s_;
    Sum& sum_;
    PixelReceivers pixels_;
    graph::Handle<Metres> beta_;
    graph::Handle<Sums> sums_;
    graph::Handle<Value> value_, parts_;
    graph::Handle<Extremes> extremes_;
    graph::Handle<Count> taken_, wanted_;

private:
    /// Samples `from` up to `most`, as far as pixels want them; mean: of what they want.
    struct Draw {
        const std::string& pass;
        std::uint32_t from, most;
        double mean;
        bool measures = false; ///< what the analysis asks for
        bool everywhere = false; ///< in the whole image
    };

    void plain();
    /// The samples of the analysis in the whole image, and then those that it asks for.
    void sampleInPasses();
    Draw firstPass() const;
    Draw secondPass() const;
    /// Says in the state whether the samples of the analysis are complete.
    void analysable();
    /// Takes samples for what terms without filters of samples keep.
    void sample(const Draw& draw);
    /// Takes samples for those sinks, which are handed `sunk`; taken: what counts them.
    void sample(const Draw& draw, const graph::Handle<Count>& wanted, graph::Handle<Count>& taken,
        std::vector<graph::Sink> becoming, Arguments sunk);
    /// All samples, through the filter of samples: those of the analysis; and where counts follow from what is kept of
    /// them, these once more with all others.
    void filterSamples();
    /// Samples up to `most`, band by band. measures: those of the analysis among them.
    void sampleBands(StoredSamples& stored, std::uint32_t most, bool measures);
    void exposeSamples(StoredSamples& stored);
    void counts();
    void countSamples();

    Names names_;
    graph::Handle<Radiance> rejected_;
    graph::Handle<Share> density_;
    std::shared_ptr<TermState> state_ = std::make_shared<TermState>();
};

} // namespace wedge::render
