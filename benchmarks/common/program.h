#pragma once

#include "host/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <functional>
#include <string>

namespace wedge::benchmark {

/// Parses the command line and calls run(), for the main() of a benchmark. Returns the exit status: what run() returns,
/// 2 for a wrong call and 1 for a failure, after one line on stderr that begins with the parser's name.
inline int runProgram(CLI::App& parser, int argc, char** argv, const std::function<int()>& run)
{
    const auto fail = [&](const std::string& message, int status) {
        std::fflush(stdout);
        fmt::print(stderr, "{}: error: {}\n", parser.get_name(), message);
        return status;
    };
    try {
        parser.parse(argc, argv);
        return run();
    } catch (const CLI::Success& request) {
        return parser.exit(request);
    } catch (const CLI::ParseError& error) {
        return fail(fmt::format("wrong call: {}: see --help", error.what()), 2);
    } catch (const UsageError& error) {
        return fail(error.what(), 2);
    } catch (const Error& error) {
        return fail(error.what(), 1);
    } catch (const std::exception& error) {
        return fail(fmt::format("unexpected failure: {}: this is a fault in wedge, please report it", error.what()), 1);
    }
}

} // namespace wedge::benchmark
