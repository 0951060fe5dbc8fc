#include "benchmarks/rendering_filters/filter_variants.h"

#include "host/error.h"
#include "host/render/filter_chain.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::benchmark {
namespace {

struct TableRow {
    std::string text;
    int mostSpp = std::numeric_limits<int>::max();
};

/// All that are measured, besides the plain mean. Frames of slow filters with many samples take many minutes: they have
/// a most.
const std::vector<TableRow>& measuredVariants()
{
    static const std::vector<TableRow> all { { densityVariant }, { "path-density:k=50" }, { "path-density:k=200", 64 },
        { "path-density:spread=0" }, { "trim:share=0.01" }, { "trim:share=0.1" }, { "trim:share=0.5" }, { "clamp" },
        { gmonVariant }, { reweightVariant }, { "mad-median" }, { "median" } };
    return all;
}

std::string nameIn(const std::string& text) { return text.substr(0, text.find(':')); }

/// Throws UsageError, where the filter is not there with the names of those that are.
const render::Filter& filterIn(const std::string& text)
{
    const render::Filter* filter = render::filterNamed(nameIn(text));
    if (filter == nullptr) {
        std::vector<std::string> known { plainMean };
        std::ranges::transform(
            render::registeredFilters(), std::back_inserter(known), [](const auto& each) { return each->name(); });
        throw UsageError("unknown filter", text, fmt::format("choose among: {}", fmt::join(known, ", ")));
    }
    return *filter;
}

/// "KEY=VALUE" into the filter's values. Throws UsageError.
void setValue(const std::string& call, const std::string& part, const std::vector<render::FilterParameter>& parameters,
    std::vector<float>& values)
{
    const std::size_t equals = std::min(part.find('='), part.size());
    const auto found = std::ranges::find(parameters, part.substr(0, equals), &render::FilterParameter::name);
    if (found == parameters.end()) {
        std::vector<std::string> names;
        std::ranges::transform(parameters, std::back_inserter(names), &render::FilterParameter::name);
        throw UsageError(
            "unknown parameter of a filter", call, fmt::format("choose among: {}", fmt::join(names, ", ")));
    }
    double value = 0;
    const char *begin = part.data() + std::min(equals + 1, part.size()), *end = part.data() + part.size();
    const auto read = std::from_chars(begin, end, value);
    const bool number = read.ec == std::errc() && read.ptr == end && value >= found->least && value <= found->most;
    if (!number || (found->whole && value != std::floor(value))) {
        throw UsageError(fmt::format("value of a filter's {}", found->name), call,
            fmt::format("give a {}number from {:g} to {:g}", found->whole ? "whole " : "", found->least, found->most));
    }
    values[static_cast<std::size_t>(found - parameters.begin())] = static_cast<float>(value);
}

} // namespace

std::vector<FilterVariant> allVariants(std::vector<std::string>& skipped)
{
    std::vector<FilterVariant> out { variantOf(plainMean) };
    for (const auto& [text, mostSpp] : measuredVariants()) {
        if (render::filterNamed(nameIn(text)) == nullptr) {
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
    if (text == plainMean) {
        return { .text = text, .filters = {} };
    }
    const std::vector<render::FilterParameter> parameters = filterIn(text).parameters();
    render::ChosenFilter chosen { nameIn(text), {} };
    std::ranges::transform(parameters, std::back_inserter(chosen.values), &render::FilterParameter::standard);
    for (std::size_t begin = chosen.name.size(); begin < text.size();) {
        const std::size_t end = std::min(text.find(',', begin + 1), text.size());
        setValue(text, text.substr(begin + 1, end - begin - 1), parameters, chosen.values);
        begin = end;
    }
    return { .text = text, .filters = { chosen } };
}

} // namespace wedge::benchmark
