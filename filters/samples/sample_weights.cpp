// Filters of samples that path density is compared with (kernels/filter/sample_weights.cl, docs/sample-filters.md).
#include "host/render/filter_chain.h"
#include "kernels/shared/sample_filter.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wedge::filters {

using graph::value;
using render::FilterParameter;
using Values = std::vector<float>;

namespace {

FilterParameter exposureParameter()
{
    return { "exposure", 0.0, 1e9, 0.0f, "what radiance is multiplied by first; 0: the frame's median is middle grey" };
}
FilterParameter spreadParameter()
{
    return { "spread", 0.0, 8.0, 0.0f,
        "of the Gaussian by which what is left out goes to its surface, pixels; 0: it is lost" };
}
FilterParameter widestParameter()
{
    return { "widest", 0.0, 32.0, 0.0f,
        "width up to which spread doubles where much is left out, pixels; less than twice spread: it does not" };
}

class Clamp : public render::SampleFilter {
public:
    std::string name() const override { return "clamp"; }
    std::string meaning() const override { return "makes bright samples less bright, and keeps their hue"; }
    std::vector<FilterParameter> parameters() const override
    {
        return { { "level", 1e-3, 1e9, 10.0f, "largest luminance; 1e9: all is kept" }, spreadParameter(),
            exposureParameter(), widestParameter() };
    }
    bool keepsAll(const Values& values) const override { return values[0] >= 1e9f; }
    graph::KernelName kernel() const override { return { "filter/sample_weights.cl", "keepClamped" }; }
    std::optional<graph::KernelName> kernelOfBins() const override
    {
        return graph::KernelName { "filter/sample_weights.cl", "keepBinsClamped" };
    }
    bool losesLight() const override { return true; }
    render::Arguments arguments(const Values& values, bool) const override { return { value("level", values[0]) }; }
    float spread(const Values& values) const override { return values[1]; }
    float widest(const Values& values) const override { return values[3]; }
    float exposure(const Values& values) const override { return values[2]; }
};

class Trim : public render::SampleFilter {
public:
    std::string name() const override { return "trim"; }
    std::string meaning() const override { return "leaves out the brightest and the darkest samples of each pixel"; }
    std::vector<FilterParameter> parameters() const override
    {
        return { { "share", 0.0, 0.5, 0.1f, "of the samples, at either end" }, spreadParameter(), widestParameter() };
    }
    bool keepsAll(const Values& values) const override { return values[0] <= 0.0f; }
    graph::KernelName kernel() const override { return { "filter/sample_weights.cl", "keepTrimmed" }; }
    render::Arguments arguments(const Values& values, bool) const override { return { value("share", values[0]) }; }
    float spread(const Values& values) const override { return values[1]; }
    float widest(const Values& values) const override { return values[2]; }
    float exposure(const Values&) const override { return 1.0f; } // orders of luminances are those of any
};

class MedianOfMeans : public render::SampleFilter {
public:
    std::string name() const override { return "gmon"; }
    std::string meaning() const override { return "median of the means of groups of samples, as far as these differ"; }
    std::vector<FilterParameter> parameters() const override
    {
        return { { "groups", 1.0, WEDGE_MOST_GROUPS, 9.0f, "of samples; 1: all are kept", true }, spreadParameter(),
            widestParameter() };
    }
    bool keepsAll(const Values& values) const override { return values[0] <= 1.0f; }
    graph::KernelName kernel() const override { return { "filter/sample_weights.cl", "keepMedianOfMeans" }; }
    render::Arguments arguments(const Values& values, bool) const override
    {
        return { value("groups", static_cast<std::uint32_t>(values[0])) };
    }
    float spread(const Values& values) const override { return values[1]; }
    float widest(const Values& values) const override { return values[2]; }
    float exposure(const Values&) const override { return 1.0f; }
};

class Reweight : public render::SampleFilter {
public:
    std::string name() const override { return "reweight"; }
    std::string meaning() const override { return "trusts brightness as far as several samples have it"; }
    std::vector<FilterParameter> parameters() const override
    {
        return { { "kappa", 0.0, 1e6, 1.0f, "samples of a brightness that are asked for; 0: all are kept" },
            spreadParameter(), exposureParameter(), widestParameter() };
    }
    bool keepsAll(const Values& values) const override { return values[0] <= 0.0f; }
    graph::KernelName kernel() const override { return { "filter/sample_weights.cl", "keepReweighted" }; }
    std::optional<graph::KernelName> kernelOfBins() const override
    {
        return graph::KernelName { "filter/sample_weights.cl", "keepBinsReweighted" };
    }
    bool losesLight() const override { return true; }
    render::Arguments arguments(const Values& values, bool) const override { return { value("kappa", values[0]) }; }
    float spread(const Values& values) const override { return values[1]; }
    float widest(const Values& values) const override { return values[3]; }
    float exposure(const Values& values) const override { return values[2]; }
};

const bool registered = render::registerFilters<Clamp, Trim, MedianOfMeans, Reweight>();

} // namespace
} // namespace wedge::filters
