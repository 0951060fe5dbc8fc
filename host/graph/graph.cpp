#include "host/graph/graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <iterator>
#include <stdexcept>

namespace wedge::graph {
namespace {

constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();

constexpr const char* verbs[] = { "reads", "writes", "updates" };

bool isAbsent(const Argument& argument) { return argument.absent != nullptr; }

} // namespace

std::uint64_t Resource::bytes() const { return elements > most / format.bytes ? most : elements * format.bytes; }

Graph::Graph(int width, int height, std::uint64_t planeElements, int margin)
    : image_ { 0, 0, width, height }
    , shown_ { margin, margin, width - margin, height - margin }
    , planeElements_(planeElements)
{
    static std::atomic<std::uint32_t> graphs { 0 };
    id_ = ++graphs;
}

Version Graph::declare(Resource resource)
{
    const std::uint32_t newest = resource.newest;
    resources_.push_back(std::move(resource));
    return { id_, static_cast<std::uint32_t>(resources_.size() - 1), newest };
}

Window Graph::image(Scale scale) const
{
    const int side = static_cast<int>(scale);
    return { 0, 0, (image_.x1 + side - 1) / side, (image_.y1 + side - 1) / side };
}

Window Graph::converted(const Window& window, Scale from, Scale to) const
{
    if (from == to || window.empty()) {
        return window;
    }
    const int a = static_cast<int>(from), b = static_cast<int>(to);
    const Window frame = Window { a * window.x0, a * window.y0, a * window.x1, a * window.y1 }.within(image_);
    return { frame.x0 / b, frame.y0 / b, (frame.x1 + b - 1) / b, (frame.y1 + b - 1) / b };
}

PlaneLayout Graph::layout(Scale scale) const
{
    const Window all = image(scale);
    const int margin = shown_.x0 / static_cast<int>(scale);
    return { all.x1 - 2 * margin, all.y1 - 2 * margin, margin };
}

std::uint64_t Graph::planeElements(Scale scale) const
{
    return scale == Scale::Full ? planeElements_ : layout(scale).size;
}

Argument Graph::grid(std::string name, Scale scale) const
{
    return made(std::move(name), [scale, layout = layout(scale)](const Launch& launch) {
        const auto number = [](auto x) { return static_cast<std::uint32_t>(x); };
        const Window& w = launch.window;
        return shared::PixelGrid { number(scale), layout.width, layout.height, layout.stride, number(layout.size),
            number(w.x0), number(w.y0), number(w.x1), number(w.y1) };
    });
}

std::vector<Argument> together(const std::string& name, std::vector<Argument> arguments)
{
    for (Argument& argument : arguments) {
        argument.group = name;
    }
    return arguments;
}

std::vector<Argument> group(const std::string& name, std::vector<Argument> arguments)
{
    for (Argument& argument : arguments) {
        argument.name = name + "_" + argument.name;
        argument.member = true;
    }
    return together(name, std::move(arguments));
}

void Graph::add(Pass pass)
{
    assert((pass.domain == Domain::Host) == static_cast<bool>(pass.step));
    const auto isCounted = [](const Argument& use) { return use.mostItems > 0; };
    const auto counted = std::ranges::find_if(pass.arguments, isCounted);
    // WEDGE_ITEM has one name, and goes by a parameter.
    assert(std::ranges::count_if(pass.arguments, isCounted) <= 1);
    assert(counted == pass.arguments.end() || !counted->member);
    const bool items = pass.domain == Domain::Items && counted != pass.arguments.end();
    assert((pass.domain == Domain::Tiles || pass.domain == Domain::Items) == (pass.count || items));
    if (items && !pass.count) {
        pass.mostItems = counted->mostItems;
    }
    pass.loop = loop_;
    std::ranges::copy_if(pass.arguments, std::back_inserter(pass.absent), isAbsent);
    std::erase_if(pass.arguments, isAbsent);
    for (Argument& use : pass.arguments) {
        if (use.isUse()) {
            checkedUse(pass, use);
        }
    }
    for (Argument& use : pass.arguments) {
        if (use.isUse() && use.access != Access::Read) {
            use.handle->number = use.version.number = ++resources_[use.version.resource].newest;
        }
        use.handle = nullptr; // which need not live on
    }
    passes_.push_back(std::move(pass));
}

void Graph::enter(Loop loop)
{
    loop.parent = loop_;
    loop.first = passes_.size();
    loops_.push_back(std::move(loop));
    loop_ = static_cast<int>(loops_.size()) - 1;
}

void Graph::leave()
{
    Loop& loop = loops_[static_cast<std::size_t>(loop_)];
    loop.end = passes_.size();
    loop_ = loop.parent;
}

bool Graph::holds(int loop, int inner) const
{
    while (inner > loop) { // a loop comes before those inside it
        inner = loops_[static_cast<std::size_t>(inner)].parent;
    }
    return inner == loop;
}

void Graph::want(const Version& version, const Window& window)
{
    Resource& resource = checkedUse({ .name = "the end" }, reads("", version));
    if (resource.scale != Scale::Full && !image(resource.scale).contains(window)) {
        throw std::logic_error(fmt::format("\"{}\" is wanted beyond its pixels, which are fewer", resource.name));
    }
    resource.wanted = window.with(resource.wanted.value_or(window));
}

Resource& Graph::checkedUse(const Pass& pass, const Argument& use)
{
    const auto refuse = [&](const std::string& what, const char* why) {
        throw std::logic_error(
            fmt::format("pass \"{}\" {} {}, {}", pass.name, verbs[static_cast<int>(use.access)], what, why));
    };
    const Version& version = use.version;
    if (version.graph != id_) {
        refuse("a resource", "which is of another graph");
    }
    Resource& resource = resources_.at(version.resource);
    const std::string name = fmt::format("\"{}\"", resource.name);
    if (pass.constant && (use.access != Access::Write || pass.arguments.size() != 1 || pass.condition)) {
        refuse(name, "though it is constant: it may write one resource, always");
    }
    if (!holds(resource.loop, pass.loop)) {
        refuse(name, "which is a loop's own, outside of it");
    }
    if (version.number != resource.newest) {
        refuse(name, "of which it has an old version");
    }
    if (use.access != Access::Write && version.number == 0) {
        refuse(name, "which nothing has written before");
    }
    if (use.access == Access::Write && pass.condition && version.number == 0) {
        refuse(name, "which nothing has written before, on a condition alone");
    }
    if (use.access != Access::Read && resource.plane && resource.scale != pass.scale) {
        refuse(name, "which is of another scale than the pass");
    }
    for (int loop = pass.loop; loop >= 0 && pass.scale != Scale::Full;
         loop = loops_[static_cast<std::size_t>(loop)].parent) {
        if (loops_[static_cast<std::size_t>(loop)].tile > 0) {
            refuse(name, "in a loop whose passes cover one window, and is of another scale");
        }
    }
    for (const Argument& other : pass.arguments) {
        const bool changed = use.access != Access::Read || other.access != Access::Read;
        if (&other != &use && other.isUse() && other.version.resource == version.resource && changed) {
            refuse(name, "which it also uses otherwise: update it in place");
        }
    }
    return resource;
}

} // namespace wedge::graph
