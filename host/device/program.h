#pragma once

#include "host/device/device.h"
#include "host/device/kernel.h"
#include "host/device/program_cache.h"
#include "host/device/source.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace wedge::device {

/// How programs are built.
struct BuildOptions {
    std::vector<std::pair<std::string, std::string>> defines; ///< name and value; no blanks or quotes in either
    bool fastMath = false; ///< -cl-fast-relaxed-math: other results, to be recorded with the image
    std::string kernelDir; ///< looked in before the embedded sources, for editing kernels; "" for none
    GeneratedSources generated {}; ///< what includes name and no file holds
};

/// The environment's settings for a driver's compiler, which a binary depends on as on the options: without them
/// someone who compares two settings would measure one binary twice.
std::string compilerEnvironment();

/// The programs of one device, each built of one .cl file when first asked for: from memory, else from the binary
/// cache on disk (program_cache.h; not where the driver has its own, quirks.h), else from source. Not for use by
/// several threads at once.
class ProgramLibrary {
public:
    ProgramLibrary(const Device& device, BuildOptions options);

    /// The program of a file of kernels/, "frame/primary.cl"; valid as long as the library. more: generated sources
    /// besides those of the options. Throws Error if a file is missing or does not compile: the message has the device,
    /// the options and the first error, and names a file in the temporary folder with the whole log and the flattened
    /// source.
    cl::Program& program(const std::string& file, const GeneratedSources& more = {});

    /// A new kernel, with arguments of its own, of that program.
    Kernel kernel(const std::string& file, const std::string& name, const GeneratedSources& more = {});

    /// What the compiler is called with, "-cl-std=CL1.2 -DNAME=VALUE".
    std::string optionsString() const;

    /// Programs compiled from source (or fetched from the driver's own cache by it), and loaded from the disk, so far.
    unsigned compiled() const { return compiled_; }
    unsigned loaded() const { return loaded_; }

private:
    cl::Program obtain(const std::string& file, const GeneratedSources& more);
    cl::Program compile(const std::string& file, const std::string& source);
    bool load(const ProgramCache::Binary& binary, cl::Program& program);
    std::string cacheKey(const std::string& source) const;
    [[noreturn]] void reportFailure(const std::string& file, const std::string& source, const std::string& log) const;

    Device device_;
    BuildOptions options_;
    ProgramCache disk_;
    std::map<std::pair<std::string, GeneratedSources>, cl::Program> programs_;
    unsigned compiled_ = 0;
    unsigned loaded_ = 0;
};

} // namespace wedge::device
