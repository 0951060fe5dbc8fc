#include "host/render/filter_chain.h"

#include "host/error.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace wedge::render {
namespace {

std::vector<std::unique_ptr<const Filter>>& registered()
{
    static std::vector<std::unique_ptr<const Filter>> all;
    return all;
}

const Filter& filterOf(const ChosenFilter& chosen)
{
    const Filter* filter = filterNamed(chosen.name);
    if (filter == nullptr || filter->parameters().size() < chosen.values.size()) {
        throw std::logic_error("no filter \"" + chosen.name + "\" of so many parameters is registered");
    }
    return *filter;
}

/// Its values, and for parameters that it has none of what they are where nobody says.
std::vector<float> valuesOf(const ChosenFilter& chosen)
{
    std::vector<float> out = chosen.values;
    const std::vector<FilterParameter> parameters = filterOf(chosen).parameters();
    for (std::size_t i = out.size(); i < parameters.size(); ++i) {
        out.push_back(parameters[i].standard);
    }
    return out;
}

Stage stageOf(const ChosenFilter& chosen) { return filterOf(chosen).stage(); }

} // namespace

const std::vector<std::unique_ptr<const Filter>>& registeredFilters() { return registered(); }

const Filter* filterNamed(const std::string& name)
{
    const auto found = std::ranges::find_if(registered(), [&](const auto& each) { return each->name() == name; });
    return found != registered().end() ? found->get() : nullptr;
}

void registerFilter(std::unique_ptr<const Filter> filter)
{
    const auto later = std::ranges::find_if(
        registered(), [&](const std::unique_ptr<const Filter>& each) { return each->stage() > filter->stage(); });
    registered().insert(later, std::move(filter));
}

std::string describe(const std::vector<ChosenFilter>& filters)
{
    std::string out;
    for (const ChosenFilter& chosen : filters) {
        out += (out.empty() ? "" : " ") + chosen.name;
        const std::vector<FilterParameter> parameters = filterOf(chosen).parameters();
        const std::vector<float> values = valuesOf(chosen);
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            out += fmt::format("{}{}={}", i == 0 ? ":" : ",", parameters[i].name, values[i]);
        }
    }
    return out;
}

std::vector<ChosenFilter> inStages(std::vector<ChosenFilter> first, const std::vector<ChosenFilter>& more)
{
    first.insert(first.end(), more.begin(), more.end());
    std::ranges::stable_sort(first, {}, stageOf);
    if (first.size() > 1 && stageOf(first[1]) == Stage::Samples) {
        throw UsageError("two filters of samples", fmt::format("{} and {}", first[0].name, first[1].name),
            "leave one out, a scene's with --no-filters: frames have one");
    }
    return first;
}

std::optional<WrongOrder> wrongOrder(const std::vector<ChosenFilter>& filters, const std::string& call)
{
    const auto wrong = std::ranges::adjacent_find(
        filters, [](const ChosenFilter& a, const ChosenFilter& b) { return stageOf(a) > stageOf(b); });
    if (wrong == filters.end()) {
        return {};
    }
    const ChosenFilter &before = *wrong, &after = *std::next(wrong);
    return WrongOrder { "filter of samples after one of the image",
        fmt::format("{0} {1} {0} {2}", call, before.name, after.name),
        fmt::format("give {} before {}", after.name, before.name) };
}

ChosenSampleFilter sampleFilterOf(const Settings& settings)
{
    for (const ChosenFilter& chosen : settings.filters) {
        if (stageOf(chosen) == Stage::Samples) {
            const auto& filter = static_cast<const SampleFilter&>(filterOf(chosen));
            const std::vector<float> values = valuesOf(chosen);
            return { filter.keepsAll(values) ? nullptr : &filter, values };
        }
    }
    return {};
}

graph::Handle<Radiance> filteredImage(FrameBuilder& frame, graph::Handle<Radiance> image)
{
    for (const ChosenFilter& chosen : frame.settings.filters) {
        if (stageOf(chosen) == Stage::Image) {
            image = static_cast<const ImageFilter&>(filterOf(chosen)).declare(frame, valuesOf(chosen), image);
        }
    }
    return image;
}

} // namespace wedge::render
