#include "host/graph/plan.h"

#include "kernels/shared/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace wedge::graph {

Window reached(const Window& window, Reach reach, const Window& image)
{
    if (reach == wholeImage || window.empty()) {
        return window.empty() ? window : image;
    }
    constexpr int block = static_cast<int>(WEDGE_BLOCK_PIXELS);
    const auto grown = [&](int end) { return end > std::numeric_limits<int>::max() - reach ? end : end + reach; };
    const int left = std::max(0, window.x0 - reach), right = std::min(grown(window.x1), image.x1);
    return { left / block * block, std::max(0, window.y0 - reach),
        std::min(image.x1, (right + block - 1) / block * block), std::min(image.y1, grown(window.y1)) };
}

/// Finds the windows over which each version is wanted, from the end backwards and around loops until nothing grows.
class Compiler {
public:
    explicit Compiler(const Graph& graph)
        : graph_(graph)
        , wanted_(graph.resources().size())
        , windows_(graph.passes().size())
    {
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
        std::vector<PlannedPass> out;
        for (std::size_t i = 0; i < windows_.size(); ++i) {
            if (windows_[i]) {
                out.push_back({ &graph_.passes()[i], *windows_[i] });
            }
        }
        return out;
    }

private:
    void want(std::size_t resource, std::uint32_t version, const Window& window)
    {
        std::optional<Window>& known = wanted_[resource][version];
        const Window all = graph_.resources()[resource].plane ? window : graph_.image();
        const Window grown = known ? known->with(all) : all;
        grew_ = grew_ || known != grown;
        known = grown;
    }

    /// What pass i makes, as far as it is wanted.
    std::optional<Window> madeBy(const Pass& pass) const
    {
        std::optional<Window> made;
        bool planes = false;
        for (const Argument& use : pass.arguments) {
            if (use.isUse() && use.access != Access::Read) {
                const std::optional<Window>& window = wanted_[use.version.resource][use.version.number];
                planes = planes || graph_.resources()[use.version.resource].plane;
                made = window ? window->with(made.value_or(*window)) : made;
            }
        }
        if (pass.always || (made && (pass.everywhere || !planes))) {
            return graph_.image();
        }
        return made;
    }

    void visit(std::size_t index)
    {
        const Pass& pass = graph_.passes()[index];
        windows_[index] = madeBy(pass);
        if (!windows_[index]) {
            return;
        }
        for (const Argument& use : pass.arguments) {
            if (!use.isUse()) {
                continue;
            }
            const std::uint32_t number = use.version.number;
            if (use.access == Access::Read) {
                read(pass, use.version.resource, number, reached(*windows_[index], use.reach, graph_.image()));
            } else if (use.access == Access::Update || pass.condition) {
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
            const auto [atStart, atEnd] = versionsAround(graph_.loops()[static_cast<std::size_t>(loop)], resource);
            if (number == atStart && atEnd != atStart) {
                want(resource, atEnd, window);
            }
        }
    }

    /// The resource's version when the loop's body starts first, and when it ends.
    std::pair<std::uint32_t, std::uint32_t> versionsAround(const Loop& loop, std::uint32_t resource) const
    {
        std::uint32_t first = graph_.resources()[resource].imported ? 1 : 0, last = first;
        for (std::size_t i = 0; i < loop.end; ++i) {
            for (const Argument& use : graph_.passes()[i].arguments) {
                if (use.isUse() && use.version.resource == resource && use.access != Access::Read) {
                    last = use.version.number;
                    first = i < loop.first ? last : first;
                }
            }
        }
        return { first, last };
    }

    const Graph& graph_;
    std::vector<std::vector<std::optional<Window>>> wanted_; ///< of each resource's versions
    std::vector<std::optional<Window>> windows_; ///< of each pass
    bool grew_ = false;
};

Plan::Plan(const Graph& ofGraph, std::uint64_t alignment, std::uint64_t mostSlabBytes)
    : graph(ofGraph)
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
            // All through the outermost of the loops that it comes into from outside.
            std::size_t first = i, last = i;
            for (int loop = passes[i].pass->loop;
                 loop >= 0 && !graph.holds(loop, graph.resources()[use.version.resource].loop);
                 loop = graph.loops()[static_cast<std::size_t>(loop)].parent) {
                for (; first > 0 && inside(first - 1, loop); --first) { }
                for (; last + 1 < passes.size() && inside(last + 1, loop); ++last) { }
            }
            live(use.version.resource, first, last);
        }
    }
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
    Placement placement = place(tenants, alignment, mostSlabBytes);
    for (std::size_t i = 0; i < tenants.size(); ++i) {
        places[resources[i]] = placement.places[i];
    }
    slabs = std::move(placement.slabs);
}

void Plan::addTo(device::MemoryPlan& memory) const
{
    for (std::size_t i = 0; i < slabs.size(); ++i) {
        memory.add(slabs.size() == 1 ? "planes" : fmt::format("planes, part {}", i + 1), slabs[i]);
    }
}

} // namespace wedge::graph
