#include "host/graph/plan.h"

#include "host/graph/interface.h"
#include "host/graph/rerun.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

namespace wedge::graph {

Window reached(const Window& window, Reach reach, const Window& image)
{
    if (window.empty()) {
        return window;
    }
    // Of what lies inside the image nothing overflows.
    return { window.x0 - std::min(reach.x, window.x0), window.y0 - std::min(reach.y, window.y0),
        window.x1 + std::min(reach.x, image.x1 - window.x1), window.y1 + std::min(reach.y, image.y1 - window.y1) };
}

/// Finds the windows over which each version is wanted, from the end backwards and around loops until nothing grows.
class Compiler {
public:
    explicit Compiler(const Graph& graph)
        : graph_(graph)
        , wanted_(graph.resources().size())
        , windows_(graph.passes().size())
        , shared_(graph.loops().size())
    {
        findCarried();
        for (std::size_t i = 0; i < graph.resources().size(); ++i) {
            const Resource& resource = graph.resources()[i];
            wanted_[i].resize(resource.newest + 1);
            if (resource.wanted) {
                want(i, resource.newest, *resource.wanted);
            }
        }
        do {
            grew_ = false;
            for (std::size_t i = graph.passes().size(); i-- > 0;) {
                visit(i);
            }
        } while (grew_);
    }

    std::vector<PlannedPass> passes() const
    {
        const auto ofPasses = programs(graph_);
        std::vector<PlannedPass> out;
        for (std::size_t i = 0; i < windows_.size(); ++i) {
            if (windows_[i]) {
                out.push_back({ &graph_.passes()[i], *windows_[i], ofPasses[i] });
            }
        }
        for (std::size_t i = out.size(); i-- > 0;) {
            if (out[i].pass->constant) {
                delay(out, i);
            }
        }
        return out;
    }

private:
    /// Moves a pass to right before the first that uses what it makes, or before the loop that this one is in; it stays
    /// in its own loop.
    void delay(std::vector<PlannedPass>& passes, std::size_t at) const
    {
        const Pass& pass = *passes[at].pass;
        const auto uses = [&](const Argument& use) { return use.isUse() && use.version.resource == made(pass); };
        // The loop in this pass's own that another one is in, -1 for none.
        const auto within = [&](int loop) {
            int child = -1;
            for (; loop != pass.loop; loop = graph_.loops()[static_cast<std::size_t>(loop)].parent) {
                child = loop;
            }
            return child;
        };
        std::size_t to = at + 1;
        const auto inside = [&] { return to < passes.size() && graph_.holds(pass.loop, passes[to].pass->loop); };
        while (inside() && std::ranges::none_of(passes[to].pass->arguments, uses)) {
            ++to;
        }
        if (inside()) {
            const int child = within(passes[to].pass->loop);
            while (child >= 0 && graph_.holds(child, passes[to - 1].pass->loop)) {
                --to;
            }
        }
        const auto position = [&](std::size_t i) { return passes.begin() + static_cast<std::ptrdiff_t>(i); };
        std::rotate(position(at), position(at + 1), position(to));
    }

    /// The resource that a constant pass makes.
    static std::uint32_t made(const Pass& pass) { return pass.arguments.front().version.resource; }

    void want(std::size_t resource, std::uint32_t version, const Window& window)
    {
        std::optional<Window>& known = wanted_[resource][version];
        const Window all = graph_.resources()[resource].plane ? window : graph_.image();
        const Window grown = known ? known->with(all) : all;
        grew_ = grew_ || known != grown;
        known = grown;
    }

