#include "tests/pass_bench.h"

#include "host/render/effect.h"
#include "tests/plane_coding.h"
#include "tests/product_programs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace wedge::test {
namespace {

struct Anything { }; ///< what planes hold

[[noreturn]] void refuse(const std::string& what) { throw std::logic_error(what); }

/// The arguments of sinks, each once.
std::vector<std::string> handed(const std::vector<graph::Sink>& sinks)
{
    std::vector<std::string> out;
    for (const graph::Sink& sink : sinks) {
        for (const auto* names : { &sink.begin, &sink.take, &sink.finish }) {
            std::ranges::copy_if(*names, std::back_inserter(out),
                [&](const std::string& name) { return !std::ranges::count(out, name); });
        }
    }
    return out;
}

/// Memory between words that nobody may touch.
class Guarded {
public:
    Guarded(const device::Device& device, device::TimedQueue& queue, const std::vector<std::byte>& contents)
        : queue_(queue)
        , before_(device.info().failsWithParts ? 0 : device::partAlignment)
        , bytes_(contents.size())
        , all_(device, before_ + bytes_ + device::partAlignment, "guarded plane")
        , plane_(before_ == 0 ? all_ : all_.part<std::byte>(before_, bytes_, "plane"))
    {
        all_.fill(queue, guard);
        all_.upload(queue, contents, before_);
    }
    const cl::Buffer& cl() const { return plane_.cl(); }
    /// What it holds, and whether the words around it are as they were.
    std::pair<std::vector<std::byte>, bool> read() const
    {
        const std::vector<std::byte> all = all_.downloadAll(queue_);
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(before_);
        const auto last = first + static_cast<std::ptrdiff_t>(bytes_);
        const auto whole = [](std::byte b) { return b == guard; };
        return { { first, last }, std::all_of(all.begin(), first, whole) && std::all_of(last, all.end(), whole) };
    }

private:
    static constexpr std::byte guard { 0xa5 };

    device::TimedQueue& queue_;
    std::size_t before_, bytes_;
    device::Buffer<std::byte> all_, plane_;
};

} // namespace

DeclaredFrame::DeclaredFrame(const device::Device& device, const scene::Scene& scene, const render::Settings& settings,
    bool keepLayers, const render::Options& options)
    : renderer(scene, device, options)
    , layout(render::frameLayout(settings, renderer.scene()))
    , tree(render::buildHierarchy(renderer.scene(), renderer.bvhMode(), renderer.traversal()))
    , onDevice(renderer.scene(), tree, renderer.device(), renderer.queue())
    , memories_ { render::SampleMemory(&renderer.device()), render::SampleMemory(&renderer.device()) }
    , declared_(declareFrame(renderer, &onDevice, settings, keepLayers, memories_))
{
}

PassBench::PassBench(render::Renderer& renderer, const graph::Graph& graph, const std::string& kernel,
    const std::string& pass, std::size_t nth)
    : layout(graph.layout(graph::Scale::Full))
    , renderer_(renderer)
{
    std::size_t found = 0;
    for (const graph::Pass& each : graph.passes()) {
        if (each.kernel.name == kernel && (pass.empty() || each.name == pass) && found++ == nth) {
            pass_ = each;
        }
    }
    if (found <= nth) {
        refuse(fmt::format("of kernel {} the frame has {} passes \"{}\", not {}", kernel, found, pass, nth + 1));
    }
    for (int loop = pass_.loop; loop >= 0; loop = graph.loops()[static_cast<std::size_t>(loop)].parent) {
        ++loops_;
    }
    pass_.arguments.insert(pass_.arguments.end(), pass_.absent.begin(), pass_.absent.end());
    pass_.absent.clear(); // the graph that it is added to says it anew
    for (const graph::Argument& use : pass_.arguments) {
        if (use.isUse()) {
            const graph::Resource& of = graph.resources()[use.version.resource];
            planes_.emplace(use.name, of);
            contents_[use.name].resize(static_cast<std::size_t>(of.bytes()));
        }
    }
}

const graph::Argument& PassBench::argument(const std::string& name) const
{
    std::string names;
    for (const graph::Argument& each : pass_.arguments) {
        if (each.name == name) {
            return each;
        }
        names += " " + each.name;
    }
    refuse(fmt::format("kernel {} is not handed \"{}\", but{}", pass_.kernel.name, name, names));
}

