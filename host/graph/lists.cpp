#include "host/graph/lists.h"

#include <cassert>

namespace wedge::graph {
namespace {

constexpr std::uint32_t parts = 256; ///< of the blocks: work-items

} // namespace

Argument unlessEmpty(std::string name, std::uint32_t number)
{
    return made(std::move(name), [number](const Launch& launch) { return launch.window.empty() ? 0u : number; });
}

ListPlaces placeBlocks(
    Graph& graph, const std::string& name, const std::string& kernels, const Version& elements, std::uint32_t capacity)
{
    assert(capacity > 0);
    const std::uint64_t blocks = graph.resources().at(elements.resource).elements;
    ListPlaces out { graph.list<Placed>("firsts of " + name, graph::counts, blocks),
        graph.list<Placed>("length of " + name, graph::counts, 2), capacity };
    auto sums = graph.list<Placed>("sums of " + name, graph::counts, parts);
    const auto pass = [&](std::string kernel, std::vector<Argument> arguments) {
        arguments.insert(arguments.begin(),
            { unlessEmpty("blocks", static_cast<std::uint32_t>(blocks)), value("parts", parts),
                reads("counts", elements) });
        graph.add({ .name = name,
            .kind = device::PassKind::Analysis,
            .kernel = { .file = kernels, .name = std::move(kernel) },
            .arguments = std::move(arguments),
            .domain = Domain::Items,
            .count = [](const Launch&) { return std::size_t { parts }; },
            .mostItems = parts });
    };
    pass("sumParts", { writes("sums", sums) });
    pass("placeBlocks",
        { reads("sums", sums), value("capacity", capacity), writes("first", out.first), writes("listed", out.listed) });
    return out;
}

std::vector<Argument> countedBy(const std::string& name, const ListPlaces& places)
{
    Argument listed = reads(name, places.listed);
    listed.mostItems = places.capacity;
    return { listed, unlessEmpty(name + "_most", places.capacity) };
}

} // namespace wedge::graph