    /// The pixels that a pass covers: what it makes, as far as it is wanted.
    std::optional<Window> coveredBy(const Pass& pass)
    {
        std::optional<Window> ofPlanes;
        bool planes = false, lists = false;
        for (const Argument& use : pass.arguments) {
            if (use.isUse() && use.access != Access::Read && !use.tally) {
                const std::optional<Window>& window = wanted_[use.version.resource][use.version.number];
                const bool plane = graph_.resources()[use.version.resource].plane;
                planes = planes || plane;
                lists = lists || (window && !plane);
                ofPlanes = window && plane ? window->with(ofPlanes.value_or(*window)) : ofPlanes;
            }
        }
        const bool wanted = pass.always || lists || ofPlanes;
        const int tiled = tiledLoop(pass.loop);
        const bool all = pass.always || pass.everywhere || lists || !planes;
        if (!wanted || tiled < 0) {
            return !wanted || !all ? ofPlanes : allOf(pass).with(ofPlanes.value_or(Window()));
        }
        std::optional<Window>& shared = shared_[static_cast<std::size_t>(tiled)];
        const std::optional<Window> own = pass.everywhere ? graph_.image() : ofPlanes;
        if (own) {
            const int tile = graph_.loops()[static_cast<std::size_t>(tiled)].tile;
            Window grown = own->with(shared.value_or(*own));
            grown = { grown.x0 / tile * tile, grown.y0 / tile * tile, grown.x1, grown.y1 };
            grew_ = grew_ || shared != grown;
            shared = grown;
        }
        return shared;
    }

    /// What a pass covers that does not go by what is wanted of it alone.
    Window allOf(const Pass& pass) const
    {
        return pass.everywhere || pass.ofShown ? graph_.shown(pass.scale) : graph_.image(pass.scale);
    }

    /// The outermost loop around a pass whose passes cover one window, or -1.
    int tiledLoop(int loop) const
    {
        int found = -1;
        for (; loop >= 0; loop = graph_.loops()[static_cast<std::size_t>(loop)].parent) {
            found = graph_.loops()[static_cast<std::size_t>(loop)].tile > 0 ? loop : found;
        }
        return found;
    }

    void visit(std::size_t index)
    {
        const Pass& pass = graph_.passes()[index];
        windows_[index] = coveredBy(pass);
        if (!windows_[index]) {
            for (const Argument& use : pass.arguments) { // what it would have added to stays as it is
                if (use.tally && use.access != Access::Read && wanted_[use.version.resource][use.version.number]) {
                    read(pass, use.version.resource, use.version.number - 1,
                        *wanted_[use.version.resource][use.version.number]);
                }
            }
            return;
        }
        for (const Argument& use : pass.arguments) {
            if (!use.isUse() || (use.tally && use.access == Access::Read)) {
                continue;
            }
            const std::uint32_t number = use.version.number;
            if (use.access == Access::Read) {
                const Scale scale = graph_.resources()[use.version.resource].scale;
                const Window over = graph_.converted(*windows_[index], pass.scale, scale);
                read(pass, use.version.resource, number, reached(over, use.reach, graph_.image(scale)));
            } else if (use.access == Access::Update || pass.condition
                || pass.loop != graph_.resources()[use.version.resource].loop) { // which may run not once
                // What the pass leaves alone is what was there before.
                const std::optional<Window>& after = wanted_[use.version.resource][number];
                read(pass, use.version.resource, number - 1, windows_[index]->with(after.value_or(Window {})));
            }
        }
    }

    void read(const Pass& pass, std::uint32_t resource, std::uint32_t number, const Window& window)
    {
        want(resource, number, window);
        // From the second iteration on it is what the one before has left.
        for (int loop = pass.loop; loop >= 0; loop = graph_.loops()[static_cast<std::size_t>(loop)].parent) {
            if (graph_.holds(loop, graph_.resources()[resource].loop)) {
                break; // the body's own
            }
            const auto& carried = carried_[static_cast<std::size_t>(loop)];
            const auto found = carried.find(resource);
            if (found != carried.end() && found->second.atStart == number) {
                want(resource, found->second.atEnd, window);
            }
        }
    }

    /// A resource's version when a loop's body starts first, and when it ends.
    struct Carried {
        std::uint32_t atStart, atEnd;
    };

    void findCarried()
    {
        for (const Loop& loop : graph_.loops()) {
            std::map<std::uint32_t, Carried>& carried = carried_.emplace_back();
            for (std::size_t i = loop.first; loop.repeats && i < loop.end; ++i) {
                for (const Argument& use : graph_.passes()[i].arguments) {
                    if (use.isUse() && use.access != Access::Read) {
                        const std::uint32_t number = use.version.number;
                        carried.try_emplace(use.version.resource, Carried { number - 1, number }).first->second.atEnd =
                            number;
                    }
                }
            }
        }
    }

