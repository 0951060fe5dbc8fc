// What kernels are handed: the text of their parameters, and planes of groups.
#include "host/graph/interface.h"
#include "tests/graph_cases.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::graph;
using namespace wedge::graph::test;

TEST_CASE("kernels are handed what their passes declare, and no other")
{
    Graph graph(width, height, 1024);
    auto position = graph.plane<Metres>("position", vectors);
    auto openness = graph.plane<Metres>("openness", halfFloats);
    add(graph, "trace", { writes("position", position) });
    add(graph, "shade",
        { value("scale", 2.0f), reads("where", position), absent("tint", vectors), writes("out", openness) });
    const std::string text = interfaceText(graph, graph.passes().back());
    CHECK(text.find("#define PARAMETERS const float scale, __global const float *restrict where, "
                    "__global half *restrict out\n")
        != std::string::npos);
    CHECK(text.find("#define LOAD_where(size, at) load_float3(where, size, at)") != std::string::npos);
    CHECK(text.find("#define STORE_out(size, at, value) store_half1(out, size, at, value)") != std::string::npos);
    // What there is not is read as nothing, and not written.
    CHECK(text.find("#define HAS_where 1\n") != std::string::npos);
    CHECK(text.find("#define HAS_tint 0\n") != std::string::npos);
    CHECK(text.find("#define LOAD_tint(size, at) ((void)(size), (void)(at), none_float3())") != std::string::npos);
    CHECK(text.find("#define STORE_tint(size, at, value) ((void)(size), (void)(at), (void)(value))")
        != std::string::npos);
    const auto both = programs(graph);
    CHECK(both[0] == both[1]); // of one file
    CHECK(both[0]->generated.contains("pass/trace.h"));
    CHECK(both[0]->generated.at("pass/shade.h") == text);
    auto mean = graph.plane<Metres>("mean", floats);
    add(graph, "shade",
        { value("scale", 2.0f), reads("where", position), absent("tint", vectors), writes("out", mean) });
    add(graph, "shade",
        { value("scale", 3.0f), reads("where", position), absent("tint", vectors), writes("out", openness) });
    const auto all = programs(graph);
    CHECK(all[2] != all[1]); // it hands the kernel something else
    CHECK(all[2]->file == all[1]->file);
    CHECK(all[3] == all[1]);
    struct Unknown {
        int x;
    };
    add(graph, "odd", { value("p", Unknown { 1 }) });
    CHECK(faultOf([&] { interfaceText(graph, graph.passes().back()); })
        == "pass \"odd\" has a value \"p\" of a type without a name");
}

TEST_CASE("planes of a group are read and written together, those that there are")
{
    Graph graph(width, height, 1024);
    auto colour = graph.plane<Radiance>("colour", vectors), black = graph.plane<Radiance>("black", vectors);
    auto depth = graph.plane<Metres>("depth", floats);
    add(graph, "trace", { writes("colour", colour), writes("black", black), writes("depth", depth) });
    add(graph, "shade",
        group("seen", { reads("depth", depth), updates("colour", colour), absent("weight"), updates("black", black) }));
    const std::string text = interfaceText(graph, graph.passes().back());
    CHECK(text.find("__global const float *restrict seen_depth, __global float *restrict seen_colour")
        != std::string::npos);
    CHECK(text.find("#define LOAD_seen(size, at, out) do { (out)->depth = LOAD_seen_depth(size, at); "
                    "(out)->colour = LOAD_seen_colour(size, at); (out)->black = LOAD_seen_black(size, at); "
                    "(out)->weight = LOAD_seen_weight(size, at); } while (0)\n")
        != std::string::npos);
    CHECK(text.find("#define STORE_seen(size, at, in) do { STORE_seen_colour(size, at, (in)->colour); "
                    "STORE_seen_black(size, at, (in)->black); } while (0)\n")
        != std::string::npos);
}

TEST_CASE("what belongs together keeps its own names, and is no structure of kernels")
{
    Graph graph(width, height, 1024);
    auto colour = graph.plane<Radiance>("colour", vectors);
    auto depth = graph.plane<Metres>("depth", floats);
    add(graph, "trace", { writes("colour", colour), writes("depth", depth) });
    const auto shade = [&](std::vector<Argument> arguments) {
        add(graph, "shade", std::move(arguments));
        return interfaceText(graph, graph.passes().back());
    };
    const std::vector<Argument> apart { reads("depth", depth), reads("colour", colour), absent("weight") };
    const std::string text = shade(together("seen", apart));
    CHECK(text == shade(apart));
    CHECK(std::ranges::all_of(graph.passes()[1].arguments, [](const Argument& use) { return use.group == "seen"; }));
    CHECK(std::ranges::all_of(graph.passes()[1].absent, [](const Argument& use) { return use.group == "seen"; }));
}
