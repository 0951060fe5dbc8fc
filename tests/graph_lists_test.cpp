// Lists whose length the device knows.
#include "graph_lab.h"

#include "host/graph/interface.h"
#include "host/graph/lists.h"
#include "kernels/shared/frame.h"

#include <algorithm>
#include <random>

using namespace wedge;
using namespace wedge::graph;
using test::Lab;
using test::usableDevices;

namespace {

struct Brightness { };
struct Bright { };

constexpr std::uint32_t guards = 64; ///< numbers beside a list
constexpr float untouched = -7.0f;

const std::string file = "graph_lists.cl";

struct Size {
    int width, height;

    std::uint32_t blocks() const
    {
        constexpr int across = WEDGE_BLOCK_PIXELS;
        return static_cast<std::uint32_t>((width + across - 1) / across * height);
    }
};

void addOverBlocks(Graph& graph, const std::string& kernel, Size size, std::vector<Argument> arguments)
{
    arguments.push_back(
        made("blocks", [blocks = size.blocks()](const Launch& launch) { return launch.window.empty() ? 0u : blocks; }));
    graph.add({ .name = kernel,
        .kernel = { .file = file, .name = kernel },
        .arguments = std::move(arguments),
        .domain = Domain::Items,
        .count = [blocks = size.blocks()](const Launch&) { return std::size_t { blocks }; },
        .mostItems = size.blocks() });
}

void addOverPixels(Graph& graph, const std::string& inFile, const std::string& kernel, Handle<Brightness>& out)
{
    graph.add({ .name = kernel,
        .kernel = { .file = inFile, .name = kernel },
        .arguments = { graph.grid("to", Scale::Full), writes("out", out) },
        .domain = Domain::Pixels });
}

/// A pass over the elements of a list.
void addOverList(Graph& graph, const ListPlaces& places, const Handle<Bright>& bright, Handle<Brightness>& image,
    Handle<Placed>& visits)
{
    std::vector<Argument> arguments = countedBy("length", places);
    for (Argument& more : std::vector<Argument> { value("capacity", places.capacity), graph.grid("to", Scale::Full),
             reads("bright", bright), updates("image", image), updates("visits", visits) }) {
        arguments.push_back(std::move(more));
    }
    graph.add({ .name = "show",
        .kernel = { .file = file, .name = "showBright" },
        .arguments = std::move(arguments),
        .domain = Domain::Items });
}

struct Found {
    std::vector<float> image, list;
    std::vector<std::uint32_t> listed, visits;
};

/// The bright pixels of a pattern, listed and shown, where that window of what they are shown in is wanted.
Found found(Lab& lab, Size size, std::uint32_t capacity, const Window& wanted)
{
    device::Buffer<float> listMemory(lab.device, 3 * capacity + guards, "list");
    device::Buffer<std::uint32_t> visitMemory(lab.device, capacity + guards, "visits");
    listMemory.fill(lab.queue, untouched);
    visitMemory.fill(lab.queue, 0u);
    Graph graph(size.width, size.height, PlaneLayout(size.width, size.height).size);
    auto pattern = graph.plane<Brightness>("pattern", floats), image = graph.plane<Brightness>("image", floats);
    auto counts = graph.list<Placed>("counts", graph::counts, size.blocks());
    auto bright = graph.imported<Bright>("bright", vectors, listMemory.cl(), capacity);
    auto visits = graph.imported<Placed>("visits", graph::counts, visitMemory.cl(), capacity);
    const auto from = graph.grid("from", Scale::Full);
    addOverPixels(graph, "graph_scales.cl", "pattern", pattern);
    addOverBlocks(graph, "countBright", size, { from, reads("in", pattern), writes("counts", counts) });
    const ListPlaces places = placeBlocks(graph, "bright pixels", file, counts, capacity);
    addOverBlocks(graph, "listBright", size,
        { from, reads("in", pattern), reads("first", places.first), value("capacity", capacity),
            writes("bright", bright) });
    addOverPixels(graph, file, "darkness", image);
    addOverList(graph, places, bright, image, visits);
    graph.want(image, wanted);
    graph.want(places.listed, wanted);
    const Plan plan(graph, device::partAlignment, slabRulesOf(lab.device.info()));
    Execution execution(plan, lab.memory, lab.kernels, lab.queue);
    CHECK(execution.run(nullptr, true));
    return { execution.output<float>(image).downloadAll(lab.queue), listMemory.downloadAll(lab.queue),
        execution.output<std::uint32_t>(places.listed).downloadAll(lab.queue), visitMemory.downloadAll(lab.queue) };
}

struct Element {
    int x, y;
    float value;
};

/// The host's list.
std::vector<Element> brightPixels(Size size)
{
    std::vector<Element> out;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const float value = static_cast<float>((x * 7 + y * 13) % 32) + 0.125f * static_cast<float>(x);
            if (value > 20.0f) {
                out.push_back({ x, y, value });
            }
        }
    }
    return out;
}

