// What a graph becomes, without a device: which passes run, over which pixels, and what is refused.
#include "host/graph/explain.h"
#include "tests/graph_cases.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::graph;
using namespace wedge::graph::test;

TEST_CASE("what is constant is made right before it is used, and stays in its loop")
{
    Graph graph(width, height, 1024);
    auto sum = graph.plane<Radiance>("sum", vectors), image = graph.plane<Radiance>("image", vectors);
    const auto zeros = [&](Handle<Radiance>& handle) {
        Pass pass = passOf("zeros", { writes("out", handle) });
        pass.constant = true;
        graph.add(std::move(pass));
    };
    zeros(sum);
    zeros(image);
    auto first = graph.plane<Metres>("first", floats);
    add(graph, "trace", { writes("out", first) });
    graph.loop("loop", once, [&] {
        auto own = graph.plane<Radiance>("own", vectors);
        zeros(own);
        add(graph, "sample", { reads("first", first), updates("image", image) });
        add(graph, "gather", { reads("in", image), updates("own", own) });
        add(graph, "add", { reads("in", own), updates("sum", sum) });
        zeros(image); // of the next iteration
    });
    graph.want(sum, { 0, 0, width, height });
    const Plan plan(graph, alignment);
    CHECK(namesOf(plan) == Names { "trace", "zeros", "zeros", "sample", "zeros", "gather", "add", "zeros" });
    CHECK(plan.lifetimes[sum.resource]->first == 2);
    Pass reading = passOf("reading", { reads("in", first), writes("out", image) });
    reading.constant = true;
    CHECK(faultOf([&] { graph.add(reading); })
        == "pass \"reading\" reads \"first\", though it is constant: it may write one resource, always");
}

TEST_CASE("what a body writes is what was there before where the body is left out")
{
    for (const bool repeats : { false, true }) {
        CAPTURE(repeats);
        Graph graph(width, height, 1024);
        auto radiance = graph.plane<Radiance>("radiance", vectors);
        auto mask = graph.plane<Metres>("mask", floats);
        add(graph, "noisy", { writes("out", radiance) });
        const auto body = [&] {
            auto own = graph.plane<Radiance>("own", vectors);
            add(graph, "first", { writes("out", own) });
            add(graph, "own", { writes("out", own) });
            add(graph, "filtered", { reads("in", own), writes("out", radiance), writes("mask", mask) });
        };
        if (repeats) {
            graph.loop("loop", once, body);
        } else {
            graph.only(
                "condition", [](Run&) { return false; }, body);
        }
        const Window wanted { 3, 2, 40, 20 };
        graph.want(radiance, wanted);
        const Plan plan(graph, alignment);
        // What the body has for itself is nobody else's, and its passes are run all or none.
        CHECK(namesOf(plan) == Names { "noisy", "own", "filtered" });
        CHECK(plan.passes.front().window == wanted);
        CHECK(plan.lifetimes[radiance.resource]->first == 0);
    }
}

TEST_CASE("what nobody wants is left out, and so is what only that needed")
{
    Graph graph(width, height, 1024);
    auto position = graph.plane<Metres>("position", vectors);
    auto radiance = graph.plane<Radiance>("radiance", vectors);
    auto layer = graph.plane<Radiance>("layer", vectors);
    auto onlyForLayer = graph.plane<Radiance>("only for the layer", vectors);
    add(graph, "trace", { writes("position", position) });
    add(graph, "prepare", { reads("position", position), writes("out", onlyForLayer) });
    add(graph, "shade", { reads("position", position), writes("out", radiance) });
    add(graph, "show", { reads("in", onlyForLayer), writes("out", layer) });
    Pass report = passOf("report", { reads("in", position) });
    report.always = true;
    graph.add(std::move(report));
    SUBCASE("one")
    {
        graph.want(radiance, { 0, 0, width, height });
        CHECK(namesOf(Plan(graph, alignment)) == Names { "trace", "shade", "report" });
    }
    SUBCASE("all")
    {
        graph.want(layer, { 0, 0, 1, 1 });
        graph.want(radiance, { 0, 0, width, height });
        CHECK(namesOf(Plan(graph, alignment)) == Names { "trace", "prepare", "shade", "show", "report" });
    }
    SUBCASE("none") { CHECK(namesOf(Plan(graph, alignment)) == Names { "trace", "report" }); }
}

