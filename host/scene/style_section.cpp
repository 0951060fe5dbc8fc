#include "host/scene/style_section.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "host/scene/keyframes.h"
#include "host/scene/nearest.h"
#include "host/scene/object_names.h"
#include "host/scene/validate.h"

namespace wedge::scene {
namespace {

/// Weights of a light's styles add up to 1 within this.
constexpr double weightsOff = 1e-4;

/// The coefficients under the key, constant first: a list of three, or where they may be colours of nine.
std::vector<double> readQuadratic(TableReader& table, const std::string& key, bool colours)
{
    std::vector<double> at;
    for (TableReader& quadratic : table.tables(key)) {
        at = quadratic.require("at", quadratic.numbers("at", 3, colours ? 9 : 3));
        if (at.size() != 3 && at.size() != 9)
            quadratic.fail("at", "must have three numbers or three colours", fmt::format("{} numbers", at.size()),
                "give at as [a, b, c], of a + b d + c d^2, d in metres");
        for (const double coefficient : at) {
            if (!(std::abs(coefficient) <= maxCoordinate))
                quadratic.fail("at", "is out of range", fmt::format("{:g}", coefficient), "use -1e12 to 1e12");
        }
        quadratic.finish();
    }
    return at;
}

/// A length: a number, or { at = [a, b, c] }. Where it is not there, as it was.
Knob<float> readLength(TableReader& table, const std::string& key, double least, const Knob<float>& before)
{
    if (!table.isTable(key)) {
        const std::optional<double> metres = table.number(key, least, maxCoordinate);
        return metres ? Knob<float>(static_cast<float>(*metres)) : before;
    }
    const std::vector<double> at = readQuadratic(table, key, false);
    const Knob<float> knob(static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]));
    if (!knob.varies() && !(at[0] >= least))
        table.fail(key, "is out of range", fmt::format("{:g}", at[0]), fmt::format("use {:g} to 1e12", least));
    return knob;
}

/// What is left of the light: a number or a colour, or such for each coefficient. Where it is not there, as it was.
Knob<glm::vec3> readBrightness(TableReader& table, const Knob<glm::vec3>& before)
{
    Knob<glm::vec3> knob = before;
    if (table.isTable("brightness")) {
        const std::vector<double> at = readQuadratic(table, "brightness", true);
        const auto colour = [&](std::size_t k) {
            return at.size() == 3 ? glm::vec3(glm::dvec3(at[k]))
                                  : glm::vec3(glm::dvec3(at[3 * k], at[3 * k + 1], at[3 * k + 2]));
        };
        knob = { colour(0), colour(1), colour(2) };
    } else if (const std::optional<glm::vec3> colour = table.colour("brightness")) {
        knob = *colour;
    }
    const glm::vec3& left = knob.constant;
    const float least = std::min({ left.x, left.y, left.z }), most = std::max({ left.x, left.y, left.z });
    if (!knob.varies() && !(least >= 0.0f && most <= 1.0f))
        table.fail("brightness", "is out of range", fmt::format("{:g}", least < 0.0f ? least : most), "use 0 to 1");
    return knob;
}

