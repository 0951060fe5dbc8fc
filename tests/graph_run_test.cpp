// Graphs on devices: kernels by their declarations, loops, crops, memory.
#include "graph_lab.h"

#include "host/graph/interface.h"

#include <cmath>
#include <stdexcept>

using namespace wedge;
using namespace wedge::graph;
using device::PassKind;
using test::Lab;
using test::usableDevices;

namespace {

constexpr Format halfFloats { .name = "half1", .bytes = 2, .storage = "half" };

struct Rectangle {
    std::uint32_t x0, y0, x1, y1, width;
};

struct Colour { };
struct Sum { };

constexpr int width = 83, height = 40;
constexpr std::uint32_t elements = 3328; // whole parts of 1024 bytes
constexpr int smoothReach = 5;

Rectangle rectangleOf(const Launch& launch)
{
    const Window& w = launch.window;
    const auto number = [](int x) { return static_cast<std::uint32_t>(x); };
    return { number(w.x0), number(w.y0), number(w.x1), number(w.y1), width };
}

} // namespace

template <>
inline constexpr std::string_view wedge::graph::kernelType<Rectangle> = "Rectangle";

namespace {

void numbered(Graph& graph, Handle<Colour>& out, float scale)
{
    graph.add({ .name = "numbered",
        .kernel = { .file = "graph.cl", .name = "numbered" },
        .arguments = { made("p", rectangleOf), value("size", elements), value("scale", scale), writes("out", out) },
        .domain = Domain::Pixels });
}

void smoothed(Graph& graph, const Handle<Colour>& in, Handle<Colour>& out)
{
    graph.add({ .name = "smoothed",
        .kind = PassKind::Filter,
        .kernel = { .file = "graph.cl", .name = "smoothed" },
        .arguments = { made("p", rectangleOf), value("size", elements), value("reach", std::uint32_t { smoothReach }),
            reads("in", in, { .x = smoothReach }), writes("out", out) },
        .domain = Domain::Pixels });
}

std::uint32_t allElements(const Launch& launch) { return launch.window.empty() ? 0 : elements; }

/// Adds the x of what is there, times 1 + iteration.
void added(Graph& graph, const Handle<Colour>& in, Handle<Sum>& sum)
{
    const auto iteration = [](const Launch& launch) { return static_cast<std::uint32_t>(launch.run.iteration()); };
    graph.add({ .name = "added",
        .kind = PassKind::Composite,
        .kernel = { .file = "graph.cl", .name = "added" },
        .arguments = { value("size", elements), made("count", allElements), made("iteration", iteration),
            reads("in", in, wholeImage), updates("sum", sum) },
        .domain = Domain::Items,
        .count = allElements,
        .mostItems = elements });
}

void visited(Graph& graph, Handle<Sum>& visits, std::size_t tiles)
{
    graph.add({ .name = "visited",
        .kernel = { .file = "graph.cl", .name = "visited" },
        .arguments = { value("size", elements), made("count", allElements), updates("visits", visits) },
        .domain = Domain::Tiles,
        .count = [tiles](const Launch&) { return tiles; },
        .itemsOfTile = 64,
        .stoppable = true });
}

/// A step on the host that is always made.
void onHost(Graph& graph, const std::string& name, const std::function<void(Run&)>& step,
    const std::function<bool(const Run&)>& condition = {})
{
    graph.add({ .name = name, .domain = Domain::Host, .step = step, .always = true, .condition = condition });
}

/// Zeroes a plane of floats.
void cleared(Graph& graph, Handle<Sum>& plane)
{
    const Version of = plane;
    graph.add(
        { .name = "cleared", .arguments = { writes("plane", plane) }, .domain = Domain::Host, .step = [of](Run& run) {
             run.buffer<float>(of).fill(run.queue(), 0.0f);
         } });
}

} // namespace

