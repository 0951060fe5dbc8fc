#include "host/render/outputs.h"

#include <algorithm>
#include <stdexcept>

namespace wedge::render {

void Outputs::add(Output output)
{
    if (find(output.name()) != nullptr) {
        throw std::logic_error("a frame has two outputs \"" + output.name() + "\"");
    }
    all_.push_back(std::move(output));
}

void Outputs::replace(const std::string& name, const graph::Version& version, std::optional<Where> where)
{
    const auto found = std::ranges::find_if(all_, [&](const Output& each) { return each.name() == name; });
    if (found == all_.end()) {
        throw std::logic_error("a frame has no output \"" + name + "\"");
    }
    found->version = version;
    found->where = where.value_or(found->where);
}

const Output* Outputs::find(const std::string& name) const
{
    const auto found = std::ranges::find_if(all_, [&](const Output& each) { return each.name() == name; });
    return found != all_.end() ? &*found : nullptr;
}

void Outputs::want(graph::Graph& graph, const image::Window& window) const
{
    for (const Output& output : all_) {
        graph.want(output.version, window);
    }
}

bool Frame::has(const std::string& name) const
{
    return std::ranges::any_of(shown, [&](const Shown& each) { return each.output.name() == name; });
}

const Frame::Shown& Frame::find(const std::string& name) const
{
    const auto found = std::ranges::find_if(shown, [&](const Shown& each) { return each.output.name() == name; });
    if (found == shown.end()) {
        throw std::logic_error("the frame has no output \"" + name + "\"");
    }
    return *found;
}

} // namespace wedge::render
