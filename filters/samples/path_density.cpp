// Path-density outlier rejection (kernels/filter/path_density.cl, docs/sample-filters.md).
#include "host/render/filter_chain.h"
#include "kernels/shared/sample_filter.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wedge::filters {

using graph::value;
using render::FilterParameter;
using Values = std::vector<float>;

namespace {

class PathDensity : public render::SampleFilter {
public:
    std::string name() const override { return "path-density"; }
    std::string meaning() const override { return "leaves out samples that lie alone among those around them"; }
    std::vector<FilterParameter> parameters() const override
    {
        return { { "k", 1.0, WEDGE_MOST_NEAREST, 10.0f, "nearest samples whose mean distance counts", true },
            { "low", 0.0, WEDGE_SAMPLE_REACH, 0.0f,
                "mean distance up to which a sample is kept whole, pixels; 0: 2 with method mc, 3 with aaf" },
            { "high", 0.0, WEDGE_SAMPLE_REACH, 0.0f,
                "mean distance from which it is left out; 0: low + 1; less than low is as low" },
            { "spread", 0.0, 8.0, 3.0f,
                "of the Gaussian by which what is left out goes to its surface, pixels; 0: it is lost" },
            { "exposure", 0.0, 1e9, 0.0f,
                "what radiance is multiplied by before colours are compared; 0: the frame's median is middle grey" },
            { "rgb", 0.0, 1.0, 0.0f, "1: colours are compared as exposed RGB, not as CIELAB", true },
            { "approximate", 0.0, 4.0, 0.0f,
                "epsilon of approximate neighbours: up to 1 + epsilon times as far as the true ones; 0: exact" },
            { "widest", 0.0, 32.0, 12.0f,
                "width up to which spread doubles where much is left out, pixels; less than twice spread: it does "
                "not" } };
    }
    bool keepsAll(const Values& values) const override { return values[1] >= WEDGE_SAMPLE_REACH; }
    graph::KernelName kernel() const override { return { "filter/path_density.cl", "keepByDensity" }; }
    std::optional<graph::KernelName> kernelOfBins() const override
    {
        return graph::KernelName { "filter/path_density.cl", "keepBinsByDensity" };
    }
    std::vector<graph::Argument> arguments(const Values& values, bool filtered) const override
    {
        // What the image's filter smooths anyway is left to it: it loses less than is left out wrongly.
        constexpr float usual = 2.0f, ofFiltered = 3.0f;
        constexpr float least = 1e-6f; // equal thresholds are a step
        const float low = values[1] > 0.0f ? values[1] : filtered ? ofFiltered : usual;
        const float high = values[2] > 0.0f ? values[2] : low + 1.0f;
        return { value("k", static_cast<std::uint32_t>(values[0])), value("low", low),
            value("high", std::max(high, low + least)), value("stretch", 1.0f + values[6]) };
    }
    bool comparesRgb(const Values& values) const override { return values[5] > 0.0f; }
    bool measuresDensity() const override { return true; }
    float spread(const Values& values) const override { return values[3]; }
    float widest(const Values& values) const override { return values[7]; }
    float exposure(const Values& values) const override { return values[4]; }
};

const bool registered = render::registerFilters<PathDensity>();

} // namespace
} // namespace wedge::filters
