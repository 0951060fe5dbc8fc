// A kernel that is launched with planes and values by name, as a pass of the test's own declares them: for forms of
// kernels that no single frame has, and memory that several kernels share.
#pragma once

#include "host/graph/interface.h"
#include "host/render/frame_builder.h"
#include "tests/render_support.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace wedge::test {

/// What a kernel is handed: a plane in memory, a value, or nothing.
struct Handed { // NOLINT(bugprone-exception-escape): as Buffer
    graph::Argument argument; ///< of a plane its name and group alone
    graph::Format format = graph::floats;
    cl::Buffer memory = {}; ///< of a plane
};

template <class T>
Handed plane(const std::string& name, const device::Buffer<T>& memory, const graph::Format& format)
{
    return { { name }, format, memory.cl() };
}
inline Handed plane(const std::string& name, const device::Buffer<float>& memory)
{
    return plane(name, memory, graph::floats);
}
inline Handed plane(const std::string& name, const device::Buffer<std::uint32_t>& memory)
{
    return plane(name, memory, graph::counts);
}
inline Handed vectors(const std::string& name, const device::Buffer<float>& memory)
{
    return plane(name, memory, graph::vectors);
}
template <class T>
Handed value(const std::string& name, const T& constant)
{
    return { graph::value(name, constant) };
}
inline Handed lacks(const std::string& name, const graph::Format& format = graph::floats)
{
    return { graph::absent(name, format) };
}
/// A plane, or none.
inline Handed onlyIf(bool there, const Handed& handed)
{
    return there ? handed : lacks(handed.argument.name, handed.format);
}
inline std::vector<Handed> group(const std::string& name, std::vector<Handed> members)
{
    for (Handed& handed : members) {
        handed.argument = graph::group(name, { handed.argument }).front();
    }
    return members;
}

/// Adds a pass that is handed these, and runs it; elements: of planes, 0: of the graph's pixels.
inline void runDeclared(KernelBench& bench, graph::Graph& graph, graph::Pass pass, const std::vector<Handed>& handed,
    std::uint64_t elements)
{
    std::vector<graph::Handle<render::Value>> planes(handed.size());
    for (std::size_t i = 0; i < handed.size(); ++i) {
        const Handed& each = handed[i];
        if (each.memory() == nullptr) {
            pass.arguments.push_back(each.argument);
            continue;
        }
        planes[i] = graph.imported<render::Value>(each.argument.name, each.format, each.memory, elements);
        graph::Argument use = graph::updates(each.argument.name, planes[i]);
        use.group = each.argument.group;
        use.member = each.argument.member;
        pass.arguments.push_back(use);
    }
    pass.always = true;
    graph.add(pass);
    const graph::Plan plan(graph, device::partAlignment);
    graph::Memory memory(bench.device);
    graph::Kernels kernels(bench.library);
    graph::Execution(plan, memory, kernels, bench.queue).run();
}

/// Launches a kernel over so many items.
inline void launchDeclared(
    KernelBench& bench, const graph::KernelName& kernel, std::size_t items, const std::vector<Handed>& handed)
{
    graph::Graph graph(1, 1, 1);
    runDeclared(bench, graph,
        { .name = kernel.name,
            .kernel = kernel,
            .domain = graph::Domain::Items,
            .count = [items](const graph::Launch&) { return items; },
            .mostItems = items },
        handed, 1);
}

/// Over pixels, or blocks of them; params: the kernel's first, "p", which get the rectangle.
template <class Params>
void launchDeclared(KernelBench& bench, const graph::KernelName& kernel, const render::PlaneLayout& layout,
    const Params& params, std::vector<Handed> handed, graph::Domain domain = graph::Domain::Pixels)
{
    graph::Graph graph(static_cast<int>(layout.width), static_cast<int>(layout.height), layout.size);
    const auto rectangle = [params](const graph::Launch& launch) {
        Params p = params;
        render::setRectangle(p, launch.window);
        return p;
    };
    handed.insert(handed.begin(), Handed { graph::made("p", rectangle) });
    runDeclared(bench, graph, { .name = kernel.name, .kernel = kernel, .domain = domain }, handed, 0);
}

} // namespace wedge::test
