#pragma once

#include "host/device/limits.h"
#include "host/device/memory_plan.h"
#include "host/graph/arena.h"
#include "host/graph/graph.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace wedge::graph {

/// A pass that is run.
struct PlannedPass {
    const Pass* pass = nullptr;
    Window window; ///< the pixels that anybody wants of it, of its scale
    std::shared_ptr<const device::ProgramSource> program = {}; ///< of its kernel; null: the host's
};

/// What a graph becomes: which of its passes are run, over which pixels, and where their resources lie. Refers to the
/// graph.
struct Plan {
    /// What the wanted versions need and nothing else, in the order of the graph, but for passes that are
    /// constant. alignment, bytes, and slabRules: as for
    /// place().
    Plan(const Graph& graph, std::uint64_t alignment, const SlabRules& slabRules = {});

    /// Adds the memory, a line a piece; the sum is what is allocated.
    void addTo(device::MemoryPlan& memory) const;

    const Graph& graph;
    Sharing sharing; ///< of the memory
    std::vector<PlannedPass> passes;
    /// Of each resource of the graph: when it holds something, as indices into passes, one behind the last for what is
    /// wanted at the end; nothing where no pass uses it.
    std::vector<std::optional<Tenant>> lifetimes;
    std::vector<Place> places; ///< of each resource that has a lifetime and is not imported
    std::vector<std::uint64_t> slabs; ///< bytes of each piece of memory to allocate
    /// Some values are changing(), and where they alone change, part of the passes can run again: what these use lives
    /// from the first pass to the end.
    bool runsAgain = false;

private:
    /// Lets what changing() passes and those after them use live for later runs.
    void keepForLater();
};

/// How planes may lie in a device's memory.
SlabRules slabRulesOf(const device::DeviceInfo& info);

/// A window inside the image, grown by `reach` pixels to each side and still inside.
Window reached(const Window& window, Reach reach, const Window& image);

} // namespace wedge::graph