TEST_CASE("an older version's maker is not needed where the next writes all anew, and is where it updates")
{
    for (const bool inPlace : { false, true }) {
        Graph graph(width, height, 1024);
        auto plane = graph.plane<Metres>("plane", floats);
        add(graph, "first", { writes("out", plane) });
        if (inPlace) {
            add(graph, "second", { updates("out", plane) });
        } else {
            add(graph, "second", { writes("out", plane) });
        }
        graph.want(plane, { 0, 0, width, height });
        CHECK(namesOf(Plan(graph, alignment)) == (inPlace ? Names { "first", "second" } : Names { "second" }));
    }
}

TEST_CASE("what is made on a condition alone may be what was there before")
{
    Graph graph(width, height, 1024);
    auto plane = graph.plane<Metres>("plane", floats);
    add(graph, "first", { writes("out", plane) });
    Pass second = passOf("second", { writes("out", plane) });
    second.condition = [](const Run&) { return false; };
    graph.add(std::move(second));
    graph.want(plane, { 0, 0, width, height });
    CHECK(namesOf(Plan(graph, alignment)) == Names { "first", "second" });
}

TEST_CASE("a loop keeps what it carries, and not what is its own")
{
    Graph graph(width, height, 1024);
    auto sums = graph.plane<Radiance>("sums", vectors);
    auto seldom = graph.plane<Radiance>("read at its start", vectors);
    auto image = graph.plane<Radiance>("image", vectors);
    add(graph, "clear", { writes("sums", sums) });
    add(graph, "begin", { writes("out", seldom) });
    graph.loop("waves", once, [&] {
        auto own = graph.plane<Radiance>("own", vectors);
        auto second = graph.plane<Radiance>("own, too", vectors);
        add(graph, "trace", { reads("seldom", seldom), writes("own", own) });
        add(graph, "shade", { reads("own", own), writes("second", second) });
        add(graph, "add", { reads("second", second), updates("sums", sums) });
        add(graph, "next", { writes("seldom", seldom) });
    });
    add(graph, "show", { reads("sums", sums), writes("image", image) });
    graph.want(image, { 0, 0, width, height });
    const Plan plan(graph, alignment);
    // "next" is behind all its readers, and is there for the next iteration's.
    CHECK(namesOf(plan) == Names { "clear", "begin", "trace", "shade", "add", "next", "show" });
    const auto life = [&](const char* name) {
        for (std::size_t i = 0; i < plan.lifetimes.size(); ++i) {
            if (graph.resources()[i].name == name) {
                return std::pair(plan.lifetimes[i]->first, plan.lifetimes[i]->last);
            }
        }
        return std::pair(99u, 99u);
    };
    CHECK(life("sums") == std::pair(0u, 6u));
    CHECK(life("read at its start") == std::pair(1u, 5u));
    CHECK(life("own") == std::pair(2u, 3u));
    CHECK(life("own, too") == std::pair(3u, 4u));
    CHECK(life("image") == std::pair(6u, 7u));
    // sums all through, and beside them three at most.
    CHECK(plan.slabs == std::vector<std::uint64_t> { 4 * 12 * 1024 });
}

