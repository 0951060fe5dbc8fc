#include "host/device/source.h"

#include "host/error.h"
#include "host/file.h"
#include "kernels/embedded_kernels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>

namespace wedge::device {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t maxKernelFile = std::uintmax_t { 16 } << 20;

struct SourceFile {
    std::string path; ///< relative to kernels/, normalised: what makes it the same file
    std::string shownName; ///< what #line and errors say
    std::string text;
};

/// Finds the target of `#include "target"` in a line; nothing if the line is no such directive.
std::optional<std::string_view> includeTarget(std::string_view line)
{
    const auto skipBlanks = [&line] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
    skipBlanks();
    if (!line.starts_with('#')) {
        return std::nullopt;
    }
    line.remove_prefix(1);
    skipBlanks();
    if (!line.starts_with("include")) {
        return std::nullopt;
    }
    line.remove_prefix(std::string_view("include").size());
    skipBlanks();
    const auto close = line.starts_with('"') ? line.find('"', 1) : std::string_view::npos;
    return close == std::string_view::npos ? std::nullopt : std::optional(line.substr(1, close - 1));
}

/// Whether a block comment is open after the line, given whether one was before it.
bool commentOpenAfter(std::string_view line, bool open)
{
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const std::string_view pair = line.substr(i, 2);
        if (open) {
            if (pair == "*/") {
                open = false;
                ++i;
            }
        } else if (line[i] == '"' && (i == 0 || line[i - 1] != '\\')) {
            quoted = !quoted;
        } else if (!quoted && pair == "//") {
            return false;
        } else if (!quoted && pair == "/*") {
            open = true;
            ++i;
        }
    }
    return open;
}

class Flattener {
public:
    Flattener(const std::string& kernelDir, const GeneratedSources& generated)
        : kernelDir_(kernelDir)
        , generated_(generated)
    {
        if (!kernelDir.empty()) {
            requireKernelFolder(kernelDir);
        }
    }

    FlatSource run(const std::string& file)
    {
        std::optional<SourceFile> root = find(file);
        if (!root) {
            throw Error("no such kernel file", file,
                kernelDir_.empty() ? "choose a file of kernels/" : "put it into " + kernelDir_.string());
        }
        append(*root);
        return std::move(flat_);
    }

private:
    std::optional<SourceFile> find(const fs::path& wanted) const
    {
        const std::string path = wanted.lexically_normal().generic_string();
        if (const auto made = generated_.find(path); made != generated_.end()) {
            return SourceFile { path, "generated/" + path, made->second };
        }
        if (path.starts_with("pass/")) {
            return std::nullopt; // a file of that name is of another program
        }
        if (!kernelDir_.empty()) {
            const fs::path onDisk = (kernelDir_ / path).lexically_normal();
            std::error_code unknown; // what is there and cannot be looked at is told, and not passed over
            if (fs::exists(fs::symlink_status(onDisk, unknown)) || unknown == std::errc::permission_denied) {
                return SourceFile { path, onDisk.generic_string(), readFile(onDisk, "kernel file", maxKernelFile) };
            }
        }
        for (const EmbeddedKernel& kernel : embeddedKernels()) {
            if (kernel.path == path) {
                return SourceFile { path, "kernels/" + path, std::string(kernel.text) };
            }
        }
        return std::nullopt;
    }

    void append(const SourceFile& file)
    {
        seen_.insert(file.path);
        open_.push_back(file.path);
        flat_.files.push_back(file.shownName);
        appendLineDirective(1, file);
        bool inComment = false;
        unsigned number = 0;
        for (std::string_view rest = file.text; !rest.empty();) {
            const auto length = std::min(rest.find('\n'), rest.size());
            const std::string_view line = rest.substr(0, length);
            rest.remove_prefix(std::min(length + 1, rest.size()));
            ++number;
            const auto target = inComment ? std::nullopt : includeTarget(line);
            inComment = commentOpenAfter(line, inComment);
            if (target) {
                appendInclude(file, number, *target);
            } else {
                flat_.text.append(line).push_back('\n');
            }
        }
        open_.pop_back();
    }

    void appendInclude(const SourceFile& from, unsigned line, std::string_view target)
    {
        std::optional<SourceFile> file = find(fs::path(from.path).parent_path() / target);
        if (!file) {
            file = find(target);
        }
        const std::string place = fmt::format("{}:{}", from.shownName, line);
        if (!file && target.starts_with("pass/")) {
            flat_.text.push_back('\n'); // of a kernel that the program has no pass for
            return;
        }
        if (!file) {
            throw Error(place + ": include not found", std::string(target),
                "correct the name; includes are looked for beside the including file, then in kernels/");
        }
        if (const auto first = std::find(open_.begin(), open_.end(), file->path); first != open_.end()) {
            throw Error(place + ": files include each other",
                fmt::format("{} -> {}", fmt::join(first, open_.end(), " -> "), file->path),
                "remove one of the includes");
        }
        if (seen_.contains(file->path)) {
            flat_.text.push_back('\n'); // keeps the lines that follow at their numbers
            return;
        }
        append(*file);
        appendLineDirective(line + 1, from);
    }

    void appendLineDirective(unsigned line, const SourceFile& file)
    {
        std::string quoted;
        for (const char c : file.shownName) {
            if (c == '"' || c == '\\') {
                quoted.push_back('\\');
            }
            quoted.push_back(c);
        }
        flat_.text += fmt::format("#line {} \"{}\"\n", line, quoted);
    }

    fs::path kernelDir_;
    const GeneratedSources& generated_;
    FlatSource flat_;
    std::set<std::string> seen_;
    std::vector<std::string> open_; ///< the chain of includes down to the present file
};

} // namespace

void requireKernelFolder(const std::string& folder)
{
    std::error_code failed;
    if (!fs::is_directory(folder, failed)) {
        const std::error_code reason = failed ? failed : std::make_error_code(std::errc::not_a_directory);
        throw Error(fmt::format("kernel folder ({})", reason.message()), folder, "name a folder with --kernel-dir");
    }
}

std::string namePlaces(const std::string& log, const std::string& flatSource)
{
    static const std::regex place("<kernel>:([0-9]{1,8}):"), directive("#line ([0-9]{1,8}) \"(.*)\"");
    std::vector<std::string> places; // of each line
    std::string file = "<kernel>";
    std::size_t number = 1;
    std::istringstream lines(flatSource);
    for (std::string line; std::getline(lines, line); ++number) {
        places.push_back(fmt::format("{}:{}", file, number));
        if (std::smatch found; line.starts_with("#line") && std::regex_match(line, found, directive)) {
            file = found[2];
            number = std::stoul(found[1]) - 1;
        }
    }
    std::string out;
    auto from = log.cbegin();
    for (std::sregex_iterator found(log.begin(), log.end(), place), end; found != end; ++found) {
        const std::size_t line = std::stoul((*found)[1]);
        out.append(from, (*found)[0].first);
        out += line >= 1 && line <= places.size() ? places[line - 1] + ":" : (*found)[0].str();
        from = (*found)[0].second;
    }
    return out.append(from, log.cend());
}

FlatSource flattenKernel(const std::string& kernelDir, const std::string& file, const GeneratedSources& generated)
{
    return Flattener(kernelDir, generated).run(file);
}

} // namespace wedge::device
