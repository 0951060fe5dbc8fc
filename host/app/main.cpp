// The program: parse the command line, run the command, turn whatever goes wrong into one line and an exit status.
#include "host/app/arguments.h"
#include "host/app/commands.h"
#include "host/app/console.h"
#include "host/app/interrupt.h"
#include "host/error.h"
#include "host/files_opened.h"
#include "host/render/metadata.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <new>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace wedge;
using namespace wedge::app;

constexpr const char* outOfMemory = "host memory: exhausted: render a smaller image or a smaller scene";
constexpr const char* commandList = "name one: render, compare, devices, info";

/// The command that is named, or else the program itself.
const CLI::App& commandOf(const CLI::App& parser, int argc, char** argv)
{
    const auto isNamed = [&](const CLI::App* command) { return argc > 1 && command->get_name() == argv[1]; };
    const std::vector<const CLI::App*> named = parser.get_subcommands(isNamed);
    return named.empty() ? parser : *named.front();
}

/// "see wedge render --help", or of wedge itself where no command was named.
std::string hint(const CLI::App& parser, int argc, char** argv)
{
    const CLI::App& command = commandOf(parser, argc, argv);
    return fmt::format("see wedge {}--help", &command == &parser ? "" : command.get_name() + " ");
}

/// The first argument of a wrong call that nobody expected.
std::string firstExtra(const CLI::App& parser)
{
    const std::vector<std::string> extras = parser.remaining(true);
    const auto first = std::ranges::find_if(extras, [](const std::string& extra) { return extra != "--"; });
    return first == extras.end() ? "" : *first;
}

/// The parser's complaint in the form of all errors. Its messages begin with the option's name.
UsageError usageError(const CLI::App& parser, const CLI::ParseError& error)
{
    const std::string text = error.what();
    const std::string name = text.substr(0, text.find_first_of(": "));
    if (const std::string extra = firstExtra(parser); !extra.empty()) {
        if (extra[0] == '-') {
            return { "unknown option", extra, "leave it out or correct it" };
        }
        const bool isCommand = parser.get_subcommands().empty();
        return isCommand ? UsageError("unknown command", extra, commandList)
                         : UsageError("unexpected argument", extra, "leave it out");
    }
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        return { "argument is missing", name, "give it" };
    }
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
        return { "option has no value or too many", name, "give it one value" };
    }
    return { "wrong call", text, "correct it" };
}

int fail(std::string_view message, int status)
{
    complain(message);
    return status;
}

/// What --help and --version print is their result.
int answer(const CLI::App& parser, const CLI::Success& request)
{
    std::ostringstream text;
    const int status = parser.exit(request, text, text);
    put(stdout, text.str());
    requireSaid();
    return status;
}

int runCommand(CLI::App& parser, Action& action, int argc, char** argv)
{
    try {
        checkArguments(commandOf(parser, argc, argv), { argv + std::min(argc, 1), argv + argc });
        try {
            parser.parse(argc, argv);
        } catch (const CLI::Success& request) {
            return answer(parser, request);
        } catch (const CLI::ParseError& error) {
            throw usageError(parser, error);
        }
        if (!action) {
            throw UsageError("command", "none given", commandList);
        }
        return action();
    } catch (const UsageError& error) {
        return fail(fmt::format("{}; {}", error.what(), hint(parser, argc, argv)), statusWrongCall);
    }
}

/// Says what was thrown; call where it is caught. Returns the exit status.
int failed()
{
    try {
        throw;
    } catch (const Error& error) {
        return fail(error.what(), statusFailure);
    } catch (const Errors& errors) {
        std::ranges::for_each(errors.lines, complain);
        return statusFailure;
    } catch (const std::bad_alloc&) {
        return fail(outOfMemory, statusFailure);
    } catch (const std::length_error&) { // a size that no memory could hold
        return fail(outOfMemory, statusFailure);
    } catch (const std::filesystem::filesystem_error& error) {
        return fail(message("file system", error.what(), "check the name and the permissions"), statusFailure);
    } catch (const std::system_error& error) { // no more threads, memory or files for this process
        return fail(
            message("the system refuses", error.what(), "give the process more, or render less"), statusFailure);
    } catch (const std::exception& error) {
        return fail(
            message("unexpected failure", error.what(), "this is a fault in wedge, please report it"), statusFailure);
    } catch (...) {
        return fail("unexpected failure: unknown: this is a fault in wedge, please report it", statusFailure);
    }
}

} // namespace

int main(int argc, char** argv)
{
    prepareProcess();
    keepIgnoring();
    const FilesOpened inputs; // from the start, so that no output is one of them, whatever reads them
    try {
        if (const std::optional<int> status = compileForOther(argc, argv)) {
            return *status;
        }
        CLI::App parser(
            "wedge renders soft shadows and indirect light from few samples, on any OpenCL device.", "wedge");
        parser.set_version_flag("--version", std::string("wedge ") + render::version());
        parser.get_formatter()->column_width(32);
        parser.require_subcommand(0, 1); // of more than one the last would be taken for all
        Action action;
        addRenderCommand(parser, action);
        addCompareCommand(parser, action);
        addDevicesCommand(parser, action);
        addInfoCommand(parser, action);
        return runCommand(parser, action, argc, argv);
    } catch (...) {
        return failed();
    }
}
