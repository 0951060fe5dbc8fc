#include "filters/image/filter_section.h"

#include "host/error.h"
#include "host/render/filter_chain.h"
#include "host/scene/sections.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::filters {

using render::ChosenFilter;

namespace {

const bool registered = [] {
    scene::registerSection({ .key = filterSection, .read = readFilter, .list = true });
    return true;
}();

} // namespace

std::any readFilter(scene::TableReader& table, scene::Warnings& /*warnings*/)
{
    std::vector<std::string> types;
    std::ranges::transform(
        render::registeredFilters(), std::back_inserter(types), [](const auto& filter) { return filter->name(); });
    ChosenFilter chosen { table.require("type", table.choice("type", types)), {} };
    for (const render::FilterParameter& parameter : render::filterNamed(chosen.name)->parameters()) {
        const auto value = [&]() -> std::optional<double> {
            if (!parameter.whole) {
                return table.number(parameter.name, parameter.least, parameter.most);
            }
            const auto whole = table.integer(
                parameter.name, static_cast<std::int64_t>(parameter.least), static_cast<std::int64_t>(parameter.most));
            return whole ? std::optional(static_cast<double>(*whole)) : std::nullopt;
        }();
        chosen.values.push_back(static_cast<float>(value.value_or(parameter.standard)));
    }
    const render::Filter& filter = *render::filterNamed(chosen.name);
    chosen.on = table.choices(render::filterTargets, render::targetsOf(filter));
    if (const std::string wrong = render::wrongTargets(filter, chosen.on); !wrong.empty()) {
        table.fail(render::filterTargets, fmt::format("of filter {} is wrong: it is {}", chosen.name, wrong),
            fmt::format("{}", fmt::join(chosen.on, ", ")), "leave one out");
    }
    const bool enabled = table.boolean("enabled").value_or(true);
    return enabled ? std::optional(std::move(chosen)) : std::optional<ChosenFilter>();
}

std::vector<ChosenFilter> filtersOf(const scene::Scene& scene)
{
    std::vector<ChosenFilter> out;
    const auto found = scene.extensions.find(filterSection);
    if (found == scene.extensions.end()) {
        return out;
    }
    for (const std::any& each : std::any_cast<const std::vector<std::any>&>(found->second)) {
        if (const auto& chosen = std::any_cast<const std::optional<ChosenFilter>&>(each)) {
            out.push_back(*chosen);
        }
    }
    if (const auto wrong = render::wrongOrder(out, "[[filter]]")) {
        throw Error(fmt::format("scene file {}: {}", scene.path, wrong->what), wrong->value, wrong->remedy);
    }
    return out;
}

} // namespace wedge::filters
