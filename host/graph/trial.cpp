#include "host/graph/trial.h"

namespace wedge::graph {

std::size_t localSize(const device::Kernel& kernel, std::size_t most)
{
    std::size_t size = most;
    while (size > kernel.workGroupLimit() && size > 1) {
        size /= 2;
    }
    return size;
}

void launch(device::TimedQueue& queue, const std::string& pass, device::PassKind kind, device::Kernel& kernel,
    const Trial& trial)
{
    for (unsigned i = 0; i < trial.arguments.size(); ++i) {
        if (!trial.arguments[i].empty()) {
            kernel.setArgBytes(i, trial.arguments[i]);
        }
    }
    const std::size_t local = localSize(kernel, trial.itemsOfGroup);
    switch (trial.domain) {
    case Domain::Tiles:
        queue.launchTiled(
            pass, kind, kernel, trial.items * (trial.itemsOfGroup / local), local, kernel.argCount() - 1, 0.0);
        break;
    case Domain::Pixels:
    case Domain::Blocks: {
        const std::size_t across = std::min(local, trial.columnsOfGroup);
        queue.launch2D(pass, kind, kernel, trial.columns, trial.rows, across, local / across);
        break;
    }
    default:
        queue.launch(pass, kind, kernel, trial.items, local);
    }
}

} // namespace wedge::graph
