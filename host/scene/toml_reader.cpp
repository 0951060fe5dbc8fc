#include "host/scene/toml_reader.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/error.h"
#include "host/scene/nearest.h"
#include "host/scene/paths.h"
#include "host/scene/toml_limits.h"
#include "host/scene/validate.h"
#include "host/text.h"

namespace wedge::scene {
namespace {

/// A node as it could stand in the file, on one line and not too long.
std::string shown(const toml::node& node)
{
    std::ostringstream out;
    node.visit([&](const auto& n) { out << n; });
    std::string text = out.str();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return shortened(text, 60);
}

/// Whether a list is one of rows, and these are not alike: two or more, of two or more each, so that nothing else is
/// taken for what its numbers add up to.
bool hasUnlikeRows(const toml::array& list)
{
    const auto isRow = [](const toml::node& element) { return element.is_array(); };
    if (std::none_of(list.begin(), list.end(), isRow))
        return false;
    const toml::array* first = list.front().as_array();
    return first == nullptr || list.size() < 2 || first->size() < 2
        || !std::all_of(list.begin(), list.end(), [&](const toml::node& element) {
               return element.is_array() && element.as_array()->size() == first->size();
           });
}

} // namespace

toml::table parseToml(const std::string& text, const std::filesystem::path& file)
{
    checkTomlDepth(text, file);
    try {
        return toml::parse(text, file.string());
    } catch (const toml::parse_error& error) {
        const toml::source_position at = error.source().begin;
        throw Error(fmt::format("scene file {}:{}:{}: not valid TOML", file.string(), at.line, at.column),
            std::string(error.description()), "correct this line");
    }
}

TableReader::TableReader(const toml::table& table, const std::filesystem::path& file, std::string name)
    : table_(&table)
    , file_(&file)
    , name_(std::move(name))
{
}

const toml::node* TableReader::find(const std::string& key)
{
    if (std::find(known_.begin(), known_.end(), key) == known_.end())
        known_.push_back(key);
    return table_->get(key);
}

bool TableReader::has(const std::string& key) { return find(key) != nullptr; }

bool TableReader::isList(const std::string& key)
{
    const toml::node* node = find(key);
    return node != nullptr && node->is_array();
}

bool TableReader::isTable(const std::string& key)
{
    const toml::node* node = find(key);
    return node != nullptr && node->is_table();
}

bool TableReader::isBoolean(const std::string& key)
{
    const toml::node* node = find(key);
    return node != nullptr && node->is_boolean();
}

std::string TableReader::position(const toml::node& node) const
{
    const toml::source_position at = node.source().begin;
    return fmt::format("scene file {}:{}:{}", file_->string(), at.line, at.column);
}

std::string TableReader::where(const std::string& key) const
{
    const toml::node* node = table_->get(key);
    return position(node == nullptr ? *table_ : *node);
}

void TableReader::fail(
    const std::string& key, const std::string& what, const std::string& value, const std::string& remedy) const
{
    throw Error(fmt::format("{}: {} of {} {}", where(key), key, name_, what), value, remedy);
}

void TableReader::failHere(const std::string& what, const std::string& value, const std::string& remedy) const
{
    throw Error(fmt::format("{}: {} {}", position(*table_), name_, what), value, remedy);
}

void TableReader::missing(const std::string& key) const
{
    failHere("lacks a key", key, fmt::format("add '{} = ...'", key));
}

void TableReader::wrongType(const std::string& key, const toml::node& node, const std::string& wanted) const
{
    fail(key, "must be " + wanted, shown(node), fmt::format("give {} as {}", key, wanted));
}

double TableReader::finite(const std::string& key, const toml::node& node, double least, double most) const
{
    const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value)
        wrongType(key, node, "a number");
    if (!std::isfinite(*value))
        fail(key, "is not finite", shown(node), "give a finite number");
    if (*value < least || *value > most)
        fail(key, "is out of range", shown(node), fmt::format("use {:g} to {:g}", least, most));
    return *value;
}

std::optional<double> TableReader::number(const std::string& key, double least, double most)
{
    const toml::node* node = find(key);
    return node == nullptr ? std::nullopt : std::optional(finite(key, *node, least, most));
}

std::optional<std::int64_t> TableReader::integer(const std::string& key, std::int64_t least, std::int64_t most)
{
    const toml::node* node = find(key);
    if (node == nullptr)
        return std::nullopt;
    const std::optional<std::int64_t> value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
    if (!value)
        wrongType(key, *node, "a whole number");
    if (*value < least || *value > most)
        fail(key, "is out of range", shown(*node), fmt::format("use {} to {}", least, most));
    return value;
}

std::optional<bool> TableReader::boolean(const std::string& key)
{
    const toml::node* node = find(key);
    if (node == nullptr)
        return std::nullopt;
    if (!node->is_boolean())
        wrongType(key, *node, "true or false");
    return node->value<bool>();
}

std::optional<std::string> TableReader::text(const std::string& key)
{
    const toml::node* node = find(key);
    if (node == nullptr)
        return std::nullopt;
    if (!node->is_string())
        wrongType(key, *node, "a text in quotes");
    return node->value<std::string>();
}

std::optional<std::string> TableReader::choice(const std::string& key, const std::vector<std::string>& choices)
{
    std::optional<std::string> value = text(key);
    if (value && std::find(choices.begin(), choices.end(), *value) == choices.end())
        fail(key, "is unknown", fmt::format("'{}'", *value), fmt::format("use one of: {}", fmt::join(choices, ", ")));
    return value;
}