TEST_CASE("a crop has the bits of the whole image, whatever lay in the memory before")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        Lab lab(device);
        std::vector<std::vector<float>> images;
        const Window crop { 33, 7, 50, 21 };
        for (const Window& wanted : { Window { 0, 0, width, height }, crop }) {
            Graph graph(width, height, elements);
            auto colour = graph.plane<Colour>("colour", vectors), smooth = graph.plane<Colour>("smooth", vectors);
            auto smoother = graph.plane<Colour>("smoother", vectors);
            numbered(graph, colour, 3.0f);
            smoothed(graph, colour, smooth);
            smoothed(graph, smooth, smoother);
            graph.want(smoother, wanted);
            const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
            device::MemoryPlan planned;
            plan.addTo(planned);
            CHECK(planned.total() == 2 * 12 * elements); // the first has ended when the last begins
            Execution execution(plan, lab.memory, lab.kernels, lab.queue);
            CHECK(lab.memory.bytes() == planned.total());
            CHECK(execution.run(nullptr, true));
            images.push_back(execution.output<float>(smoother).downloadAll(lab.queue));
        }
        const auto at = [](const std::vector<float>& image, int x, int y) {
            return image[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
        };
        for (int y = crop.y0; y < crop.y1; ++y) {
            for (int x = crop.x0; x < crop.x1; ++x) {
                REQUIRE(at(images[0], x, y) == at(images[1], x, y));
                CHECK(at(images[0], x, y) == doctest::Approx(x)); // means of numbers on a line
            }
        }
        CHECK(at(images[0], 0, 3) > 1.0f);
        CHECK(std::isnan(at(images[1], 70, 30))); // nobody asked for it
    }
}

TEST_CASE("a loop's body is run as often as the host finds, with what it carries")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        Lab lab(device);
        Graph graph(width, height, elements);
        auto sum = graph.plane<Sum>("sum", floats);
        std::size_t iterations = 0;
        cleared(graph, sum);
        onHost(graph, "found", [&](Run&) { iterations = 4; });
        graph.loop(
            "iterations", [&](Run&) { return iterations; },
            [&] {
                auto colour = graph.plane<Colour>("colour", vectors);
                numbered(graph, colour, 1.0f);
                added(graph, colour, sum);
            });
        graph.want(sum, { 0, 0, width, height });
        const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
        Execution execution(plan, lab.memory, lab.kernels, lab.queue);
        CHECK(execution.run(nullptr, true));
        const std::vector<float> found = execution.output<float>(sum).downloadAll(lab.queue);
        int wrong = 0;
        for (int i = 0; i < width * height; ++i) {
            wrong += found[static_cast<std::size_t>(i)] != static_cast<float>((1 + 2 + 3 + 4) * (i % width));
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("what is imported outlives the frames")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        Lab lab(device);
        device::Buffer<std::uint16_t> history(device, elements, "history");
        history.fill(lab.queue, std::uint16_t { 0 });
        for (int frame = 0; frame < 3; ++frame) {
            Graph graph(width, height, elements);
            auto visits = graph.imported<Sum>("visits", halfFloats, history.cl());
            visited(graph, visits, 10);
            graph.want(visits, { 0, 0, width, height });
            const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
            CHECK(plan.slabs.empty());
            Execution execution(plan, lab.memory, lab.kernels, lab.queue);
            CHECK(execution.run(nullptr, true));
        }
        const std::vector<std::uint16_t> found = history.downloadAll(lab.queue);
        constexpr std::uint16_t three = 0x4200; // as a half
        for (std::size_t i = 0; i < elements; ++i) {
            REQUIRE(found[i] == (i < 640 ? three : 0));
        }
    }
}

TEST_CASE("a rehearsal launches every kernel, and computes nothing")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        Lab lab(device);
        device::Buffer<std::uint16_t> history(device, elements, "history");
        history.fill(lab.queue, std::uint16_t { 0 });
        device::Buffer<float> image(device, 3 * elements, "image"), sums(device, elements, "sums");
        image.fill(lab.queue, 7.0f);
        sums.fill(lab.queue, 7.0f);
        Graph graph(width, height, elements);
        auto visits = graph.imported<Sum>("visits", halfFloats, history.cl());
        auto colour = graph.imported<Colour>("colour", vectors, image.cl());
        auto sum = graph.imported<Sum>("sum", floats, sums.cl());
        bool asked = false;
        visited(graph, visits, 10);
        numbered(graph, colour, 1.0f);
        graph.loop(
            "never", [&](Run&) { return asked = true, std::size_t { 0 }; }, [&] { added(graph, colour, sum); });
        for (const Version& version : { Version(visits), Version(colour), Version(sum) }) {
            graph.want(version, { 0, 0, width, height });
        }
        const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
        Execution execution(plan, lab.memory, lab.kernels, lab.queue);
        lab.queue.takeRecords();
        execution.rehearse();
        CHECK_FALSE(asked);
        CHECK(history.downloadAll(lab.queue) == std::vector<std::uint16_t>(elements, 0));
        CHECK(image.downloadAll(lab.queue) == std::vector<float>(3 * elements, 7.0f));
        CHECK(sums.downloadAll(lab.queue) == std::vector<float>(elements, 7.0f));
        std::vector<std::string> launched;
        for (const device::PassRecord& record : lab.queue.takeRecords()) {
            launched.insert(launched.end(), record.kernels.begin(), record.kernels.end());
        }
        CHECK(launched == std::vector<std::string> { "visited", "numbered", "added" });
    }
}

