// Other processes that compile a frame's kernels beside this one, for drivers that compile one at a time and keep what
// they compiled (device/quirks.h).
#pragma once

#include "host/device/program.h"
#include "host/graph/execution.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace wedge::render {

/// What compiling is about: programs of which kernels are launched.
struct CompileWork {
    unsigned device = 0; ///< DeviceInfo::index
    device::BuildOptions options;
    std::uint64_t mostBytes = 0; ///< of memory that a kernel is handed
    /// Those of one program together, what takes longest first.
    std::vector<std::vector<graph::Trial>> programs;

    std::size_t kernels() const;
};

/// The work of a rehearsal, without what it would do twice.
CompileWork compileWork(const device::Device& device, const device::BuildOptions& options, const graph::Plan& plan,
    const std::vector<graph::Trial>& trials);

/// Starts `program compile-kernels FILE` in up to `count` processes that share out the work among them and this one,
/// which does its part and waits for theirs, some minutes at most. Nothing depends on whether they start, or end well:
/// what nobody compiled is compiled when it is launched. Returns how many of them did their part.
std::size_t compileSideBySide(const std::string& program, std::size_t count, const CompileWork& work,
    device::TimedQueue& queue, graph::Kernels& kernels);

/// What the file of such a process holds: the number of the next program to begin with, and the work.
std::vector<std::uint8_t> workFile(const CompileWork& work);

/// The part of such a process: file is open, for reading and writing. Returns its exit status.
int compileShare(int file);

/// Whether a plan's kernels were compiled before, by a mark in the folder of the driver's cache, which goes where
/// anything is removed from that.
class KnownKernels {
public:
    /// programs: with those options.
    KnownKernels(const device::Device& device, const device::ProgramLibrary& programs,
        const device::BuildOptions& options, const graph::Plan& plan);
    /// Also where nobody could tell.
    bool areKnown() const;
    void remember() const;

private:
    std::filesystem::path path_; ///< empty: there is no such folder
};

} // namespace wedge::render
