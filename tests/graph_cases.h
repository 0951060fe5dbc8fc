// Graphs that are planned and never run: what their tests have alike.
#pragma once

#include "host/graph/graph.h"
#include "host/graph/plan.h"

#include <doctest/doctest.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace wedge::graph::test {

using device::PassKind;

inline constexpr Format halfFloats { .name = "half1", .bytes = 2, .storage = "half" };

struct Metres { };
struct Radiance { };

inline constexpr std::uint64_t alignment = 64, noLimit = ~std::uint64_t { 0 };
inline constexpr int width = 80, height = 24;

inline std::string faultOf(const std::function<void()>& f)
{
    try {
        f();
    } catch (const std::logic_error& error) {
        return error.what();
    }
    return "";
}

inline std::vector<std::string> namesOf(const Plan& plan)
{
    std::vector<std::string> names;
    for (const PlannedPass& planned : plan.passes) {
        names.push_back(planned.pass->name);
    }
    return names;
}

using Names = std::vector<std::string>;

/// A pass of a kernel that nobody runs.
inline Pass passOf(const std::string& name, std::vector<Argument> arguments)
{
    return { .name = name,
        .kind = PassKind::Filter,
        .kernel = { .file = "none.cl", .name = name },
        .arguments = std::move(arguments) };
}

inline void add(Graph& graph, const std::string& name, std::vector<Argument> arguments)
{
    graph.add(passOf(name, std::move(arguments)));
}

inline const auto once = [](Run&) { return std::size_t { 1 }; };

} // namespace wedge::graph::test
