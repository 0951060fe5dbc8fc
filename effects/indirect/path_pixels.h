#pragma once

#include "effects/indirect/indirect.h"
#include "host/render/filters/filter_graph.h"
#include "host/render/filters/widening.h"
#include "host/render/pixel_term.h"

#include <cstdint>

namespace wedge::render {

/// A component of indirect light, or ambient occlusion, where the pixels are the receivers, thesis chapter 4: distances
/// of reflectors, widths and counts, paths, filter.
class PathPixels : public PixelTerm {
public:
    PathPixels(FrameBuilder& frame, Component component);

private:
    Sampler sampler() override;
    std::uint32_t firstSamples() const override { return firstPathsOf(component_, s_); }
    std::uint32_t mostSamples() const override;
    CountsFrom countsFrom() const override;
    bool keepsParts() const override { return varies(); }
    Target target() const override { return targetOf(component_); }
    void start() override;
    void widths() override;
    Uncertain uncertainty() override;
    void means() override;
    void addPlain() override;
    void addFiltered() override;

    /// Makes fractions of samples, and what they are fractions of a part of the reflectance.
    void unshadowed();
    void correctLobes();
    void deviations();
    void widened();
    graph::Handle<Value> filtered();
    void addSamples();
    void add(const graph::Handle<Value>& shown);
    /// What filters that are on the term change of it.
    void addTermFilters(const graph::Handle<Value>& shown);

    bool isUniform() const { return s_.sampling == Sampling::Uniform || s_.indirect.counts == IndirectCounts::Uniform; }
    /// Whether a pixel's samples are asked how much they vary, for what filters do.
    bool varies() const { return widensHere() || usesFallback(s_); }
    bool byCurvature() const { return isByCurvature(component_, s_); }
    bool widensHere() const { return widens(s_) && !byCurvature(); }
    shared::FilterParams filterParams() const { return pathFilterParams(f_, component_); }
    shared::AnalysisParams countParams() const;
    shared::ReflectorParams reflectorParams() const { return render::reflectorParams(f_, component_); }
    graph::Argument component() const { return graph::value("component", static_cast<std::uint32_t>(component_)); }

    Component component_;
    graph::Handle<Reflectance> reflectance_;
    int vertices_; ///< of a path
    AxisWidths axes_; ///< where they follow from curvatures; beta_ is their mean then
    graph::Handle<Value> irradiance_;
    graph::Handle<Deviation> deviation_;
    graph::Handle<Share> weights_;
    graph::Handle<Value> whole_; ///< of lobes, what they would see if nothing were hidden
};

} // namespace wedge::render
