#pragma once

#include "host/graph/execution.h"
#include "host/render/effect.h"
#include "host/render/frame_builder.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace wedge::render {

/// Of what a frame sums up the image, and what it cost.
Totals imageOf(const Totals& totals);

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
    /// Whether widths() are to be read.
    bool wantsWidths() const { return wantsWidths_; }

    /// What is to be read of a run.
    std::unique_ptr<Frame> outputs(const graph::Execution& execution) const;

    /// frameTerms() and frameUnfiltered() of it.
    const std::vector<Term>& terms() const { return terms_; }
    const std::vector<UnfilteredOf>& unfiltered() const { return unfiltered_; }
    /// Of all terms and unfiltered light, as Term has it, and of camera rays.
    double workUnits() const;

    /// Of one of terms() each, in their order.
    struct TermWidths {
        std::shared_ptr<TermState> state;
        graph::Handle<Metres> beta; ///< wanted only of layers
    };
    const std::vector<TermWidths>& widths() const { return widths_; }

protected:
    FrameGraph(const Settings& settings, const PreparedScene& scene, bool keepLayers);

    /// What is shown; handles that are of no graph are not.
    struct Shown {
        Surfaces surfaces;
        Totals totals;
        graph::Handle<Count> primaryTaken;
        graph::Handle<Pixels> lensWidth, motionWidth, motion;
        std::map<std::string, graph::Handle<Radiance>> unfiltered; ///< by effects' layers
        std::map<std::string, graph::Handle<Value>> termLayers = {}; ///< by names of layers and terms
    };
    /// Wants all that is shown, and the widths of terms that are analysed if layers are kept.
    void show(const Shown& shown, bool distributed, bool analysed);

    Settings settings_;
    bool keepsLayers_;
    graph::Graph graph_;
    std::vector<Term> terms_;
    std::vector<UnfilteredOf> unfiltered_;
    std::vector<TermWidths> widths_;

private:
    Shown shown_;
    bool distributed_ = false, wantsWidths_ = false;
};

} // namespace wedge::render