TEST_CASE("a crop's windows grow backwards by what filters reach, and analyses cover everything")
{
    Graph graph(1000, 600, 1024);
    const Window crop { 100, 50, 130, 60 };
    auto first = graph.plane<Metres>("first", floats);
    auto samples = graph.plane<Metres>("samples", floats);
    auto rows = graph.plane<Metres>("rows", floats);
    auto image = graph.plane<Metres>("image", floats);
    auto scale = graph.list<Metres>("scale", floats, 1);
    add(graph, "first", { writes("first", first) });
    add(graph, "scale", { reads("first", first), writes("scale", scale) });
    add(graph, "sample", { reads("scale", scale), reads("first", first), writes("samples", samples) });
    add(graph, "rows", { reads("samples", samples, { .x = 20 }), writes("rows", rows) });
    add(graph, "columns", { reads("rows", rows, { .y = 4 }), writes("image", image) });
    graph.want(image, crop);
    const Plan plan(graph, alignment);
    std::vector<Window> windows;
    for (const PlannedPass& planned : plan.passes) {
        windows.push_back(planned.window);
    }
    const Window all { 0, 0, 1000, 600 };
    CHECK(windows == std::vector<Window> { all, all, { 80, 46, 150, 64 }, { 100, 46, 130, 64 }, crop });
    CHECK(reached({ 2, 0, 7, 5 }, around(1), { 0, 0, 20, 6 }) == Window { 1, 0, 8, 6 });
    CHECK(reached({ 0, 0, 7, 5 }, wholeImage, { 0, 0, 20, 6 }) == Window { 0, 0, 20, 6 });
    CHECK(reached({}, around(30), { 0, 0, 20, 6 }).empty());
}

TEST_CASE("what is beyond the image that is shown is made where it is read, and lists are of it unless they say other")
{
    Graph graph(100, 60, 1024, 10);
    const Window all { 0, 0, 100, 60 }, shown { 10, 10, 90, 50 };
    CHECK(graph.image() == all);
    CHECK(graph.shown() == shown);
    CHECK(graph.shown(Scale::Quarter) == Window { 2, 2, 23, 13 });
    CHECK(graph.layout(Scale::Full) == PlaneLayout(80, 40, 10));
    auto first = graph.plane<Metres>("first", floats), second = graph.plane<Metres>("second", floats);
    auto counted = graph.plane<Metres>("counted", floats), image = graph.plane<Metres>("image", floats);
    auto ofShown = graph.list<Metres>("list of the image", floats, 1);
    auto ofAll = graph.list<Metres>("list of all", floats, 1);
    const auto everywhere = [&](const char* name, std::vector<Argument> uses) {
        Pass pass = passOf(name, std::move(uses));
        pass.everywhere = true;
        graph.add(std::move(pass));
    };
    everywhere("first", { writes("first", first) });
    everywhere("second", { reads("first", first), writes("second", second) });
    Pass list = passOf("list of the image", { reads("second", second, { .x = 3 }), writes("list", ofShown) });
    list.ofShown = true;
    graph.add(std::move(list));
    add(graph, "counted", { reads("list", ofShown), writes("counted", counted) });
    add(graph, "list of all", { reads("counted", counted), writes("list", ofAll) });
    add(graph, "image", { reads("list", ofAll), reads("counted", counted), writes("image", image) });
    graph.want(image, { 30, 20, 40, 30 });
    std::vector<Window> windows;
    const Plan plan(graph, alignment);
    for (const PlannedPass& planned : plan.passes) {
        windows.push_back(planned.window);
    }
    const Window reach { 7, 10, 93, 50 };
    CHECK(windows == std::vector<Window> { reach, reach, shown, all, all, { 30, 20, 40, 30 } });
}

TEST_CASE("nothing is run for a tally's sake, and none is lost")
{
    Graph graph(width, height, 1024);
    const Window crop { 10, 10, 20, 20 };
    auto rays = graph.plane<Metres>("rays", counts), image = graph.plane<Metres>("image", floats);
    auto unused = graph.plane<Metres>("unused", floats), scale = graph.list<Metres>("scale", floats, 1);
    add(graph, "clear", { writes("rays", rays) });
    add(graph, "idle", { writes("out", unused), tallies("rays", rays) });
    add(graph, "traced", { writes("out", image), tallies("rays", rays) });
    add(graph, "analysed", { writes("scale", scale), tallies("rays", rays) });
    add(graph, "scaled", { reads("scale", scale), updates("image", image) });
    graph.want(image, crop);
    graph.want(rays, { 0, 0, width, height });
    const Plan plan(graph, alignment);
    CHECK(namesOf(plan) == Names { "clear", "traced", "analysed", "scaled" });
    CHECK(plan.passes[0].window == Window { 0, 0, width, height });
    CHECK(plan.passes[1].window == crop);
    CHECK(plan.passes[2].window == Window { 0, 0, width, height });
}

