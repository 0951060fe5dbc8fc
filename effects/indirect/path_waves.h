#pragma once

#include "effects/indirect/indirect.h"
#include "host/render/wave_term.h"

namespace wedge::render {

/// A component of indirect light, or ambient occlusion, where pixels have several receivers, thesis chapters 4 and 5.
class PathWaves : public WaveTerm {
public:
    PathWaves(FrameBuilder& frame, const SampleShape& shape, Component component);

    void sample(
        Waves& waves, const Adding& adding, const PrimaryCounts& counts, const graph::Handle<Count>& hits) override;
    Target target() const override { return targetOf(component_); }
    graph::Handle<Sums> probe(Waves& waves, const PrimaryCounts& counts) override;
    void widths() override;
    std::uint32_t publishedSamples() const override;
    void publishedWidths(const shared::DistributedParams& params, const graph::Handle<Share>& flags,
        const graph::Handle<Pixels>& confusion) override;
    FilteredTerm filtered(const shared::DistributedParams& params) override;
    graph::Format extremesFormat() const override { return shape_.compact ? shortReflectors : graph::vectors; }
    bool oneExtreme() const override { return shape_.lean(); }

private:
    shared::PathParams pathParams() const;
    /// Samples of a wave's receivers.
    Shared samplePaths(Waves& waves, const Adding& adding, const PrimaryCounts& counts) const;

    Component component_;
};

} // namespace wedge::render
