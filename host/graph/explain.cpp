#include "host/graph/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace wedge::graph {
namespace {

/// Indices of resources with a lifetime, in order of first use, then of places.
std::vector<std::size_t> livingResources(const Plan& plan)
{
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < plan.lifetimes.size(); ++i) {
        if (plan.lifetimes[i]) {
            order.push_back(i);
        }
    }
    std::stable_sort(order.begin(), order.end(),
        [&](std::size_t a, std::size_t b) { return plan.lifetimes[a]->first < plan.lifetimes[b]->first; });
    return order;
}

std::string usesOf(const Plan& plan, const Pass& pass)
{
    constexpr const char* names[] = { "reads", "writes", "updates" };
    std::string text;
    for (const Access access : { Access::Read, Access::Update, Access::Write }) {
        std::string list;
        for (const Argument& use : pass.arguments) {
            if (use.isUse() && use.access == access) {
                list += (list.empty() ? " " : ", ") + plan.graph.resources()[use.version.resource].name;
            }
        }
        if (!list.empty()) {
            text += fmt::format("{}{}{}", text.empty() ? "" : "; ", names[static_cast<int>(access)], list);
        }
    }
    return text;
}

std::string escaped(const std::string& text)
{
    std::string out;
    for (const char c : text) {
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    }
    return out;
}

/// Said of what is not of the frame's scale.
std::string scaleOf(Scale scale)
{
    return scale == Scale::Full ? "" : fmt::format(" of 1/{}", static_cast<int>(scale));
}

std::string lifeOf(const Plan& plan, std::size_t resource)
{
    const Tenant& life = *plan.lifetimes[resource];
    return life.last == plan.passes.size() ? fmt::format("{}-end", life.first + 1)
                                           : fmt::format("{}-{}", life.first + 1, life.last + 1);
}

} // namespace

std::string explain(const Plan& plan)
{
    std::string text = "passes\n";
    std::set<const Pass*> run;
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        const Pass& pass = *plan.passes[i].pass;
        const Window& w = plan.passes[i].window;
        run.insert(&pass);
        std::string loops;
        for (int loop = pass.loop; loop >= 0; loop = plan.graph.loops()[static_cast<std::size_t>(loop)].parent) {
            loops = fmt::format("{}: {}", plan.graph.loops()[static_cast<std::size_t>(loop)].name, loops);
        }
        text += fmt::format("{:>4}  {}{} [{}] {}, {}..{} x {}..{}{}: {}\n", i + 1, loops, pass.name,
            device::passKindName(pass.kind), pass.domain == Domain::Host ? "host" : pass.kernel.name, w.x0, w.x1, w.y0,
            w.y1, scaleOf(pass.scale), usesOf(plan, pass));
    }
    for (const Pass& pass : plan.graph.passes()) {
        if (!run.contains(&pass)) {
            text += fmt::format("   -  {}: nobody wants what it makes\n", pass.name);
        }
    }
    text += "\nresources\n";
    for (const std::size_t i : livingResources(plan)) {
        const Resource& resource = plan.graph.resources()[i];
        text += fmt::format("  {:<32} {:<8} {:>12}  {:<9} {}{}\n", resource.name, resource.format.name,
            device::mebibytes(resource.bytes()), lifeOf(plan, i),
            resource.imported ? std::string("lives elsewhere")
                              : fmt::format("part {} at {}", plan.places[i].slab + 1, plan.places[i].offset),
            scaleOf(resource.scale));
    }
    const std::uint64_t bytes = std::accumulate(plan.slabs.begin(), plan.slabs.end(), std::uint64_t { 0 });
    return text + fmt::format("\nmemory of the planes: {}\n", device::mebibytes(bytes));
}

std::string drawing(const Plan& plan)
{
    constexpr int left = 240, top = 170, column = 18, row = 16;
    const std::vector<std::size_t> resources = livingResources(plan);
    const int width = left + column * static_cast<int>(plan.passes.size() + 2);
    const int height = top + row * static_cast<int>(resources.size() + 1);
    std::string svg = fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                                  "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" font-size=\"11\">\n"
                                  "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
        width, height);
    const auto x = [&](std::size_t pass) { return left + column * static_cast<int>(pass); };
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        svg += fmt::format("<text transform=\"translate({},{}) rotate(-60)\">{}</text>\n", x(i) + 10, top - 8,
            escaped(plan.passes[i].pass->name));
    }
    for (std::size_t k = 0; k < resources.size(); ++k) {
        const std::size_t i = resources[k];
        const Tenant& life = *plan.lifetimes[i];
        const int y = top + row * static_cast<int>(k);
        svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", left - 8, y + 11,
            escaped(plan.graph.resources()[i].name));
        svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", x(life.first), y + 2,
            column * static_cast<int>(life.last - life.first + 1), row - 4,
            plan.graph.resources()[i].imported ? "#ddd" : "#9cc3e6");
        for (std::size_t p = 0; p < plan.passes.size(); ++p) {
            for (const Argument& use : plan.passes[p].pass->arguments) {
                if (use.isUse() && use.version.resource == i) {
                    svg += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"4\" fill=\"{}\" stroke=\"#333\"/>\n",
                        x(p) + column / 2, y + row / 2, use.access == Access::Read ? "white" : "#333");
                }
            }
        }
    }
    return svg + "</svg>\n";
}

} // namespace wedge::graph