/// The elements that there are room for are as the host has them, and nothing is beside them; visited once, and shown
/// within the window.
void requireListed(const Found& of, Size size, std::uint32_t capacity, const Window& window)
{
    const std::vector<Element> all = brightPixels(size);
    const std::size_t listed = std::min<std::size_t>(all.size(), capacity);
    CHECK(of.listed
        == std::vector<std::uint32_t> {
            static_cast<std::uint32_t>(listed), static_cast<std::uint32_t>(all.size() - listed) });
    std::vector<float> list(3 * std::size_t { capacity } + guards, untouched);
    std::vector<std::uint32_t> visits(std::size_t { capacity } + guards, 0);
    const PlaneLayout layout(size.width, size.height);
    const auto index = [&](int x, int y) {
        return shared::pixelIndex(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), layout.stride);
    };
    std::vector<float> image(static_cast<std::size_t>(layout.size), 0.0f);
    for (std::size_t i = 0; i < listed; ++i) {
        list[i] = static_cast<float>(all[i].x);
        list[capacity + i] = static_cast<float>(all[i].y);
        list[2 * std::size_t { capacity } + i] = all[i].value;
        visits[i] = 1;
        image[index(all[i].x, all[i].y)] = all[i].value * all[i].value;
    }
    CHECK(of.list == list);
    CHECK(of.visits == visits);
    int wrong = 0;
    for (int y = window.y0; y < window.y1; ++y) {
        for (int x = window.x0; x < window.x1; ++x) {
            wrong += !(of.image[index(x, y)] == image[index(x, y)]);
        }
    }
    CHECK(wrong == 0);
}

} // namespace

TEST_CASE("lists are as the host makes them, have no more than there is room for, and say what had none")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        Lab lab(device);
        for (const Size size : { Size { 61, 37 }, Size { 640, 70 }, Size { 1, 1 } }) { // 148 blocks, 2800, and 1
            CAPTURE(size.width);
            const Window all { 0, 0, size.width, size.height };
            const auto there = static_cast<std::uint32_t>(brightPixels(size).size());
            CHECK((size.width == 1 ? there == 0 : there > 1000));
            for (const std::uint32_t capacity : { 1u, 17u, there - 1, there, there + 1, 4 * there + 100 }) {
                if (capacity > 0 && capacity < 1u << 20) {
                    CAPTURE(capacity);
                    requireListed(found(lab, size, capacity, all), size, capacity, all);
                }
            }
        }
    }
}

TEST_CASE("a crop of what lists are shown in has the bits of the whole image")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        Lab lab(device);
        for (const Window& crop : { Window { 30, 9, 41, 17 }, Window { 0, 0, 5, 4 }, Window { 48, 30, 61, 37 } }) {
            requireListed(found(lab, { 61, 37 }, 500, crop), { 61, 37 }, 500, crop);
        }
    }
}

TEST_CASE("blocks follow each other, however many and however full they are")
{
    const device::Device device = usableDevices().front();
    Lab lab(device);
    std::mt19937 random(3);
    constexpr std::uint64_t most = ~std::uint32_t { 0 };
    for (const std::uint32_t blocks : { 1u, 2u, 255u, 256u, 257u, 1000u, 70001u }) {
        for (const std::uint32_t largest : { 1u, 9u, ~0u }) {
            CAPTURE(blocks);
            CAPTURE(largest);
            std::vector<std::uint32_t> counts(blocks), first(blocks);
            std::uint64_t sum = 0;
            for (std::uint32_t i = 0; i < blocks; ++i) {
                counts[i] = static_cast<std::uint32_t>(random() % (std::uint64_t { largest } + 1));
                first[i] = static_cast<std::uint32_t>(std::min(sum, most));
                sum += counts[i];
            }
            sum = std::min(sum, most);
            device::Buffer<std::uint32_t> memory(device, blocks, "counts");
            memory.upload(lab.queue, counts);
            Graph graph(8, 8, 1024);
            auto imported = graph.imported<Placed>("counts", graph::counts, memory.cl(), blocks);
            const ListPlaces places = placeBlocks(graph, "blocks", file, imported, 300);
            graph.want(places.first, graph.image());
            graph.want(places.listed, graph.image());
            const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
            Execution execution(plan, lab.memory, lab.kernels, lab.queue);
            CHECK(execution.run(nullptr, true));
            CHECK(execution.output<std::uint32_t>(places.first).downloadAll(lab.queue) == first);
            const std::uint32_t listed = static_cast<std::uint32_t>(std::min<std::uint64_t>(sum, 300));
            CHECK(execution.output<std::uint32_t>(places.listed).downloadAll(lab.queue)
                == std::vector<std::uint32_t> { listed, static_cast<std::uint32_t>(sum) - listed });
        }
    }
}

TEST_CASE("a rehearsal does nothing to a list, whatever its length seems to be")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        Lab lab(device);
        constexpr std::uint32_t capacity = 200;
        device::Buffer<std::uint32_t> lengthMemory(device, 2, "length"), visitMemory(device, capacity, "visits");
        device::Buffer<float> listMemory(device, 3 * capacity, "list");
        lengthMemory.fill(lab.queue, ~0u);
        visitMemory.fill(lab.queue, 0u);
        listMemory.fill(lab.queue, 1.0f);
        const PlaneLayout layout(37, 23);
        device::Buffer<float> imageMemory(device, static_cast<std::size_t>(layout.size), "image");
        imageMemory.fill(lab.queue, untouched);
        Graph graph(37, 23, layout.size);
        const ListPlaces places { {}, graph.imported<Placed>("length", graph::counts, lengthMemory.cl(), 2), capacity };
        auto bright = graph.imported<Bright>("bright", vectors, listMemory.cl(), capacity);
        auto image = graph.imported<Brightness>("image", floats, imageMemory.cl());
        auto visits = graph.imported<Placed>("visits", graph::counts, visitMemory.cl(), capacity);
        addOverList(graph, places, bright, image, visits);
        graph.want(image, graph.image());
        const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
        Execution execution(plan, lab.memory, lab.kernels, lab.queue);
        execution.rehearse();
        CHECK(visitMemory.downloadAll(lab.queue) == std::vector<std::uint32_t>(capacity, 0));
        CHECK(imageMemory.downloadAll(lab.queue) == std::vector<float>(imageMemory.size(), untouched));
        CHECK(execution.run()); // no length is beyond what there is room for
        CHECK(visitMemory.downloadAll(lab.queue) == std::vector<std::uint32_t>(capacity, 1));
    }
}
