#include "benchmarks/rendering_filters/filter_variants.h"

#include "host/render/filter_call.h"
#include "host/render/filter_chain.h"

namespace wedge::benchmark {
namespace {

struct TableRow {
    std::string text;
    int mostSpp = std::numeric_limits<int>::max();
};

/// All that are measured, besides the plain mean. Frames of slow filters with many samples take many minutes: they have
/// a most. Clamped light that spreads the wider the more it is: Rushmeier and Ward's filter (1994), but that samples
/// are judged and not pixels.
const std::vector<TableRow>& measuredVariants()
{
    static const std::vector<TableRow> all { { densityVariant }, { "path-density:k=50", 64 },
        { "path-density:k=200", 64 }, { "path-density:spread=0" }, { publishedVariant, 64 },
        { publishedRgbVariant, 64 }, { "path-density:k=200,approximate=1", 64 }, { "trim:share=0.01" },
        { "trim:share=0.1" }, { "trim:share=0.5" }, { "clamp" }, { "clamp:spread=1,widest=8" }, { gmonVariant },
        { reweightVariant }, { "mad-median" }, { "median" } };
    return all;
}

/// Whether its filter is registered, and frames of that kind may have it.
bool isThere(const std::string& text, bool antialiased)
{
    const render::Filter* filter = render::filterNamed(text.substr(0, text.find(':')));
    if (filter == nullptr || !antialiased || filter->stage() != render::Stage::Samples) {
        return filter != nullptr;
    }
    const auto& ofSamples = static_cast<const render::SampleFilter&>(*filter);
    return ofSamples.kernelOfBins() && !ofSamples.comparesRgb(render::filterCall("--variant", text).values);
}

} // namespace

std::vector<FilterVariant> allVariants(bool antialiased, std::vector<std::string>& skipped)
{
    std::vector<FilterVariant> out { variantOf(plainMean) };
    for (const auto& [text, mostSpp] : measuredVariants()) {
        if (!isThere(text, antialiased)) {
            skipped.push_back(text);
        } else {
            out.push_back(variantOf(text));
            out.back().mostSpp = mostSpp;
        }
    }
    return out;
}

FilterVariant variantOf(const std::string& text)
{
    FilterVariant out { .text = text, .filters = {} };
    if (text != plainMean) {
        out.filters.push_back(render::filterCall("--variant", text));
    }
    return out;
}

} // namespace wedge::benchmark