/// Names under the key, each once and in one order, so that lists of the same names are equal.
std::vector<std::string> readNames(TableReader& table, const std::string& key)
{
    std::vector<std::string> names = table.names(key);
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

/// What a table says of knobs; of others it leaves the style's alone.
void readKnobs(TableReader& table, ShadowStyle& style)
{
    style.inflation = readLength(table, "inflation", -maxCoordinate, style.inflation);
    style.softness = readLength(table, "softness", 0.0, style.softness);
    style.abstraction = readLength(table, "abstraction", 0.0, style.abstraction);
    style.brightness = readBrightness(table, style.brightness);
    style.penumbra = static_cast<float>(table.number("penumbra", 0.0, 1.0).value_or(double { style.penumbra }));
}

/// Throws for what a table says that is not of such shadows.
void checkKind(TableReader& table, const ShadowStyle& style, ShadowKind kind)
{
    if (kind == ShadowKind::Hard && table.has("penumbra"))
        table.fail("penumbra", "is of soft shadows, and those of this light are hard",
            fmt::format("{:g}", style.penumbra), "leave it out, or give a quad the style");
    if (kind == ShadowKind::Hard)
        return;
    for (const char* key : { "inflation", "softness", "abstraction", "brightness" }) {
        if (table.isTable(key))
            table.fail(
                key, "goes by what throws the shadow, which soft shadows do not know", "{ at = ... }", "give a number");
    }
    if (!style.casters.empty())
        table.fail("casters", "are of hard shadows, and those of a quad are soft",
            fmt::format("'{}'", style.casters.front()), "leave them out, or choose type point or directional");
}

template <class T>
Knob<T> between(const Knob<T>& a, const Knob<T>& b, double weight)
{
    const auto w = static_cast<float>(weight);
    const auto mixed = [&](T Knob<T>::*part) { return a.*part + (b.*part - a.*part) * w; };
    return { mixed(&Knob<T>::constant), mixed(&Knob<T>::linear), mixed(&Knob<T>::square) };
}

/// Reads a style's keys, [[light.style.key]], and gives it the knobs that it has at that time.
void readKeys(TableReader& table, ShadowStyle& style, ShadowKind kind, double time)
{
    std::vector<double> times;
    std::vector<ShadowStyle> keys;
    for (TableReader& key : table.tables("key")) {
        times.push_back(readKeyTime(key, times));
        readKnobs(key, keys.emplace_back(style));
        checkKind(key, keys.back(), kind);
        key.finish();
    }
    if (keys.empty())
        return;
    const KeySpan span = spanAt(times, time);
    const ShadowStyle &a = keys[span.from], &b = keys[span.to];
    style.inflation = between(a.inflation, b.inflation, span.weight);
    style.softness = between(a.softness, b.softness, span.weight);
    style.abstraction = between(a.abstraction, b.abstraction, span.weight);
    style.brightness = between(a.brightness, b.brightness, span.weight);
    style.penumbra = a.penumbra + (b.penumbra - a.penumbra) * static_cast<float>(span.weight);
    style.keys = std::move(keys);
}

/// One [[light.style]] at that time. several: it has to say what its share is.
ShadowStyle readStyle(TableReader& table, ShadowKind kind, bool several, double time)
{
    ShadowStyle style;
    const std::optional<double> weight = table.number("weight", 0.0, 1.0);
    style.weight = static_cast<float>(several ? table.require("weight", weight) : weight.value_or(1.0));
    style.keepArea = table.boolean("keep_area").value_or(style.keepArea);
    style.casters = readNames(table, "casters");
    style.receivers = readNames(table, "receivers");
    readKnobs(table, style);
    checkKind(table, style, kind);
    readKeys(table, style, kind, time);
    table.finish();
    return style;
}

/// Throws where one of the names under the key is not among those that objects go by.
void checkNames(TableReader& style, const std::string& key, const std::set<std::string>& known)
{
    for (const std::string& name : style.names(key)) {
        if (known.contains(name))
            continue;
        const std::string near = nearest(name, { known.begin(), known.end() });
        style.fail(key, "names no object of the scene", fmt::format("'{}'", name),
            near.empty() ? "wedge info lists the objects" : fmt::format("did you mean '{}'?", near));
    }
}

/// Throws where one object is among the casters of two of a light's lists: it would throw its shadow twice.
void checkCasters(TableReader& light, const std::vector<std::string>& objects)
{
    std::set<std::set<std::string>> lists;
    for (TableReader& style : light.tables("style")) {
        const std::vector<std::string> casters = readNames(style, "casters");
        if (!casters.empty())
            lists.emplace(casters.begin(), casters.end());
    }
    if (lists.size() < 2)
        return;
    for (const std::string& object : objects) {
        if (std::ranges::count_if(lists, [&](const auto& list) { return isCalledOneOf(object, list); }) > 1)
            light.fail("style", "has an object among the casters of two lists", fmt::format("'{}'", object),
                "name it in one of them, or give the styles the same casters");
    }
}

bool changesNothing(const ShadowStyle& style)
{
    const Knob<float> none;
    return style.keys.empty() && style.inflation == none && style.softness == none && style.abstraction == none
        && style.brightness == Knob<glm::vec3>() && style.penumbra == 1.0f;
}

} // namespace

std::vector<ShadowStyle> readStyles(TableReader& light, ShadowKind kind, double time)
{
    std::vector<TableReader> tables = light.tables("style");
    std::map<std::vector<std::string>, double> weights; // of those with the same casters
    std::map<std::vector<std::string>, int> count;
    for (TableReader& table : tables)
        ++count[readNames(table, "casters")];
    std::vector<ShadowStyle> styles;
    styles.reserve(tables.size());
    for (TableReader& table : tables) {
        const ShadowStyle& style =
            styles.emplace_back(readStyle(table, kind, count[readNames(table, "casters")] > 1, time));
        weights[style.casters] += double { style.weight };
    }
    for (const auto& [casters, sum] : weights) {
        if (!(std::abs(sum - 1.0) <= weightsOff))
            light.fail("style", "has weights that do not add up to 1", fmt::format("{:g}", sum),
                "give each of those with the same casters its share of the light");
    }
    if (std::ranges::all_of(styles, changesNothing))
        styles.clear();
    return styles;
}

void checkObjectNames(TableReader& root, const Geometry& geometry)
{
    std::optional<std::set<std::string>> known; // there may be millions
    for (TableReader& light : root.tables("light")) {
        for (TableReader& style : light.tables("style")) {
            for (const char* key : { "casters", "receivers" }) {
                if (!known && !style.names(key).empty())
                    known = allNames(geometry.objectNames);
                if (known)
                    checkNames(style, key, *known);
            }
        }
        checkCasters(light, geometry.objectNames);
    }
}

} // namespace wedge::scene
