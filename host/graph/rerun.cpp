#include "host/graph/rerun.h"

#include <algorithm>
#include <optional>

namespace wedge::graph {
namespace {

/// Who makes which version of which resource, among the passes that are run.
class Makers {
public:
    Makers(const Graph& graph, const std::vector<PlannedPass>& passes)
        : graph_(graph)
        , of_(graph.resources().size())
    {
        for (std::size_t i = 0; i < of_.size(); ++i) {
            of_[i].resize(graph.resources()[i].newest + 1);
        }
        for (std::size_t i = 0; i < passes.size(); ++i) {
            for (const Argument& use : passes[i].pass->arguments) {
                if (use.isUse() && use.access != Access::Read) {
                    of_[use.version.resource][use.version.number] = i;
                }
            }
        }
    }

    /// Of what a version holds: passes that nobody needs leave what was there before. None: it was there when the graph
    /// began.
    std::optional<std::size_t> of(std::uint32_t resource, std::uint32_t version) const
    {
        const auto& makers = of_[resource];
        for (std::uint32_t k = version + 1; k-- > 0;) {
            if (makers[k]) {
                return makers[k];
            }
        }
        return std::nullopt;
    }

    /// Those of later versions.
    std::vector<std::size_t> after(std::uint32_t resource, std::uint32_t version) const
    {
        std::vector<std::size_t> out;
        for (std::uint32_t k = version + 1; k < of_[resource].size(); ++k) {
            if (of_[resource][k]) {
                out.push_back(*of_[resource][k]);
            }
        }
        return out;
    }

    /// The version whose contents a pass goes by where it uses a resource; none: it makes all of it anew.
    std::optional<std::uint32_t> neededBy(const Pass& pass, const Argument& use) const
    {
        if (use.access == Access::Read) {
            return use.version.number;
        }
        const bool maybe = pass.condition || pass.loop != graph_.resources()[use.version.resource].loop;
        return use.access == Access::Update || maybe ? std::optional(use.version.number - 1) : std::nullopt;
    }

private:
    const Graph& graph_;
    std::vector<std::vector<std::optional<std::size_t>>> of_; ///< of each resource's versions
};

bool repeats(const Graph& graph, int loop)
{
    for (; loop >= 0; loop = graph.loops()[static_cast<std::size_t>(loop)].parent) {
        if (graph.loops()[static_cast<std::size_t>(loop)].repeats) {
            return true;
        }
    }
    return false;
}

} // namespace

std::vector<bool> changingPasses(const std::vector<PlannedPass>& passes)
{
    std::vector<bool> out(passes.size());
    for (std::size_t i = 0; i < passes.size(); ++i) {
        out[i] = std::ranges::any_of(passes[i].pass->arguments, &Argument::changing);
    }
    return out;
}

std::vector<bool> dependents(const Graph& graph, const std::vector<PlannedPass>& passes, std::vector<bool> first)
{
    const Makers makers(graph, passes);
    std::vector<bool> runs = std::move(first);
    bool grew = true;
    const auto add = [&](std::size_t pass) {
        grew = grew || !runs[pass];
        runs[pass] = true;
    };
    while (grew) {
        grew = false;
        for (std::size_t i = 0; i < passes.size(); ++i) {
            for (const Argument& use : passes[i].pass->arguments) {
                if (!use.isUse()) {
                    continue;
                }
                const std::uint32_t resource = use.version.resource;
                const std::optional<std::uint32_t> needed = makers.neededBy(*passes[i].pass, use);
                const std::optional<std::size_t> maker = needed ? makers.of(resource, *needed) : std::nullopt;
                if (maker && runs[*maker]) {
                    add(i);
                }
                if (!runs[i]) {
                    continue;
                }
                if (use.access != Access::Read && graph.resources()[resource].imported) {
                    return {};
                }
                // What was overwritten is made again, and what overwrote it writes over it again.
                const std::vector<std::size_t> later = makers.after(resource, needed.value_or(use.version.number));
                if (maker && !later.empty()) {
                    add(*maker);
                }
                if (use.access != Access::Read) {
                    std::ranges::for_each(makers.after(resource, use.version.number), add);
                }
            }
        }
    }
    for (std::size_t i = 0; i < passes.size(); ++i) {
        if (runs[i] && repeats(graph, passes[i].pass->loop)) {
            return {};
        }
    }
    return runs;
}

} // namespace wedge::graph