    const Graph& graph_;
    std::vector<std::vector<std::optional<Window>>> wanted_; ///< of each resource's versions
    std::vector<std::optional<Window>> windows_; ///< of each pass
    std::vector<std::optional<Window>> shared_; ///< of loops whose passes cover one window
    std::vector<std::map<std::uint32_t, Carried>> carried_; ///< of each loop, by resource
    bool grew_ = false;
};

Plan::Plan(const Graph& ofGraph, std::uint64_t alignment, const SlabRules& slabRules)
    : graph(ofGraph)
    , sharing(slabRules.sharing)
    , passes(Compiler(ofGraph).passes())
    , lifetimes(ofGraph.resources().size())
    , places(ofGraph.resources().size())
{
    const auto live = [&](std::uint32_t resource, std::size_t from, std::size_t to) {
        const auto first = static_cast<std::uint32_t>(from), last = static_cast<std::uint32_t>(to);
        std::optional<Tenant>& known = lifetimes[resource];
        known = known ? Tenant { known->bytes, std::min(known->first, first), std::max(known->last, last) }
                      : Tenant { graph.resources()[resource].bytes(), first, last };
    };
    const auto inside = [&](std::size_t i, int loop) { return graph.holds(loop, passes[i].pass->loop); };
    for (std::size_t i = 0; i < passes.size(); ++i) {
        for (const Argument& use : passes[i].pass->arguments) {
            if (!use.isUse()) {
                continue;
            }
            // All through the outermost of the loops that it is carried around.
            std::size_t first = i, last = i;
            for (int loop = passes[i].pass->loop;
                 loop >= 0 && !graph.holds(loop, graph.resources()[use.version.resource].loop);
                 loop = graph.loops()[static_cast<std::size_t>(loop)].parent) {
                const bool repeats = graph.loops()[static_cast<std::size_t>(loop)].repeats;
                for (; repeats && first > 0 && inside(first - 1, loop); --first) { }
                for (; repeats && last + 1 < passes.size() && inside(last + 1, loop); ++last) { }
            }
            live(use.version.resource, first, last);
        }
    }
    keepForLater();
    std::vector<Tenant> tenants;
    std::vector<std::size_t> resources;
    for (std::size_t i = 0; i < lifetimes.size(); ++i) {
        if (lifetimes[i] && graph.resources()[i].wanted) {
            lifetimes[i]->last = static_cast<std::uint32_t>(passes.size());
        }
        if (lifetimes[i] && !graph.resources()[i].imported) {
            tenants.push_back(*lifetimes[i]);
            resources.push_back(i);
        }
    }
    Placement placement = place(tenants, alignment, slabRules);
    for (std::size_t i = 0; i < tenants.size(); ++i) {
        places[resources[i]] = placement.places[i];
    }
    slabs = std::move(placement.slabs);
}

void Plan::keepForLater()
{
    const std::vector<bool> changing = changingPasses(passes);
    if (std::ranges::none_of(changing, std::identity())) {
        return;
    }
    const std::vector<bool> again = dependents(graph, passes, changing);
    runsAgain = !again.empty();
    for (std::size_t i = 0; i < again.size(); ++i) {
        for (const Argument& use : passes[i].pass->arguments) {
            if (again[i] && use.isUse()) {
                Tenant& tenant = *lifetimes[use.version.resource];
                tenant.first = 0;
                tenant.last = static_cast<std::uint32_t>(passes.size());
            }
        }
    }
}

SlabRules slabRulesOf(const device::DeviceInfo& info)
{
    return { info.maxAllocation, info.failsWithParts ? Sharing::Turns : Sharing::Parts };
}

void Plan::addTo(device::MemoryPlan& memory) const
{
    for (std::size_t i = 0; i < slabs.size(); ++i) {
        memory.add(slabs.size() == 1 ? "planes" : fmt::format("planes, part {}", i + 1), slabs[i]);
    }
}

} // namespace wedge::graph
