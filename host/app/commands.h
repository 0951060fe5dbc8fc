#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace wedge::app {

/// Does what the command line asked for and returns the exit status. Throws wedge::Error.
using Action = std::function<int()>;

/// Exit statuses, docs/command-line.md.
constexpr int statusFailure = 1;
constexpr int statusWrongCall = 2;
constexpr int statusInterrupted = 130;

// Each adds its subcommand to the parser, which sets `action` when that subcommand is called.
void addRenderCommand(CLI::App& parser, Action& action);
void addCompareCommand(CLI::App& parser, Action& action);
void addDevicesCommand(CLI::App& parser, Action& action);
void addInfoCommand(CLI::App& parser, Action& action);

} // namespace wedge::app
