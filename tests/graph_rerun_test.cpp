// Running part of a graph again, where values changed: which passes run, and that all else is as a whole run makes it.
#include "graph_lab.h"

#include <map>

using namespace wedge;
using namespace wedge::graph;
using device::PassKind;
using test::Lab;
using test::usableDevices;

namespace {

struct Rectangle {
    std::uint32_t x0, y0, x1, y1, width;
};

struct Colour { };
struct Sum { };

constexpr int width = 83, height = 40;
constexpr std::uint32_t elements = 3328; // whole parts of 1024 bytes
const Window image { 0, 0, width, height };

Rectangle rectangleOf(const Launch& launch)
{
    const Window& w = launch.window;
    const auto number = [](int x) { return static_cast<std::uint32_t>(x); };
    return { number(w.x0), number(w.y0), number(w.x1), number(w.y1), width };
}

std::uint32_t allElements(const Launch& launch) { return launch.window.empty() ? 0 : elements; }

} // namespace

template <>
inline constexpr std::string_view wedge::graph::kernelType<Rectangle> = "Rectangle";

namespace {

/// What the passes go by.
struct Knobs {
    float first = 1, weight = 1;
};

void numbered(Graph& graph, const char* name, Handle<Colour>& out, const Argument& scale)
{
    graph.add({ .name = name,
        .kernel = { .file = "graph.cl", .name = "numbered" },
        .arguments = { made("p", rectangleOf), value("size", elements), scale, writes("out", out) },
        .domain = Domain::Pixels });
}

void smoothed(Graph& graph, const char* name, const Handle<Colour>& in, Handle<Colour>& out)
{
    graph.add({ .name = name,
        .kind = PassKind::Filter,
        .kernel = { .file = "graph.cl", .name = "smoothed" },
        .arguments = { made("p", rectangleOf), value("size", elements), value("reach", std::uint32_t { 5 }),
            reads("in", in, { .x = 5 }), writes("out", out) },
        .domain = Domain::Pixels });
}

/// Adds the z of what is there, times a weight.
void weighted(Graph& graph, const char* name, const Handle<Colour>& in, Handle<Sum>& sum, const Argument& weight)
{
    graph.add({ .name = name,
        .kind = PassKind::Composite,
        .kernel = { .file = "graph.cl", .name = "weighted" },
        .arguments = { value("size", elements), made("count", allElements), weight, reads("in", in, wholeImage),
            updates("sum", sum) },
        .domain = Domain::Items,
        .count = allElements,
        .mostItems = elements });
}

void cleared(Graph& graph, Handle<Sum>& plane, std::map<std::string, int>& steps)
{
    const Version of = plane;
    graph.add({ .name = "cleared",
        .arguments = { writes("plane", plane) },
        .domain = Domain::Host,
        .step =
            [of, &steps](Run& run) {
                run.buffer<float>(of).fill(run.queue(), 0.0f);
                ++steps["cleared"];
            },
        .constant = true });
}

/// Planes of vectors that are numbered and smoothed, twice, and one sum over both.
struct Drawing {
    explicit Drawing(const Knobs& knobs)
        : graph(width, height, elements)
    {
        const auto colours = [&](const char* name) { return graph.plane<Colour>(name, vectors); };
        auto base = colours("base"), soft = colours("soft"), changed = colours("changed"), blurred = colours("blurred");
        sum = graph.plane<Sum>("sum", floats);
        numbered(graph, "base", base, value("scale", 3.0f));
        smoothed(graph, "soft", base, soft);
        cleared(graph, sum, steps);
        weighted(graph, "add soft", soft, sum, value("weight", 0.5f));
        numbered(graph, "changed", changed, changing("scale", [&knobs] { return knobs.first; }));
        smoothed(graph, "blurred", changed, blurred);
        weighted(graph, "add blurred", blurred, sum, changing("weight", [&knobs] { return knobs.weight; }));
        // What nothing of it goes by, in memory that others may have had.
        auto apart = colours("apart");
        other = colours("other");
        numbered(graph, "apart", apart, value("scale", 7.0f));
        smoothed(graph, "other", apart, other);
        graph.want(sum, image);
        graph.want(other, image);
    }

