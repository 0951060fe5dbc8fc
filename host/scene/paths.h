#pragma once

#include <filesystem>
#include <string>

#include "host/file.h"

namespace wedge::scene {

/// text with every ${NAME} replaced by that environment variable. Throws Error where one is unset, a brace is
/// missing or it gets longer than a path may be; `where` ("scene file a.toml:3:8") begins its message.
std::string expandVariables(const std::string& text, const std::string& where);

/// Expands variables, turns backslashes into slashes and makes the path relative to `folder` where it is not absolute.
/// Throws Error also where there is a zero byte, at which the system would end the name.
std::filesystem::path resolvePath(
    const std::string& text, const std::filesystem::path& folder, const std::string& where);

/// The file's extension in lower case, with its dot.
std::string lowerExtension(const std::filesystem::path& path);

std::string lowerCase(std::string text);

} // namespace wedge::scene