std::vector<std::string> TableReader::names(const std::string& key)
{
    const toml::node* node = find(key);
    if (node == nullptr)
        return {};
    std::vector<std::string> out;
    const auto add = [&](const toml::node& element) {
        const auto value = element.value_exact<std::string>();
        if (!value)
            wrongType(key, element, "a name, or a list of names");
        out.push_back(*value);
    };
    if (const toml::array* list = node->as_array()) {
        for (const toml::node& element : *list)
            add(element);
        if (list->empty())
            fail(key, "is empty", "[]", "leave it out, or give a name");
    } else {
        add(*node);
    }
    return out;
}

std::vector<std::string> TableReader::choices(const std::string& key, const std::vector<std::string>& known)
{
    std::vector<std::string> out = names(key);
    for (const std::string& name : out) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            const std::string near = nearest(name, { known.begin(), known.end() });
            fail(key, "is unknown", fmt::format("'{}'", name),
                near.empty() ? fmt::format("use some of: {}", fmt::join(known, ", "))
                             : fmt::format("write '{}'; there are: {}", near, fmt::join(known, ", ")));
        }
    }
    return out;
}

std::optional<std::vector<double>> TableReader::numbers(const std::string& key, std::size_t least, std::size_t most)
{
    const toml::node* node = find(key);
    if (node == nullptr)
        return std::nullopt;
    const std::string wanted =
        least == most ? fmt::format("{} numbers", most) : fmt::format("{} to {} numbers", least, most);
    if (!node->is_array())
        wrongType(key, *node, "a list of " + wanted);
    std::vector<double> values;
    appendNumbers(key, *node, 0, values);
    if (values.size() < least || values.size() > most)
        fail(key, "must have " + wanted, shown(*node), fmt::format("give {} as [..] of {}", key, wanted));
    return values;
}

void TableReader::appendNumbers(
    const std::string& key, const toml::node& node, int depth, std::vector<double>& out) const
{
    if (depth == 0 && hasUnlikeRows(*node.as_array()))
        fail(key, "must be one list of numbers, or several of as many each", shown(node),
            fmt::format("leave out brackets in {}, or fill each list", key));
    for (const toml::node& element : *node.as_array()) {
        if (element.is_array() && depth == 0)
            appendNumbers(key, element, 1, out);
        else
            out.push_back(finite(key, element, -1e30, 1e30));
    }
}

std::optional<glm::dvec3> TableReader::vector(const std::string& key)
{
    const std::optional<std::vector<double>> v = numbers(key, 3, 3);
    return v ? std::optional(glm::dvec3((*v)[0], (*v)[1], (*v)[2])) : std::nullopt;
}

std::optional<glm::dvec3> TableReader::point(const std::string& key)
{
    const std::optional<glm::dvec3> p = vector(key);
    for (int axis = 0; p && axis < 3; ++axis) {
        if (!(std::abs((*p)[axis]) <= maxCoordinate))
            fail(key, "has a coordinate beyond 1e12", fmt::format("{:g}", (*p)[axis]), "scale the scene down");
    }
    return p;
}

std::optional<glm::vec3> TableReader::colour(const std::string& key)
{
    const toml::node* node = find(key);
    if (node == nullptr)
        return std::nullopt;
    const glm::vec3 value =
        node->is_number() ? glm::vec3(static_cast<float>(finite(key, *node, -1e30, 1e30))) : glm::vec3(*vector(key));
    if (value.x < 0.0f || value.y < 0.0f || value.z < 0.0f)
        fail(key, "is negative", shown(*node), "use numbers of at least 0");
    return value;
}

std::optional<std::filesystem::path> TableReader::path(const std::string& key)
{
    const std::optional<std::string> value = text(key);
    if (!value)
        return std::nullopt;
    if (value->empty())
        fail(key, "is empty", "''", "name a file");
    return resolvePath(*value, file_->parent_path(), where(key));
}

std::vector<TableReader> TableReader::tables(const std::string& key)
{
    const toml::node* node = find(key);
    if (node == nullptr)
        return {};
    const std::string name = name_ == "the scene" ? key : fmt::format("{}.{}", name_, key);
    if (const toml::table* one = node->as_table())
        return { TableReader(*one, *file_, name) };
    if (!node->is_array())
        wrongType(key, *node, "a table");
    std::vector<TableReader> readers;
    for (const toml::node& element : *node->as_array()) {
        if (!element.is_table())
            throw Error(fmt::format("{}: entry of {} is not a table", position(element), name), shown(element),
                "write it as { key = value, ... }");
        readers.emplace_back(*element.as_table(), *file_, name);
    }
    return readers;
}

std::size_t TableReader::count(const std::string& key)
{
    const toml::node* node = find(key);
    if (node == nullptr)
        return 0;
    return node->is_array() ? node->as_array()->size() : 1;
}

std::optional<TableReader> TableReader::table(const std::string& key)
{
    const toml::node* node = find(key);
    if (node == nullptr)
        return std::nullopt;
    if (!node->is_table())
        wrongType(key, *node, fmt::format("one table, [{}]", key));
    return tables(key).front();
}

void TableReader::finish() const
{
    for (const auto& [key, node] : *table_) {
        const std::string name(key.str());
        if (std::find(known_.begin(), known_.end(), name) != known_.end())
            continue;
        const std::set<std::string> known(known_.begin(), known_.end());
        const toml::source_position at = key.source().begin;
        const std::string near = nearest(name, known);
        throw Error(fmt::format("scene file {}:{}:{}: unknown key in {}", file_->string(), at.line, at.column, name_),
            fmt::format("'{}'", name),
            near.empty() ? fmt::format("use one of: {}", fmt::join(known, ", "))
                         : fmt::format("did you mean '{}'?", near));
    }
}

} // namespace wedge::scene
