// Launches over nothing: drivers compile a kernel at its first launch of each size.
#pragma once

#include "host/device/kernel.h"
#include "host/device/queue.h"
#include "host/graph/graph.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wedge::graph {

/// What a pass launches in a rehearsal, as any process can: nothing in it depends on memory.
struct Trial {
    device::ProgramSource program {}; ///< and kernel: as Kernels::find() has them
    std::string kernel {};
    Domain domain = Domain::Items; ///< Pixels and Blocks: rows
    std::vector<std::vector<std::byte>> arguments {}; ///< values; empty: memory
    std::size_t columns = 0, rows = 0; ///< of rows: items each way
    std::size_t columnsOfGroup = 0; ///< of rows: items of a work-group along them
    std::size_t items = 0; ///< of tiles: tiles; of a list: its most
    std::size_t itemsOfGroup = 0; ///< most of a work-group, of tiles all of a tile
};

/// The largest power of two that the kernel allows, at most `most`.
std::size_t localSize(const device::Kernel& kernel, std::size_t most);

/// Sets the values among the kernel's arguments, and launches it; memory is set already.
void launch(device::TimedQueue& queue, const std::string& pass, device::PassKind kind, device::Kernel& kernel,
    const Trial& trial);

} // namespace wedge::graph
