#include "host/render/filter_chain.h"

#include "host/error.h"
#include "host/render/effect.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

/// Whether what is chosen is on that.
bool isOn(const ChosenFilter& chosen, const std::string& target)
{
    if (!chosen.on.empty()) {
        return std::ranges::find(chosen.on, target) != chosen.on.end();
    }
    return target == (filterOf(chosen).stage() == Stage::Samples ? targets::indirect : targets::image);
}

/// Stage of a filter of images on that.
Stage stageOn(const std::string& target)
{
    return target == targets::image                                ? Stage::Image
        : target == targets::direct || target == targets::indirect ? Stage::Frame
                                                                   : Stage::Terms;
}

const char* nameOf(Stage stage)
{
    switch (stage) {
    case Stage::Samples:
        return "samples";
    case Stage::Terms:
        return "a term";
    case Stage::Frame:
        return "direct or indirect light";
    case Stage::Image:
        break;
    }
    return "the image";
}

std::string namesOf(const std::vector<std::string>& on) { return fmt::format("{}", fmt::join(on, "+")); }

/// Its name and what it is on, without values.
std::string shortly(const ChosenFilter& chosen)
{
    return chosen.on.empty() ? chosen.name : fmt::format("{}:{}={}", chosen.name, filterTargets, namesOf(chosen.on));
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

} // namespace

Stage stageOf(const ChosenFilter& chosen)
{
    const Stage usual = filterOf(chosen).stage();
    return usual == Stage::Samples || chosen.on.empty() ? usual : stageOn(chosen.on.front());
}

bool hasStage(const std::vector<ChosenFilter>& filters, Stage stage)
{
    return std::ranges::any_of(filters, [&](const ChosenFilter& chosen) { return stageOf(chosen) == stage; });
}

const std::vector<std::unique_ptr<const Filter>>& registeredFilters() { return registered(); }

const Filter* filterNamed(const std::string& name)
{
    const auto found = std::ranges::find_if(registered(), [&](const auto& each) { return each->name() == name; });
    return found != registered().end() ? found->get() : nullptr;
}

std::vector<std::string> targetsOf(const Filter& filter)
{
    const bool samples = filter.stage() == Stage::Samples;
    std::vector<std::string> out;
    if (!samples) {
        out = { targets::image, targets::direct };
    }
    out.emplace_back(targets::indirect);
    for (const std::unique_ptr<const Effect>& effect : effects()) {
        for (const Target& target : effect->targets()) {
            if (!samples || target.ofSamples) {
                out.push_back(target.name);
            }
        }
    }
    return out;
}

std::string wrongTargets(const Filter& filter, const std::vector<std::string>& on)
{
    for (std::size_t i = 0; i < on.size(); ++i) {
        if (std::find(on.begin(), on.begin() + static_cast<std::ptrdiff_t>(i), on[i])
            != on.begin() + static_cast<std::ptrdiff_t>(i)) {
            return "twice on " + on[i];
        }
        if (filter.stage() == Stage::Samples && on[i] != on.front()
            && isOn({ filter.name(), {}, on }, targets::indirect)) {
            return fmt::format(
                "on {}, which is part of {}", on[i] == targets::indirect ? on.front() : on[i], targets::indirect);
        }
        if (stageOn(on[i]) != stageOn(on.front())) {
            return fmt::format("on {} and on {}, which come one after the other", on.front(), on[i]);
        }
    }
    return "";
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
        out += chosen.on.empty() ? "" : fmt::format(",{}={}", filterTargets, namesOf(chosen.on));
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
    const std::string first = shortly(before), second = shortly(after);
    return WrongOrder { fmt::format("filter of {} after one of {}", nameOf(stageOf(after)), nameOf(stageOf(before))),
        fmt::format("{0} {1} {0} {2}", call, first, second), fmt::format("give {} before {}", second, first) };
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

ChosenSampleFilter sampleFilterOf(const Settings& settings, const Target& term)
{
    const auto found = std::ranges::find(settings.filters, Stage::Samples, stageOf);
    const bool isOfTerm = term.ofSamples && found != settings.filters.end()
        && (isOn(*found, targets::indirect) || isOn(*found, term.name));
    return isOfTerm ? sampleFilterOf(settings) : ChosenSampleFilter {};
}

bool isFiltered(const Settings& settings, const std::string& target)
{
    return std::ranges::any_of(settings.filters,
        [&](const ChosenFilter& chosen) { return stageOf(chosen) != Stage::Samples && isOn(chosen, target); });
}

graph::Handle<Radiance> filteredImage(FrameBuilder& frame, const std::string& target, graph::Handle<Radiance> image)
{
    for (const ChosenFilter& chosen : frame.settings.filters) {
        if (stageOf(chosen) != Stage::Samples && isOn(chosen, target)) {
            image = static_cast<const ImageFilter&>(filterOf(chosen)).declare(frame, valuesOf(chosen), image);
        }
    }
    return image;
}

} // namespace wedge::render
