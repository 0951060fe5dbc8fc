// How much passes are handed, in frames of all kinds.
#include "tests/device_testing.h"
#include "tests/product_programs.h"

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace wedge;

namespace {

constexpr std::size_t mostHanded = 12;

/// The values, planes and groups of a pass, by their names.
std::vector<std::string> handedTo(const graph::Pass& pass)
{
    std::vector<std::string> out;
    std::set<std::string> groups;
    for (const std::vector<graph::Argument>* list : { &pass.arguments, &pass.absent }) {
        for (const graph::Argument& argument : *list) {
            if (argument.group.empty()) {
                out.push_back(argument.name);
            } else if (groups.insert(argument.group).second) {
                out.push_back("group " + argument.group);
            }
        }
    }
    return out;
}

} // namespace

TEST_CASE("no pass of any frame is handed more than 12 values, planes and groups")
{
    std::map<std::string, std::vector<std::string>> most; // by kernels
    test::everyGraph(test::usableDevices().front(), [&most](const graph::Graph& graph) {
        for (const graph::Pass& pass : graph.passes()) {
            std::vector<std::string> handed = handedTo(pass);
            std::vector<std::string>& known = most[pass.kernel.name.empty() ? pass.name : pass.kernel.name];
            if (handed.size() > known.size()) {
                known = std::move(handed);
            }
        }
    });
    CHECK(most.size() > 100); // all were there
    for (const auto& of : most) {
        std::string names = of.first + ":";
        for (const std::string& name : of.second) {
            names += " " + name;
        }
        CAPTURE(names);
        CHECK(of.second.size() <= mostHanded);
    }
}
