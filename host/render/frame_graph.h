#pragma once

#include "host/graph/execution.h"
#include "host/render/effect.h"
#include "host/render/frame_builder.h"

#include <memory>
#include <string>
#include <vector>

namespace wedge::render {

class DistributedSamples;
class FrameFilter;

/// A frame that is declared, and not run yet: its graph, and what is to be read of it afterwards. The graph's passes
/// refer to this and to what it was made of.
class FrameGraph {
public:
    virtual ~FrameGraph() = default;
    FrameGraph(const FrameGraph&) = delete;
    FrameGraph& operator=(const FrameGraph&) = delete;

    const graph::Graph& graph() const { return graph_; }
    const Settings& settings() const { return settings_; }
    bool keepsLayers() const { return keepsLayers_; }

    /// What is to be read of a run.
    std::unique_ptr<Frame> outputs(const graph::Execution& execution) const;

    /// frameTerms() of it.
    const std::vector<Term>& terms() const { return terms_; }
    /// Of all terms and unfiltered light, as Term has it, and of camera rays.
    double workUnits() const;

protected:
    FrameGraph(const Settings& settings, const PreparedScene& scene, bool keepLayers, bool distributed);

    /// A term's filter widths, in metres and in pixels of that size on the surface: 0 where it is not filtered. beta:
    /// of no graph where no pixel is.
    void showWidths(FrameBuilder& frame, const Term& term, const std::shared_ptr<TermState>& state,
        const graph::Handle<Metres>& beta, const graph::Handle<Metres>& pixelSize);
    /// The same of all terms, where frames are analysed.
    void showWidths(FrameBuilder& frame, const DistributedSamples& samples, const graph::Handle<Metres>& pixelSize);
    /// Whether direct and indirect light, and what is emitted, are outputs of their own: for layers, or filters of
    /// them.
    bool showsParts() const;
    /// Once all of outputs_ are there: filters parts and the beauty as the settings say, wants them, and shows what
    /// statistics are made of, sums over pixels by the names that Renderer::countWork() knows.
    void finish(FrameBuilder& frame);

private:
    void filterParts(FrameBuilder& frame);
    enum class Within { Image, Output, Surfaces }; ///< all pixels, those that are shown, and those that show something
    /// Of an output, a plane of counts, or a list of which all counts.
    void showTally(FrameBuilder& frame, const std::string& name, const std::string& output, Within within);

protected:
    Settings settings_;
    bool keepsLayers_, distributed_;
    PlaneLayout layout_; ///< of its planes
    graph::Graph graph_;
    Outputs outputs_;
    std::vector<Term> terms_;
    std::vector<Unfiltered> unfiltered_;
};

} // namespace wedge::render
