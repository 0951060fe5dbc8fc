#include "host/app/arguments.h"

#include "host/error.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace wedge::app {
namespace {

std::string nameIn(const std::string& argument) { return argument.substr(0, argument.find('=')); }

/// The option that the argument names, with a value or without, if any.
const CLI::Option* optionNamed(const CLI::App& command, const std::string& argument)
{
    // Positionals have names, too, which are no options.
    return argument.starts_with('-') ? command.get_option_no_throw(nameIn(argument)) : nullptr;
}

void checkValue(const CLI::App& command, const std::string& name, const std::string& value)
{
    if (value.empty() || value == "--") {
        throw UsageError("option has no value", value.empty() ? name + " (empty)" : name, "give it one value");
    }
    if (value.starts_with("--") || optionNamed(command, value) != nullptr) {
        throw UsageError(fmt::format("option has no value, {} looking like another", value), name,
            fmt::format("give it one value; a file of that name is ./{}", value));
    }
}

void requireNotEmpty(const std::string& argument)
{
    if (argument.empty()) {
        throw UsageError("argument", "(empty)", "give a name, or leave it out");
    }
}

} // namespace

void checkArguments(const CLI::App& command, const std::vector<std::string>& arguments)
{
    const auto end = std::ranges::find(arguments, "--"); // what comes after it is no option
    for (auto at = arguments.begin(); at != end; ++at) {
        const CLI::Option* option = optionNamed(command, *at);
        const std::string name = nameIn(*at);
        const bool hasValue = name != *at;
        if (option == nullptr) {
            requireNotEmpty(*at);
        } else if (option->get_expected_max() == 0) {
            if (hasValue) {
                throw UsageError("option takes no value", *at, fmt::format("give {} alone, or leave it out", name));
            }
        } else if (hasValue && !name.starts_with("--")) {
            throw UsageError("option takes its value without =", *at, fmt::format("give {} VALUE", name));
        } else if (hasValue) {
            checkValue(command, name, at->substr(name.size() + 1));
        } else if (at + 1 != arguments.end()) {
            ++at;
            checkValue(command, name, *at);
        }
    }
    std::for_each(end, arguments.end(), requireNotEmpty);
}

} // namespace wedge::app