TEST_CASE("who is asked to stop ends loops, and does what is left")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        Lab lab(device);
        std::atomic<bool> stop { false };
        int bodies = 0, after = 0, skipped = 0;
        Graph graph(width, height, elements);
        graph.loop(
            "iterations", [](Run&) { return std::size_t { 5 }; },
            [&] {
                onHost(graph, "body", [&](Run& run) {
                    ++bodies;
                    CHECK(run.iteration() + 1 == static_cast<std::size_t>(bodies));
                    stop = bodies == 2;
                });
            });
        onHost(graph, "image", [&](Run& run) { after += run.cut(); });
        onHost(
            graph, "more", [&](Run&) { ++skipped; }, [](const Run& run) { return !run.cut(); });
        const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
        Execution execution(plan, lab.memory, lab.kernels, lab.queue);
        CHECK_FALSE(execution.run(&stop));
        CHECK(bodies == 2);
        CHECK(after == 1);
        CHECK(skipped == 0);
        stop = false;
        bodies = 0;
        CHECK_FALSE(execution.run(&stop));
        CHECK(bodies == 2);
    }
}

TEST_CASE("faults of who declares are found before anything is launched")
{
    const device::Device device = usableDevices().front();
    Lab lab(device);
    Graph graph(width, height, elements);
    auto colour = graph.plane<Colour>("colour", vectors), smooth = graph.plane<Colour>("smooth", vectors);
    numbered(graph, colour, 1.0f);
    smoothed(graph, colour, smooth);
    graph.want(smooth, { 0, 0, width, height });
    SUBCASE("memory for two")
    {
        Plan plan(graph, device::partAlignment);
        plan.places[1].offset = plan.places[0].offset + 12 * (elements - 1024);
        CHECK_THROWS_WITH_AS(Execution(plan, lab.memory, lab.kernels, lab.queue),
            "\"smooth\" and \"colour\" are needed at once, and lie in the same memory", std::logic_error);
    }
    SUBCASE("a step that takes what is not its own")
    {
        onHost(graph, "thief", [&](Run& run) { run.buffer<float>(colour); });
        const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
        Execution execution(plan, lab.memory, lab.kernels, lab.queue);
        CHECK_THROWS_WITH_AS(
            execution.run(), "the step of pass \"thief\" asks for what it does not use", std::logic_error);
    }
    SUBCASE("an argument too few")
    {
        auto more = graph.plane<Colour>("more", vectors);
        graph.add({ .name = "numbered",
            .kernel = { .file = "graph.cl", .name = "numbered" },
            .arguments = { made("p", rectangleOf), value("size", elements), writes("out", more) },
            .domain = Domain::Pixels });
        graph.want(more, { 0, 0, width, height });
        const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
        Execution execution(plan, lab.memory, lab.kernels, lab.queue);
        CHECK(test::errorOf([&] { execution.run(); }).find("does not build") != std::string::npos);
    }
    SUBCASE("a kernel that takes what it is not handed")
    {
        auto more = graph.plane<Colour>("more", vectors);
        graph.add({ .name = "numbered",
            .kernel = { .file = "graph.cl", .name = "numbered" },
            .arguments = { made("p", rectangleOf), value("size", elements), value("scale", 1.0f), writes("to", more) },
            .domain = Domain::Pixels });
        graph.want(more, { 0, 0, width, height });
        const Plan plan(graph, device::partAlignment, slabRulesOf(device.info()));
        Execution execution(plan, lab.memory, lab.kernels, lab.queue);
        CHECK(test::errorOf([&] { execution.run(); }).find("does not build") != std::string::npos);
    }
}
