#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

/// What the program says. A terminal that closed, a pipe that nobody reads or a full disk never ends the program: what
/// cannot be said is lost, and a command whose result is what it says asks requireSaid() at its end.
namespace wedge::app {

/// Call first of all: no later file gets the number of a standard stream that was closed when the program started, and
/// writes that fail (into a pipe without a reader, beyond a file size limit) are failures and no signals.
void prepareProcess();

/// Writes the text as it is and does not throw.
void put(std::FILE* stream, std::string_view text);

/// To stdout.
template <class... Args>
void say(fmt::format_string<Args...> format, Args&&... args)
{
    put(stdout, fmt::format(format, std::forward<Args>(args)...));
}

/// A line of a warning or an error on stderr, printable and of at most 400 bytes, behind what was said before.
void warn(std::string_view text);
void complain(std::string_view text);

/// What there is to warn of in a scene, which has at most ten of a kind.
void warnOf(const std::vector<std::string>& warnings);

/// Throws Error if anything that went to stdout did not arrive.
void requireSaid();

/// Several failures, a line each.
class Errors : public std::exception {
public:
    explicit Errors(std::vector<std::string> all)
        : lines(std::move(all))
    {
    }
    const char* what() const noexcept override { return "several errors"; }

    std::vector<std::string> lines;
};

} // namespace wedge::app