const graph::Resource& PassBench::planeOf(const std::string& name) const
{
    if (!argument(name).isUse()) {
        refuse(fmt::format("\"{}\" of kernel {} is no plane, and no list", name, pass_.kernel.name));
    }
    return planes_.at(name);
}

bool PassBench::has(const std::string& name) const { return contents_.contains(name); }

std::size_t PassBench::elements(const std::string& name) const
{
    return static_cast<std::size_t>(planeOf(name).elements);
}

void PassBench::plane(const std::string& name, const std::vector<float>& values)
{
    contents_[name] = encoded(planeOf(name), name, values);
}
void PassBench::plane(const std::string& name, const std::vector<std::uint32_t>& values)
{
    contents_[name] = encoded(planeOf(name), name, values);
}
void PassBench::plane(const std::string& name, const std::vector<std::uint64_t>& values)
{
    contents_[name] = encoded(planeOf(name), name, values);
}

void PassBench::take(const PassBench& from)
{
    for (auto& [name, contents] : contents_) {
        if (!from.has(name)) {
            continue;
        }
        const graph::Resource &own = planes_.at(name), &there = from.planes_.at(name);
        if (!(own.format == there.format) || own.elements != there.elements) {
            refuse(fmt::format("plane \"{}\" of kernel {} is another than kernel {}'s", name, pass_.kernel.name,
                from.pass_.kernel.name));
        }
        contents = from.contents_.at(name);
    }
}

template <>
std::vector<float> PassBench::read(const std::string& name) const
{
    return decoded<float>(planeOf(name), name, contents_.at(name));
}
template <>
std::vector<std::uint32_t> PassBench::read(const std::string& name) const
{
    return decoded<std::uint32_t>(planeOf(name), name, contents_.at(name));
}
template <>
std::vector<std::uint64_t> PassBench::read(const std::string& name) const
{
    return decoded<std::uint64_t>(planeOf(name), name, contents_.at(name));
}

const graph::Argument& PassBench::valueOf(const std::string& name, std::string_view type) const
{
    const graph::Argument& found = argument(name);
    if (found.isUse() || type.empty() || found.type != type) {
        refuse(fmt::format("\"{}\" of kernel {} is {}, not a value {}", name, pass_.kernel.name,
            found.isUse() ? "a plane" : found.type, type));
    }
    return found;
}

void PassBench::setValue(const std::string& name, std::string_view type, std::span<const std::byte> bytes)
{
    valueOf(name, type);
    values_[name].assign(bytes.begin(), bytes.end());
}

void PassBench::sinks(const std::vector<graph::Sink>& becoming, const std::vector<graph::Argument>& values,
    const std::vector<List>& lists)
{
    for (const std::string& name : handed(pass_.kernel.sinks)) {
        std::erase_if(pass_.arguments, [&](const graph::Argument& each) { return each.name == name; });
        contents_.erase(name);
    }
    pass_.kernel.sinks = becoming;
    for (const std::string& name : handed(becoming)) {
        const auto named = [&](const auto& each) { return each.name == name; };
        if (const auto value = std::ranges::find_if(values, named); value != values.end()) {
            pass_.arguments.push_back(*value);
            continue;
        }
        const auto list = std::ranges::find_if(lists, named);
        if (list == lists.end()) {
            refuse(fmt::format("sinks are handed \"{}\", and there is none", name));
        }
        pass_.arguments.push_back({ .name = name, .access = graph::Access::Update });
        graph::Resource of;
        of.name = name;
        of.format = list->format;
        of.elements = list->elements;
        planes_.erase(name);
        planes_.emplace(name, of);
        contents_[name].assign(static_cast<std::size_t>(of.bytes()), std::byte { 0 });
    }
}

Window PassBench::covered() const { return window_.value_or(emptyGraph().image(pass_.scale)); }

graph::Graph PassBench::emptyGraph() const
{
    return { static_cast<int>(layout.width), static_cast<int>(layout.height), layout.size };
}

template <class Add>
void PassBench::inLoops(graph::Graph& graph, std::size_t loops, const Add& add) const
{
    if (loops == 0) {
        add();
        return;
    }
    graph.loop(
        "once", [](graph::Run&) { return std::size_t { 1 }; }, [&] { inLoops(graph, loops - 1, add); });
}

