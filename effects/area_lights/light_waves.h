#pragma once

#include "effects/area_lights/soft_shadows.h"
#include "host/render/wave_term.h"
#include "kernels/shared/light.h"

namespace wedge::render {

/// Direct light of an area light where pixels have several receivers, thesis chapters 3 and 5.
class LightWaves : public WaveTerm {
public:
    LightWaves(FrameBuilder& frame, const SampleShape& shape, const TermLight& light);

    void sample(
        Waves& waves, const Adding& adding, const PrimaryCounts& counts, const graph::Handle<Count>& hits) override;
    void widths() override;
    void publishedWidths(const shared::DistributedParams& params, const graph::Handle<Share>& flags,
        const graph::Handle<Pixels>& confusion) override;
    FilteredTerm filtered(const shared::DistributedParams& params) override;
    graph::Format extremesFormat() const override { return graph::pairs; }
    bool oneExtreme() const override { return shape_.compact; }
    bool shadowsMove() const override { return shape_.geometryMoves; }

private:
    shared::AnalysisParams analysisParams() const;
    shared::SampleParams sampleParams() const;
    graph::Handle<Value> alongShadows(const shared::DistributedParams& params, const graph::Handle<Value>& seen) const;

    std::uint32_t index_;
    shared::AreaLight light_;
    std::uint32_t channels_; ///< of what is seen: diffuse, and where something is specular that, too
};

} // namespace wedge::render
