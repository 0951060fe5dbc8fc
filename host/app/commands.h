#pragma once

#include <functional>
#include <optional>
#include <string>

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

/// Where this program is; "" where that cannot be told.
std::string ownProgram();
/// What wedge does for another wedge that compiles kernels: "compile-kernels" and a file's number, see
/// render::compileSideBySide(). Not for people. Nothing if the call is another.
std::optional<int> compileForOther(int argc, char** argv);

// Each adds its subcommand to the parser, which sets `action` when that subcommand is called.
void addRenderCommand(CLI::App& parser, Action& action);
void addCompareCommand(CLI::App& parser, Action& action);
void addDevicesCommand(CLI::App& parser, Action& action);
void addInfoCommand(CLI::App& parser, Action& action);

} // namespace wedge::app
