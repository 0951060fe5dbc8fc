#include "host/app/filter_calls.h"

#include "host/app/values.h"
#include "host/error.h"
#include "host/render/filter_chain.h"
#include "host/scene/nearest.h"

#include <algorithm>
#include <iterator>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::app {
namespace {

constexpr const char* option = "--add-filter";

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

/// The parts of a text between commas.
std::vector<std::string> parts(const std::string& text)
{
    std::vector<std::string> out;
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        out.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return out;
}

float valueOf(const std::string& filter, const render::FilterParameter& parameter, const std::string& text)
{
    const std::string what = fmt::format("{} {}:{}", option, filter, parameter.name);
    return parameter.whole ? static_cast<float>(wholeNumber(
               what, text, static_cast<std::int64_t>(parameter.least), static_cast<std::int64_t>(parameter.most)))
                           : static_cast<float>(finiteNumber(what, text, parameter.least, parameter.most));
}

} // namespace

render::ChosenFilter filterCall(const std::string& text)
{
    const std::size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    const render::Filter* filter = render::filterNamed(name);
    if (filter == nullptr) {
        const bool several = name.find(',') != std::string::npos;
        throw UsageError(several ? "filters are given one by one" : "unknown filter",
            fmt::format("{} {}", option, text),
            several
                ? fmt::format("give {} once for each", option)
                : remedy(name, namesOf(render::registeredFilters(), [](const auto& each) { return each->name(); })));
    }
    const std::vector<render::FilterParameter> parameters = filter->parameters();
    render::ChosenFilter chosen { name, {} };
    std::ranges::transform(parameters, std::back_inserter(chosen.values), &render::FilterParameter::standard);
    std::set<std::string> given;
    const std::string call = fmt::format("{} {}", option, text);
    const std::string example =
        fmt::format("write {}:{}={:g}", name, parameters.front().name, parameters.front().standard);
    const bool any = colon != std::string::npos;
    for (const std::string& part : any ? parts(text.substr(colon + 1)) : std::vector<std::string> {}) {
        const std::size_t equals = part.find('=');
        const std::string key = part.substr(0, equals);
        if (key.empty()) {
            throw UsageError("filter parameter has no name", call, example);
        }
        const auto found = std::ranges::find(parameters, key, &render::FilterParameter::name);
        if (found == parameters.end()) {
            throw UsageError(fmt::format("unknown parameter of filter {}: {}", name, key), call,
                remedy(key, namesOf(parameters, [](const render::FilterParameter& each) { return each.name; })));
        }
        if (equals == std::string::npos) {
            throw UsageError("filter parameter has no value: " + key, call, example);
        }
        if (!given.insert(key).second) {
            throw UsageError("filter parameter is given twice: " + key, call, "leave one out");
        }
        chosen.values[static_cast<std::size_t>(found - parameters.begin())] =
            valueOf(name, *found, part.substr(equals + 1));
    }
    return chosen;
}

std::string filterList()
{
    std::string out;
    const render::Filter* before = nullptr;
    for (const auto& filter : render::registeredFilters()) {
        if (before == nullptr || before->stage() != filter->stage()) {
            out += filter->stage() == render::Stage::Samples
                ? "\nFilters of samples of indirect light, and their parameters; a frame has one at most:\n"
                : "\nFilters of the image, and their parameters:\n";
        }
        before = filter.get();
        out += fmt::format("  {:<17} {}\n", filter->name(), filter->meaning());
        for (const render::FilterParameter& each : filter->parameters()) {
            out += fmt::format("    {:<15} {:g} to {:g}, default {:g}: {}\n", each.name, each.least, each.most,
                each.standard, each.meaning);
        }
    }
    return out;
}

} // namespace wedge::app
