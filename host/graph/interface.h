#pragma once

#include "host/device/source.h"
#include "host/graph/graph.h"

#include <memory>
#include <string>
#include <vector>

namespace wedge::graph {

/// What a pass's kernel is written with, OpenCL C: PASS_KERNEL, which says that there is one; PARAMETERS, its list of
/// parameters as the pass declares them, each restrict. For each plane and list NAME: HAS_NAME, whether there is one;
/// LOAD_NAME(size, at) and STORE_NAME(size, at, value), and LOAD16_NAME(size, at) where its format has blocks, by
/// kernels/core/formats.h; FORMAT_NAME, which it is; PLANE_NAME, the pointer. size: elements of the resource. What is
/// absent is no parameter, is read as nothing and not written; its pointer is null. Of passes over pixels
/// WEDGE_PIXEL(p, x, y, i): it declares which pixel of p's rectangle, or first pixel of a block, the item is, and its
/// index, and returns where it is none. Of passes over a list whose length the device knows WEDGE_ITEM(i): the same of
/// the element that the item is (lists.h). Then, of kernels that have sinks, sinkText(). A kernel that takes something
/// else does not compile. Throws std::logic_error for a value of a type that kernelType does not know.
std::string interfaceText(const Graph& graph, const Pass& pass);

/// What a kernel that takes samples goes by: WEDGE_SINK_PARAMETERS and WEDGE_SINK_ARGUMENTS, the end of its list of
/// parameters and their names; Sink, what the sinks keep of a packet; beginReceivers(), takeSamples() and
/// finishReceivers(), which call those of each sink in their order. Throws std::logic_error where a sink is handed what
/// is not among the pass's last arguments, and as interfaceText() does.
std::string sinkText(const Graph& graph, const Pass& pass);

/// The program of each pass's kernel, null for passes of the host: the kernel's file, defines and, as "pass/KERNEL.h",
/// the interfaces of those of its kernels that the graph has passes of, which include them. Passes that hand a kernel
/// different things have different programs; all others of a file and the same defines share one. Throws as
/// interfaceText() does.
std::vector<std::shared_ptr<const device::ProgramSource>> programs(const Graph& graph);

} // namespace wedge::graph
