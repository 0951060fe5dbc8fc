#pragma once

#include <filesystem>
#include <string_view>

namespace wedge::scene {

/// A scene file nests no deeper: parts of a dotted key or header, and brackets in brackets. The library that parses it
/// recurses for each, and a stack ends.
constexpr int mostKeyParts = 16, mostBrackets = 16;

/// Looks through a TOML text without understanding it. Throws Error with file, line and column where it nests deeper.
void checkTomlDepth(std::string_view text, const std::filesystem::path& file);

} // namespace wedge::scene