    std::map<std::string, int> steps; ///< of the host, how often they were made
    Graph graph;
    Handle<Sum> sum;
    Handle<Colour> other;
};

std::vector<float> results(Execution& execution, const Drawing& drawing, device::TimedQueue& queue)
{
    std::vector<float> out = execution.output<float>(drawing.sum).downloadAll(queue);
    const std::vector<float> more = execution.output<float>(drawing.other).downloadAll(queue);
    out.insert(out.end(), more.begin(), more.end());
    return out;
}

/// What is in the image: beside it there may be anything.
void requireEqual(const std::vector<float>& a, const std::vector<float>& b)
{
    REQUIRE(a.size() == b.size());
    for (std::size_t plane = 0; plane < 4; ++plane) {
        for (std::size_t i = 0; i < std::size_t { width } * height; ++i) {
            REQUIRE(a[plane * elements + i] == b[plane * elements + i]);
        }
    }
}

std::set<std::string> passesOf(device::TimedQueue& queue)
{
    std::set<std::string> out;
    queue.finish();
    for (const device::PassRecord& record : queue.takeRecords()) {
        if (record.kind != PassKind::Transfer) {
            out.insert(record.name);
        }
    }
    return out;
}

} // namespace

TEST_CASE("where values change, what goes by them runs again, with the bits of a whole run")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        for (const Sharing sharing : { Sharing::Parts, Sharing::Turns, Sharing::Apart }) {
            Lab lab(device);
            Knobs knobs;
            Drawing drawing(knobs);
            SlabRules rules = slabRulesOf(device.info());
            rules.sharing = sharing;
            const Plan plan(drawing.graph, device::partAlignment, rules);
            CHECK(plan.runsAgain);
            Execution execution(plan, lab.memory, lab.kernels, lab.queue);
            CHECK(execution.run(nullptr, true));
            ChangingValues before = execution.changingValues();
            REQUIRE(before.size() == 2);
            passesOf(lab.queue);
            const auto ran = [&](const Knobs& now) {
                knobs = now;
                drawing.steps.clear();
                CHECK(execution.runAgain(before));
                before = execution.changingValues();
                const std::set<std::string> out = passesOf(lab.queue);
                Lab whole(device);
                Drawing alone(knobs);
                const Plan same(alone.graph, device::partAlignment, rules);
                Execution fresh(same, whole.memory, whole.kernels, whole.queue);
                CHECK(fresh.run(nullptr, true));
                requireEqual(results(execution, drawing, lab.queue), results(fresh, alone, whole.queue));
                passesOf(lab.queue);
                return out;
            };
            using Names = std::set<std::string>;
            CHECK(ran({ 1, 1 }) == Names {});
            CHECK(drawing.steps["cleared"] == 0);
            CHECK(ran({ 1, 2 }) == Names { "add soft", "add blurred" });
            CHECK(drawing.steps["cleared"] == 1);
            CHECK(ran({ 5, 2 }) == Names { "add soft", "add blurred", "changed", "blurred" });
            CHECK(ran({ 6, 3 }) == Names { "add soft", "add blurred", "changed", "blurred" });
            CHECK(ran({ 6, 1 }) == Names { "add soft", "add blurred" });
            CHECK(drawing.steps["cleared"] == 1);
        }
    }
}

TEST_CASE("nothing runs again without values that change, in loops that repeat, or over what outlives the frame")
{
    for (const device::Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        Lab lab(device);
        std::map<std::string, int> steps;
        const auto runsAgain = [&](const Argument& weight, std::size_t iterations, bool imported) {
            device::Buffer<float> kept(device, elements, "kept");
            Graph graph(width, height, elements);
            auto base = graph.plane<Colour>("base", vectors);
            numbered(graph, "base", base, value("scale", 3.0f));
            auto sum = imported ? graph.imported<Sum>("sum", floats, kept.cl()) : graph.plane<Sum>("sum", floats);
            cleared(graph, sum, steps);
            const auto body = [&] { weighted(graph, "add", base, sum, weight); };
            if (iterations > 1) {
                graph.loop(
                    "again", [iterations](Run&) { return iterations; }, body);
            } else {
                graph.only(
                    "once", [](Run&) { return true; }, body);
            }
            graph.want(sum, image);
            return Plan(graph, device::partAlignment, slabRulesOf(device.info())).runsAgain;
        };
        const Argument changes = changing("weight", [] { return 1.0f; });
        CHECK(runsAgain(changes, 1, false));
        CHECK_FALSE(runsAgain(value("weight", 1.0f), 1, false));
        CHECK_FALSE(runsAgain(changes, 2, false));
        CHECK_FALSE(runsAgain(changes, 1, true));
    }
}