void PassBench::execute(graph::Graph& graph, bool planned) const
{
    const graph::Plan plan(graph, device::partAlignment, renderer_.slabRules());
    graph::Memory memory(renderer_.device());
    graph::Execution execution(plan, memory, renderer_.kernels(), renderer_.queue());
    if (planned) {
        execution.rehearse();
    } else {
        execution.run();
    }
    renderer_.queue().finish();
    renderer_.queue().takeRecords();
}

std::vector<std::byte> PassBench::ownValue(const std::string& name, std::string_view type, bool planned) const
{
    const graph::Argument& found = valueOf(name, type);
    std::vector<std::byte> out;
    graph::Graph graph = emptyGraph();
    inLoops(graph, loops_, [&] {
        graph.add({ .name = "value",
            .domain = graph::Domain::Host,
            .step =
                [&](graph::Run& run) {
                    out = found.value({ run, covered() });
                },
            .always = true });
    });
    execute(graph, planned);
    return out;
}

void PassBench::run()
{
    graph::Graph graph = emptyGraph();
    graph::Pass pass = pass_;
    pass.workUnits = {};
    pass.condition = {};
    pass.constant = pass.everywhere = false;
    pass.always = !window_;
    if (items_) {
        pass.count = [count = *items_](const graph::Launch&) { return count; };
        pass.mostItems = *items_;
    }
    std::map<std::string, Guarded> memory;
    std::map<std::string, graph::Version> versions;
    for (graph::Argument& argument : pass.arguments) {
        if (!argument.isUse()) {
            if (argument.absent != nullptr) {
                continue;
            }
            const auto instead = values_.find(argument.name);
            if (instead != values_.end()) {
                argument.value = [bytes = instead->second](const graph::Launch&) { return bytes; };
            }
            continue;
        }
        const graph::Resource& of = planes_.at(argument.name);
        const Guarded& own =
            memory.try_emplace(argument.name, renderer_.device(), renderer_.queue(), contents_.at(argument.name))
                .first->second;
        graph::Version& version = versions[argument.name];
        version = of.plane ? graph.imported<Anything>(of.name, of.format, own.cl(), of.scale)
                           : graph.imported<Anything>(of.name, of.format, own.cl(), of.elements);
        argument.version = version;
        argument.handle = &version;
    }
    inLoops(graph, loops_, [&] { graph.add(pass); });
    for (const graph::Argument& use : pass_.arguments) {
        if (window_ && use.isUse() && use.access != graph::Access::Read) {
            graph.want(versions.at(use.name), *window_);
        }
    }
    execute(graph, false);
    for (const auto& [name, own] : memory) {
        auto [contents, whole] = own.read();
        if (!whole) {
            refuse(fmt::format("kernel {} has written beside \"{}\"", pass_.kernel.name, name));
        }
        if (changesBeside(name, contents)) {
            refuse(fmt::format("kernel {} has written to \"{}\" beside its window", pass_.kernel.name, name));
        }
        contents_[name] = std::move(contents);
    }
}

bool PassBench::changesBeside(const std::string& name, const std::vector<std::byte>& contents) const
{
    const graph::Resource& of = planes_.at(name);
    const bool exact = pass_.domain == graph::Domain::Pixels || pass_.domain == graph::Domain::Tiles;
    if (!exact || !of.plane || contents == contents_.at(name)) {
        return false; // blocks may reach beyond it
    }
    const std::vector<double> before = anyNumbers(of, name, contents_.at(name)), after = anyNumbers(of, name, contents);
    const graph::PlaneLayout lies = emptyGraph().layout(pass_.scale); // as all planes that it changes
    std::vector<char> inside(lies.size, 0);
    const Window window = covered();
    for (int y = window.y0; y < window.y1; ++y) {
        const auto first = inside.begin() + lies.stride * y + WEDGE_ROW_PADDING;
        std::fill(first + window.x0, first + window.x1, char { 1 });
    }
    for (std::size_t i = 0; i < after.size(); ++i) {
        const bool same = before[i] == after[i] || (std::isnan(before[i]) && std::isnan(after[i]));
        if (!same && inside[i % lies.size] == 0) {
            return true;
        }
    }
    return false;
}

} // namespace wedge::test
