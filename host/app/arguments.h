#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace wedge::app {

/// Refuses what the parser would take for something else than it is: values of options that take none, options whose
/// value is empty or the name of the next option, and empty names. Throws UsageError.
/// arguments: the command line's, without the program's name.
void checkArguments(const CLI::App& command, const std::vector<std::string>& arguments);

} // namespace wedge::app
