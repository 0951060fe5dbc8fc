#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <toml++/toml.h>

namespace wedge::scene {

/// One table of a scene file, read strictly: every getter checks type and range and notes its key, and finish()
/// rejects the keys that nobody asked for. All messages give file, line and column, the value and the way out.
class TableReader {
public:
    /// name: how messages call the table ("[camera]"). The table and the path must outlive the reader.
    TableReader(const toml::table& table, const std::filesystem::path& file, std::string name);

    bool has(const std::string& key);
    bool isList(const std::string& key);
    bool isTable(const std::string& key);
    bool isBoolean(const std::string& key);
    const std::string& name() const { return name_; }

    // Optional values: nothing when the key is absent, Error when it is there and wrong.
    std::optional<double> number(const std::string& key, double least = -1e30, double most = 1e30);
    std::optional<std::int64_t> integer(const std::string& key, std::int64_t least, std::int64_t most);
    std::optional<bool> boolean(const std::string& key);
    std::optional<std::string> text(const std::string& key);
    std::optional<std::string> choice(const std::string& key, const std::vector<std::string>& choices);
    /// A name or a list of some, in the file's order; empty when the key is absent.
    std::vector<std::string> names(const std::string& key);
    /// The same of these.
    std::vector<std::string> choices(const std::string& key, const std::vector<std::string>& known);
    std::optional<glm::dvec3> vector(const std::string& key);
    /// A point in the scene, with coordinates that the renderer can take.
    std::optional<glm::dvec3> point(const std::string& key);
    /// Three numbers of at least 0, or one for a grey.
    std::optional<glm::vec3> colour(const std::string& key);
    std::optional<std::filesystem::path> path(const std::string& key);
    /// A list of numbers, or of rows of numbers, that many in all.
    std::optional<std::vector<double>> numbers(const std::string& key, std::size_t least, std::size_t most);
    /// A table, or several: [key], [[key]], { ... } or [{ ... }, ...]. Their names are name() + ".key".
    std::vector<TableReader> tables(const std::string& key);
    std::optional<TableReader> table(const std::string& key);
    /// How many tables() gives.
    std::size_t count(const std::string& key);

    /// The value of a getter's answer; Error when the key is absent.
    template <class T>
    T require(const std::string& key, const std::optional<T>& value)
    {
        if (!value)
            missing(key);
        return *value;
    }

    /// Error for the key's value, for rules that go beyond one value.
    [[noreturn]] void fail(
        const std::string& key, const std::string& what, const std::string& value, const std::string& remedy) const;
    /// Error for the whole table.
    [[noreturn]] void failHere(const std::string& what, const std::string& value, const std::string& remedy) const;
    [[noreturn]] void missing(const std::string& key) const;

    /// "scene file a.toml:3:7", of the key's value or else of the table.
    std::string where(const std::string& key) const;

    /// Error for the first key that no getter asked for, with the nearest known key.
    void finish() const;

private:
    const toml::node* find(const std::string& key);
    std::string position(const toml::node& node) const;
    [[noreturn]] void wrongType(const std::string& key, const toml::node& node, const std::string& wanted) const;
    double finite(const std::string& key, const toml::node& node, double least, double most) const;
    void appendNumbers(const std::string& key, const toml::node& node, int depth, std::vector<double>& out) const;

    const toml::table* table_;
    const std::filesystem::path* file_;
    std::string name_;
    std::vector<std::string> known_; ///< few: what the getters were asked for
};

/// Parses a scene file's text. Throws Error with file, line and column for text that is not TOML, or nested too deep.
toml::table parseToml(const std::string& text, const std::filesystem::path& file);

} // namespace wedge::scene
