#include "host/scene/style_section.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "host/scene/validate.h"

namespace wedge::scene {
namespace {

/// Weights of a light's styles add up to 1 within this.
constexpr double weightsOff = 1e-4;

/// One [[light.style]]. several: it has to say what its share is.
ShadowStyle readStyle(TableReader& table, bool several)
{
    ShadowStyle style;
    const auto length = [&](const char* key, double least) {
        return static_cast<float>(table.number(key, least, maxCoordinate).value_or(0.0));
    };
    const std::optional<double> weight = table.number("weight", 0.0, 1.0);
    style.weight = static_cast<float>(several ? table.require("weight", weight) : weight.value_or(1.0));
    style.inflation = length("inflation", -maxCoordinate);
    style.softness = length("softness", 0.0);
    style.abstraction = length("abstraction", 0.0);
    const glm::vec3 left = table.colour("brightness").value_or(glm::vec3(0.0f));
    const float brightest = std::max({ left.x, left.y, left.z });
    if (!(brightest <= 1.0f))
        table.fail("brightness", "is out of range", fmt::format("{:g}", brightest), "use 0 to 1");
    style.brightness = left;
    style.keepArea = table.boolean("keep_area").value_or(style.keepArea);
    table.finish();
    return style;
}

bool changesNothing(const ShadowStyle& style)
{
    const Knob<float> none;
    return style.inflation == none && style.softness == none && style.abstraction == none
        && style.brightness == Knob<glm::vec3>();
}

} // namespace

std::vector<ShadowStyle> readStyles(TableReader& light)
{
    std::vector<TableReader> tables = light.tables("style");
    std::vector<ShadowStyle> styles;
    styles.reserve(tables.size());
    double sum = 0.0;
    for (TableReader& table : tables) {
        styles.push_back(readStyle(table, tables.size() > 1));
        sum += double { styles.back().weight };
    }
    if (!styles.empty() && !(std::abs(sum - 1.0) <= weightsOff))
        light.fail("style", "has weights that do not add up to 1", fmt::format("{:g}", sum),
            "give each its share of the light");
    if (std::ranges::all_of(styles, changesNothing))
        styles.clear();
    return styles;
}

} // namespace wedge::scene
