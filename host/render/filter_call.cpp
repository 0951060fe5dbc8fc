#include "host/render/filter_call.h"

#include "host/error.h"
#include "host/render/filter_chain.h"
#include "host/scene/nearest.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::render {
namespace {

/// All that are known, and first the one that is probably meant.
std::string remedy(const std::string& word, const std::set<std::string>& known)
{
    const std::string near = scene::nearest(word, known);
    return near.empty() ? fmt::format("choose among: {}", fmt::join(known, ", "))
                        : fmt::format("write {}; there are: {}", near, fmt::join(known, ", "));
}

template <class List, class NameOf>
std::set<std::string> namesOf(const List& list, const NameOf& nameOf)
{
    std::set<std::string> names;
    std::ranges::transform(list, std::inserter(names, names.end()), nameOf);
    return names;
}

std::vector<std::string> parts(const std::string& text, char separator)
{
    std::vector<std::string> out;
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t end = std::min(text.find(separator, begin), text.size());
        out.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return out;
}

/// what: whose value it is
float valueOf(const std::string& what, const FilterParameter& parameter, const std::string& text)
{
    double value = 0;
    std::int64_t whole = 0;
    const char* end = text.data() + text.size();
    const auto read =
        parameter.whole ? std::from_chars(text.data(), end, whole) : std::from_chars(text.data(), end, value);
    value = parameter.whole ? static_cast<double>(whole) : value;
    const bool number =
        read.ec == std::errc() && read.ptr == end && value >= parameter.least && value <= parameter.most;
    if (!number) {
        throw UsageError(what, text.empty() ? "(empty)" : text,
            fmt::format(
                "give a {}number from {:g} to {:g}", parameter.whole ? "whole " : "", parameter.least, parameter.most));
    }
    return static_cast<float>(value);
}

/// What a filter is on, of "direct+indirect".
std::vector<std::string> targetsIn(const std::string& call, const Filter& filter, const std::string& text)
{
    std::vector<std::string> on = parts(text, '+');
    const std::vector<std::string> known = targetsOf(filter);
    for (const std::string& target : on) {
        if (std::ranges::find(known, target) == known.end()) {
            throw UsageError(
                fmt::format("filter {} cannot be on {}", filter.name(), target.empty() ? "(empty)" : target), call,
                remedy(target, { known.begin(), known.end() }));
        }
    }
    if (const std::string wrong = wrongTargets(filter, on); !wrong.empty()) {
        throw UsageError(fmt::format("filter {} is {}", filter.name(), wrong), call, "leave one out");
    }
    return on;
}

} // namespace

ChosenFilter filterCall(const std::string& option, const std::string& text)
{
    const std::size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    const Filter* filter = filterNamed(name);
    if (filter == nullptr) {
        const bool several = name.find(',') != std::string::npos;
        throw UsageError(several ? "filters are given one by one" : "unknown filter",
            fmt::format("{} {}", option, text),
            several ? fmt::format("give {} once for each", option)
                    : remedy(name, namesOf(registeredFilters(), [](const auto& each) { return each->name(); })));
    }
    const std::vector<FilterParameter> parameters = filter->parameters();
    ChosenFilter chosen { .name = name, .values = {} };
    std::ranges::transform(parameters, std::back_inserter(chosen.values), &FilterParameter::standard);
    std::set<std::string> given;
    const std::string call = fmt::format("{} {}", option, text);
    const std::string example =
        fmt::format("write {}:{}={:g}", name, parameters.front().name, parameters.front().standard);
    const bool any = colon != std::string::npos;
    for (const std::string& part : any ? parts(text.substr(colon + 1), ',') : std::vector<std::string> {}) {
        const std::size_t equals = part.find('=');
        const std::string key = part.substr(0, equals);
        if (key.empty()) {
            throw UsageError("filter parameter has no name", call, example);
        }
        const bool names = key == filterTargets;
        const auto found = std::ranges::find(parameters, key, &FilterParameter::name);
        if (found == parameters.end() && !names) {
            std::set<std::string> known = namesOf(parameters, [](const FilterParameter& each) { return each.name; });
            known.insert(filterTargets);
            throw UsageError(fmt::format("unknown parameter of filter {}: {}", name, key), call, remedy(key, known));
        }
        if (equals == std::string::npos) {
            throw UsageError("filter parameter has no value: " + key, call,
                names ? fmt::format("write {}:{}={}", name, key, targetsOf(*filter).front()) : example);
        }
        if (!given.insert(key).second) {
            throw UsageError("filter parameter is given twice: " + key, call, "leave one out");
        }
        if (names) {
            chosen.on = targetsIn(call, *filter, part.substr(equals + 1));
            continue;
        }
        chosen.values[static_cast<std::size_t>(found - parameters.begin())] =
            valueOf(fmt::format("{} {}:{}", option, name, key), *found, part.substr(equals + 1));
    }
    return chosen;
}

std::string filterList()
{
    std::string out;
    const Filter* before = nullptr;
    for (const auto& filter : registeredFilters()) {
        if (before == nullptr || before->stage() != filter->stage()) {
            out += filter->stage() == Stage::Samples
                ? "\nFilters of samples of indirect light, and their parameters; a frame has one at most:\n"
                : "\nFilters of the image, or of what on=A+B says, and their parameters:\n";
            out += fmt::format("  on: {}\n", fmt::join(targetsOf(*filter), ", "));
        }
        before = filter.get();
        const bool few = filter->stage() == Stage::Samples && !static_cast<const SampleFilter&>(*filter).kernelOfBins();
        out += fmt::format("  {:<17} {}{}\n", filter->name(), filter->meaning(),
            few ? "; not antialiased, through a lens or shutter, or progressive" : "");
        for (const FilterParameter& each : filter->parameters()) {
            out += fmt::format("    {:<15} {:g} to {:g}, default {:g}: {}\n", each.name, each.least, each.most,
                each.standard, each.meaning);
        }
    }
    return out;
}

} // namespace wedge::render
