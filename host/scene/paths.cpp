#include "host/scene/paths.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "host/error.h"

namespace wedge::scene {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t maxPath = 4095; // Linux opens no longer ones

void requirePath(const std::string& text, const std::string& where)
{
    if (text.find('\0') != std::string::npos)
        throw Error(where + ": path has a byte of value 0", text, "leave it out");
}

/// While it grows: a file of a megabyte may stand for gigabytes.
void append(std::string& out, std::string_view part, const std::string& text, const std::string& where)
{
    if (part.size() > maxPath - out.size())
        throw Error(fmt::format("{}: path is too long, more than {} bytes with its variables", where, maxPath), text,
            "shorten it");
    out += part;
}

} // namespace

std::string expandVariables(const std::string& text, const std::string& where)
{
    std::string out;
    std::size_t at = 0;
    for (;;) {
        const std::size_t begin = text.find("${", at);
        append(out, std::string_view(text).substr(at, begin == std::string::npos ? begin : begin - at), text, where);
        if (begin == std::string::npos)
            return out;
        const std::size_t end = text.find('}', begin);
        if (end == std::string::npos)
            throw Error(where + ": path has '${' without '}'", text, "close the name of the variable with '}'");
        const std::string name = text.substr(begin + 2, end - begin - 2);
        const char* value = std::getenv(name.c_str());
        if (value == nullptr)
            throw Error(where + ": environment variable is not set", name,
                fmt::format("set it to the folder that '{}' stands for", text.substr(begin, end + 1 - begin)));
        append(out, value, text, where);
        at = end + 1;
    }
}

fs::path resolvePath(const std::string& text, const fs::path& folder, const std::string& where)
{
    requirePath(text, where);
    std::string expanded = expandVariables(text, where);
    std::replace(expanded.begin(), expanded.end(), '\\', '/');
    const fs::path path(expanded);
    return path.is_absolute() ? path : (folder / path).lexically_normal();
}

std::string lowerCase(std::string text)
{
    std::transform(
        text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string lowerExtension(const fs::path& path) { return lowerCase(path.extension().string()); }

} // namespace wedge::scene
