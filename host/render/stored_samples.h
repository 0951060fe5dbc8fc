#pragma once

#include "host/render/filter_chain.h"
#include "host/render/frame_builder.h"

#include <cstdint>

namespace wedge::render {

/// A term's samples of a frame whose pixels are the receivers, each by itself, for a filter of samples: a band of rows
/// at a time, so that memory does not grow with the height of the image. A band is sampled, and then those pixels are
/// filtered around which all has been: the band before it but for its last rows.
class StoredSamples {
public:
    /// perPixel: samples of a pixel, at most. first: of those the first pass; 0: there is none.
    StoredSamples(FrameBuilder& frame, ChosenSampleFilter chosen, std::uint32_t perPixel, std::uint32_t first);

    /// Others of the same exposure, so many a pixel at most: what is kept of them comes in the place of what is kept of
    /// these.
    StoredSamples ofMore(std::uint32_t perPixel) const;
    /// What is kept is that of `other`.
    void takeKept(const StoredSamples& other);

    /// Declares how the exposure follows from what samples of some pixels add up to (probeCounts()).
    void expose(const graph::Handle<Sums>& ofProbes, const graph::Handle<Count>& takenByProbes);
    /// Whether the exposure is asked for, and not given by the filter's values: then there is nothing to probe.
    bool probed() const { return chosen_.filter->exposure(chosen_.values) == 0.0f; }

    /// Declares body(), which is to sample `rows` of what a launch covers, over all bands, and what is kept of each: as
    /// far as windows go by rows() and slices are loops inside the body.
    template <class Body>
    void eachBand(const Body& body)
    {
        frame_.graph.loop(
            "bands", [count = count_](graph::Run&) { return count; },
            [&] {
                body();
                keep();
            });
    }
    /// Rows to sample in a loop inside the body.
    RowsOf rows() const;

    /// What becomes of samples, and what that is handed.
    graph::Sink sink() const;
    Arguments sunk();
    /// Whether the filter tells how alone samples are.
    bool measuresDensity() const { return chosen_.filter->measuresDensity(); }

    graph::Handle<Count> drawn; ///< samples of pixels, whether they have been filtered or not
    graph::Handle<Sums> sums; ///< of what is kept, as if that were all samples
    graph::Handle<Count> taken; ///< samples of pixels that have been filtered
    graph::Handle<Count> notFinite; ///< those of them that were left out because they are not finite
    graph::Handle<Value> parts; ///< means of a part of those; of no graph: not wanted
    graph::Handle<Radiance> excess; ///< what means lose
    graph::Handle<Share> density; ///< mean isolation; of no graph: not wanted

    /// Declares that what pixels lose goes to others of their surface, where the filter says so.
    void spread();
    /// Declares the means of what is kept: 3 planes.
    void means(graph::Handle<Value>& mean) const;

private:
    /// What memory holds, of so many samples a pixel at most.
    void declareLists();
    void keep();

    FrameBuilder& frame_;
    ChosenSampleFilter chosen_;
    std::uint32_t perPixel_, first_;
    bool replaces_ = false; ///< what there is: not where a band was cut
    int rows_; ///< of a band
    std::size_t count_; ///< bands
    std::uint32_t slots_;
    graph::Handle<Radiance> radiance_;
    graph::Handle<Packed> colours_;
    graph::Handle<Extremes> ranges_;
    graph::Handle<Share> exposure_;
};

} // namespace wedge::render
