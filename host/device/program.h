#pragma once

#include "host/device/device.h"
#include "host/device/kernel.h"
#include "host/device/program_cache.h"
#include "host/device/source.h"

#include <compare>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace wedge::device {

/// Names and values that a compiler is handed; no blanks or quotes in either.
using Defines = std::vector<std::pair<std::string, std::string>>;

/// How programs are built.
struct BuildOptions {
    Defines defines;
    bool fastMath = false; ///< -cl-fast-relaxed-math: other results, to be recorded with the image
    std::string kernelDir; ///< looked in before the embedded sources, for editing kernels; "" for none
    GeneratedSources generated {}; ///< what includes name and no file holds
};

/// What one program is made of, besides the options of all.
struct ProgramSource {
    ProgramSource() = default;
    /// Implicit: a file alone is a program.
    ProgramSource(const char* name)
        : file(name)
    {
    }
    ProgramSource(std::string name, Defines with = {}, GeneratedSources made = {})
        : file(std::move(name))
        , defines(std::move(with))
        , generated(std::move(made))
    {
    }

    std::string file; ///< of kernels/, "frame/primary.cl"
    Defines defines; ///< what tells it from others of that file
    GeneratedSources generated;
    auto operator<=>(const ProgramSource&) const = default; // NOLINT(modernize-use-nullptr)
};

/// Its text, flattened (source.h), by options. Throws what flattenKernel() does.
std::string textOf(const BuildOptions& options, const ProgramSource& source);

/// Files for people who read or compile programs by themselves, their contents by path: of each program NAME.cl, its
/// text with its defines before it, and NAME/PATH, what was generated, as its includes name it. NAME is that of the
/// program's file with dots for slashes, numbered from the second program of a file on. Throws as textOf().
std::map<std::string, std::string> programFiles(
    const BuildOptions& options, const std::vector<ProgramSource>& programs);

/// The environment's settings for a driver's compiler, which a binary depends on as on the options: without them
/// someone who compares two settings would measure one binary twice.
std::string compilerEnvironment();

/// The programs of one device, each built of one .cl file when first asked for: from memory, else from the binary
/// cache on disk (program_cache.h; not where the driver has its own, quirks.h), else from source. Not for use by
/// several threads at once.
class ProgramLibrary {
public:
    ProgramLibrary(const Device& device, BuildOptions options);

    /// The program; valid as long as the library. Throws Error if a file is missing or does not compile: the message
    /// has the device, the options and the first error, and names a file in the temporary folder with the whole log and
    /// the flattened source.
    cl::Program& program(const ProgramSource& source);

    /// A new kernel, with arguments of its own, of that program. Throws Error where the program does not include the
    /// kernel's interface, if it has one, and as program() and Kernel do.
    Kernel kernel(const ProgramSource& source, const std::string& name);

    /// What the compiler is called with, "-cl-std=CL1.2 -DNAME=VALUE": with the defines of all programs, of which each
    /// gets those that its text names. So programs that scenes and frames do not tell apart are compiled once for all.
    std::string optionsString() const;
    /// The same of one program, whose text is that.
    std::string optionsString(const ProgramSource& source, const std::string& text) const;

    /// Programs compiled from source (or fetched from the driver's own cache by it), and loaded from the disk, so far.
    unsigned compiled() const { return compiled_; }
    unsigned loaded() const { return loaded_; }

private:
    std::string optionsString(const Defines& defines) const;
    cl::Program obtain(const ProgramSource& source);
    cl::Program compile(const ProgramSource& source, const std::string& text, const std::string& options);
    bool load(const ProgramCache::Binary& binary, const std::string& options, cl::Program& program);
    std::string cacheKey(const std::string& options, const std::string& text) const;
    [[noreturn]] void reportFailure(
        const ProgramSource& source, const std::string& text, std::string options, const std::string& log) const;

    Device device_;
    BuildOptions options_;
    ProgramCache disk_;
    std::map<ProgramSource, cl::Program> programs_;
    unsigned compiled_ = 0;
    unsigned loaded_ = 0;
};

} // namespace wedge::device