TEST_CASE("what is used wrongly is named")
{
    Graph graph(width, height, 1024), other(width, height, 1024);
    auto width0 = graph.plane<Metres>("width", floats);
    CHECK(faultOf([&] { add(graph, "filter", { reads("in", width0) }); })
        == "pass \"filter\" reads \"width\", which nothing has written before");
    const auto stale = width0;
    add(graph, "analyse", { writes("out", width0) });
    CHECK(faultOf([&] { add(graph, "filter", { reads("in", stale) }); })
        == "pass \"filter\" reads \"width\", of which it has an old version");
    auto staleToo = stale;
    CHECK(faultOf([&] { add(graph, "filter", { writes("out", staleToo) }); })
        == "pass \"filter\" writes \"width\", of which it has an old version");
    CHECK(faultOf([&] {
        graph.want(stale, { 0, 0, 1, 1 });
    }) == "pass \"the end\" reads \"width\", of which it has an old version");
    CHECK(faultOf([&] {
        add(graph, "filter", { reads("in", width0), updates("out", width0) });
    }) == "pass \"filter\" reads \"width\", which it also uses otherwise: update it in place");
    CHECK(faultOf([&] { add(other, "filter", { reads("in", width0) }); })
        == "pass \"filter\" reads a resource, which is of another graph");
    Handle<Metres> own;
    graph.loop("waves", once, [&] {
        own = graph.plane<Metres>("own", floats);
        add(graph, "trace", { writes("out", own) });
    });
    CHECK(faultOf([&] { add(graph, "filter", { reads("in", own) }); })
        == "pass \"filter\" reads \"own\", which is a loop's own, outside of it");
    auto fresh = graph.plane<Metres>("fresh", floats);
    CHECK(faultOf([&] {
        Pass unsure = passOf("second chance", { writes("out", fresh) });
        unsure.condition = [](const Run&) { return true; };
        graph.add(std::move(unsure));
    }) == "pass \"second chance\" writes \"fresh\", which nothing has written before, on a condition alone");
}

TEST_CASE("a plan explains itself, in words and as a drawing")
{
    Graph graph(width, height, 1024);
    auto position = graph.plane<Metres>("position & more", vectors);
    auto image = graph.plane<Radiance>("image", vectors);
    auto unused = graph.plane<Radiance>("unused", vectors);
    graph.loop("waves", once, [&] { add(graph, "trace", { writes("out", position) }); });
    add(graph, "idle", { writes("out", unused) });
    add(graph, "shade", { reads("in", position, around(3)), writes("out", image) });
    graph.want(image, { 16, 0, 32, 5 });
    const Plan plan(graph, alignment);
    CHECK(explain(plan)
        == "passes\n"
           "   1  waves: trace [filter] trace, 13..35 x 0..8: writes position & more\n"
           "   2  shade [filter] shade, 16..32 x 0..5: reads position & more; writes image\n"
           "   -  idle: nobody wants what it makes\n"
           "\nresources\n"
           "  position & more                  float3        0.0 MiB  1-2       part 1 at 0\n"
           "  image                            float3        0.0 MiB  2-end     part 1 at 12288\n"
           "\nmemory of the planes: 0.0 MiB\n");
    const std::string svg = drawing(plan);
    CHECK(svg.starts_with("<svg "));
    CHECK(svg.ends_with("</svg>\n"));
    CHECK(svg.find(">position &amp; more</text>") != std::string::npos);
    CHECK(svg.find("unused") == std::string::npos);
}

TEST_CASE("sizes beyond all numbers stay beyond, and are refused and not wrapped")
{
    Graph graph(width, height, ~std::uint64_t { 0 } / 5);
    auto plane = graph.plane<Metres>("plane", vectors);
    add(graph, "first", { writes("out", plane) });
    graph.want(plane, { 0, 0, 1, 1 });
    const Plan plan(graph, alignment);
    REQUIRE(plan.slabs.size() == 1);
    CHECK(plan.slabs[0] == ~std::uint64_t { 0 });
    device::MemoryPlan memory;
    plan.addTo(memory);
    CHECK(memory.total() == ~std::uint64_t { 0 });
}
