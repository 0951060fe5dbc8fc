#pragma once

#include "host/device/source.h"
#include "host/graph/graph.h"

#include <string>

namespace wedge::graph {

/// What a pass's kernel is written with, OpenCL C: PARAMETERS, its list of parameters as the pass declares them, and
/// for each resource NAME that it uses LOAD_NAME(size, at) and STORE_NAME(size, at, value), as far as it may, by the
/// resource's format. size: elements of the resource. A kernel that takes something else does not compile. Throws
/// std::logic_error for a value of a type that kernelType does not know.
std::string interfaceText(const Graph& graph, const Pass& pass);

/// What a kernel that takes samples includes as sink.h, the file of that name in its folder being for those who compile
/// it alone: WEDGE_SINK_PARAMETERS and WEDGE_SINK_ARGUMENTS, the end of its list of parameters and their names; Sink,
/// what the sinks keep of a packet; beginReceivers(), takeSamples() and finishReceivers(), which call those of each
/// sink in their order. Throws std::logic_error where a sink is handed what is not among the pass's last arguments, and
/// as interfaceText() does.
std::string sinkText(const Graph& graph, const Pass& pass);

/// What the pass's kernel is compiled from. Throws as sinkText() does.
device::ProgramSource programOf(const Graph& graph, const Pass& pass);

/// The interfaces of all kernels of the graph, each as "pass/KERNEL.h", to be included before the kernel. Throws
/// std::logic_error where two passes hand one kernel different things.
device::GeneratedSources interfaces(const Graph& graph);

} // namespace wedge::graph
