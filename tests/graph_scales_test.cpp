// What graphs become whose planes are of several scales: windows against dependencies followed pixel by pixel.
#include "host/device/buffer.h"
#include "host/graph/explain.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>

using namespace wedge;
using namespace wedge::graph;
using device::PassKind;

namespace {

struct Brightness { };

constexpr Scale scales[] = { Scale::Full, Scale::Half, Scale::Quarter, Scale::Eighth };

int sideOf(Scale scale) { return static_cast<int>(scale); }

std::uint64_t sizeOf(int width, int height) { return PlaneLayout(width, height).size; }

std::string faultOf(const std::function<void()>& f)
{
    try {
        f();
    } catch (const std::logic_error& error) {
        return error.what();
    }
    return "";
}

void add(Graph& graph, const std::string& name, Scale scale, std::vector<Argument> arguments)
{
    graph.add({ .name = name,
        .kind = PassKind::Filter,
        .kernel = { .file = "none.cl", .name = name },
        .arguments = std::move(arguments),
        .domain = Domain::Pixels,
        .scale = scale });
}

/// Which pixels of a plane anybody needs.
struct Needed {
    int width, height;
    std::vector<bool> pixels = std::vector<bool>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));

    /// With its neighbours, those that there are.
    void mark(int x, int y, Reach reach)
    {
        for (int v = std::max(0, y - std::min(reach.y, height));
             v <= std::min(height - 1, y + std::min(reach.y, height)); ++v) {
            for (int u = std::max(0, x - std::min(reach.x, width));
                 u <= std::min(width - 1, x + std::min(reach.x, width)); ++u) {
                pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u)] =
                    true;
            }
        }
    }
    /// The least rectangle around them.
    Window around() const
    {
        Window out;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                if (pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width)
                        + static_cast<std::size_t>(x)]) {
                    out = out.with({ x, y, x + 1, y + 1 });
                }
            }
        }
        return out;
    }
};

/// Passes that each make or update one plane of any scale from older ones, and what is needed of each for a crop of the
/// last.
class RandomChain {
public:
    RandomChain(unsigned seed, int width, int height)
        : graph(width, height, sizeOf(width, height))
        , random_(seed)
    {
        for (std::size_t i = 0; i < 7; ++i) {
            pass(i);
        }
        const Handle<Brightness>& last = planes_[made_.back()];
        const Window all = graph.image(graph.resources()[last.resource].scale);
        const auto below = [this](int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); };
        const int x = below(all.x1), y = below(all.y1);
        wanted = { x, y, x + 1 + below(all.x1 - x), y + 1 + below(all.y1 - y) };
        graph.want(last, wanted);
    }

    /// The windows of the passes that are run, from the last to the first.
    std::vector<Window> windows() const
    {
        std::vector<std::vector<Needed>> needed; // of each plane's versions
        for (const Resource& resource : graph.resources()) {
            const Window all = graph.image(resource.scale);
            needed.emplace_back(resource.newest + 1, Needed { all.x1, all.y1 });
        }
        Needed& last = needed[planes_[made_.back()].resource].back();
        for (int y = wanted.y0; y < wanted.y1; ++y) {
            for (int x = wanted.x0; x < wanted.x1; ++x) {
                last.mark(x, y, {});
            }
        }
        std::vector<Window> out;
        for (std::size_t i = graph.passes().size(); i-- > 0;) {
            const Pass& pass = graph.passes()[i];
            const Argument& makes = pass.arguments.front();
            const Window covered = needed[makes.version.resource][makes.version.number].around();
            if (covered.empty()) {
                continue;
            }
            out.push_back(covered);
            for (const Argument& use : pass.arguments) {
                if (use.access != Access::Write) {
                    Needed& of =
                        needed[use.version.resource][use.version.number - (use.access == Access::Update ? 1 : 0)];
                    follow(covered, pass.scale, graph.resources()[use.version.resource].scale, use.reach, of);
                }
            }
        }
        return out;
    }

    Graph graph;
    Window wanted;

private:
    /// Marks what a window of a pass reads: pixel by pixel of the frame.
    void follow(const Window& covered, Scale passes, Scale planes, Reach reach, Needed& of) const
    {
        for (int y = 0; y < graph.image().y1; ++y) {
            for (int x = 0; x < graph.image().x1; ++x) {
                const int u = x / sideOf(passes), v = y / sideOf(passes);
                if (covered.contains({ u, v, u + 1, v + 1 })) {
                    of.mark(x / sideOf(planes), y / sideOf(planes), reach);
                }
            }
        }
    }

    void pass(std::size_t index)
    {
        constexpr Reach reaches[] = { around(0), { 1, 0 }, { 0, 2 }, around(3), around(1), wholeImage };
        std::vector<Argument> uses;
        const bool inPlace = index > 0 && random_() % 4 == 0;
        const std::size_t makes = inPlace ? random_() % planes_.size() : planes_.size();
        if (!inPlace) {
            planes_.push_back(graph.plane<Brightness>(
                "plane " + std::to_string(index), floats, scales[random_() % std::size(scales)]));
        }
        uses.push_back(inPlace ? updates("out", planes_[makes]) : writes("out", planes_[makes]));
        for (std::size_t other = 0; other < planes_.size(); ++other) {
            if (other != makes && random_() % 2 == 0) {
                uses.push_back(reads("in", planes_[other], reaches[random_() % (index % 3 == 0 ? 6 : 5)]));
            }
        }
        add(graph, "pass " + std::to_string(index), graph.resources()[planes_[makes].resource].scale, std::move(uses));
        made_.push_back(makes);
    }

    std::mt19937 random_;
    std::vector<Handle<Brightness>> planes_;
    std::vector<std::size_t> made_; ///< by each pass
};

} // namespace

TEST_CASE("windows are the least that hold what is needed, followed pixel by pixel")
{
    int passes = 0, part = 0;
    for (unsigned seed = 0; seed < 600; ++seed) {
        CAPTURE(seed);
        const int width = seed % 2 == 0 ? 37 : 16 + static_cast<int>(seed % 19), height = seed % 3 == 0 ? 23 : 9;
        const RandomChain chain(seed, width, height);
        const Plan plan(chain.graph, 64);
        std::vector<Window> windows;
        for (std::size_t i = plan.passes.size(); i-- > 0;) {
            const PlannedPass& planned = plan.passes[i];
            windows.push_back(planned.window);
            ++passes;
            part += planned.window != chain.graph.image(planned.pass->scale);
        }
        REQUIRE(windows == chain.windows());
    }
    CHECK(passes > 2000);
    CHECK(part > 700);
}

TEST_CASE("windows convert between scales, and those at the edges end with the image")
{
    const Graph graph(37, 23, sizeOf(37, 23));
    CHECK(graph.image(Scale::Full) == Window { 0, 0, 37, 23 });
    CHECK(graph.image(Scale::Half) == Window { 0, 0, 19, 12 });
    CHECK(graph.image(Scale::Quarter) == Window { 0, 0, 10, 6 });
    CHECK(graph.image(Scale::ThirtySecond) == Window { 0, 0, 2, 1 });
    CHECK(graph.converted({ 3, 4, 8, 9 }, Scale::Full, Scale::Half) == Window { 1, 2, 4, 5 });
    CHECK(graph.converted({ 3, 4, 19, 12 }, Scale::Half, Scale::Full) == Window { 6, 8, 37, 23 });
    CHECK(graph.converted({ 9, 5, 10, 6 }, Scale::Quarter, Scale::Half) == Window { 18, 10, 19, 12 });
    CHECK(graph.converted({ 9, 5, 9, 6 }, Scale::Quarter, Scale::Half).empty());
}

TEST_CASE("what covers everything covers all pixels of its scale")
{
    Graph graph(37, 23, sizeOf(37, 23));
    auto full = graph.plane<Brightness>("full", floats), half = graph.plane<Brightness>("half", floats, Scale::Half);
    auto list = graph.list<Brightness>("list", floats, 1);
    add(graph, "first", Scale::Full, { writes("out", full) });
    add(graph, "second", Scale::Half, { reads("in", full), writes("out", half) });
    add(graph, "third", Scale::Half, { reads("in", half), writes("out", list) });
    add(graph, "fourth", Scale::Full, { reads("list", list), updates("out", full) });
    graph.want(full, { 3, 4, 5, 6 });
    const Plan plan(graph, 64);
    std::vector<Window> windows;
    for (const PlannedPass& planned : plan.passes) {
        windows.push_back(planned.window);
    }
    const Window all { 0, 0, 37, 23 }, halves { 0, 0, 19, 12 };
    CHECK(windows == std::vector<Window> { all, halves, halves, { 3, 4, 5, 6 } });
}

TEST_CASE("a coarser plane takes its share of the memory")
{
    for (const Scale scale : scales) {
        Graph graph(4096, 3072, sizeOf(4096, 3072));
        auto plane = graph.plane<Brightness>("plane", vectors, scale);
        add(graph, "made", scale, { writes("out", plane) });
        graph.want(plane, graph.image(scale));
        const int side = sideOf(scale);
        const Plan plan(graph, device::partAlignment);
        REQUIRE(plan.slabs.size() == 1);
        CHECK(plan.slabs[0] == 12 * sizeOf(4096 / side, 3072 / side)); // rows are padded
        CHECK(static_cast<double>(plan.slabs[0]) < 1.15 * 12 * 4096 * 3072 / (side * side));
    }
}

TEST_CASE("what makes no sense between scales is named")
{
    Graph graph(37, 23, sizeOf(37, 23));
    auto full = graph.plane<Brightness>("full", floats), half = graph.plane<Brightness>("half", floats, Scale::Half);
    CHECK(faultOf([&] { add(graph, "shade", Scale::Full, { writes("out", half) }); })
        == "pass \"shade\" writes \"half\", which is of another scale than the pass");
    CHECK(faultOf([&] { add(graph, "shade", Scale::Half, { writes("out", full) }); })
        == "pass \"shade\" writes \"full\", which is of another scale than the pass");
    add(graph, "first", Scale::Full, { writes("out", full) });
    add(graph, "second", Scale::Half, { reads("in", full), writes("out", half) });
    CHECK(faultOf([&] { add(graph, "more", Scale::Quarter, { updates("out", half) }); })
        == "pass \"more\" updates \"half\", which is of another scale than the pass");
    CHECK(faultOf([&] {
        add(graph, "more", Scale::Half, { writes("out", half), tallies("count", full) });
    }) == "pass \"more\" updates \"full\", which is of another scale than the pass");
    CHECK(faultOf([&] { graph.want(half, graph.image()); }) == "\"half\" is wanted beyond its pixels, which are fewer");
    CHECK(faultOf([&] {
        graph.tiledLoop(
            "waves", 8, [](Run&) { return std::size_t { 1 }; },
            [&] { add(graph, "inside", Scale::Half, { updates("out", half) }); });
    }) == "pass \"inside\" updates \"half\", in a loop whose passes cover one window, and is of another scale");
}

TEST_CASE("a plan says of what scale things are, where that is not the frame's")
{
    Graph graph(37, 23, 4096);
    auto full = graph.plane<Brightness>("full", floats), half = graph.plane<Brightness>("half", floats, Scale::Half);
    add(graph, "first", Scale::Full, { writes("out", full) });
    add(graph, "second", Scale::Half, { reads("in", full), writes("out", half) });
    graph.want(half, graph.image(Scale::Half));
    CHECK(explain(Plan(graph, 64))
        == "passes\n"
           "   1  first [filter] first, 0..37 x 0..23: writes full\n"
           "   2  second [filter] second, 0..19 x 0..12 of 1/2: reads full; writes half\n"
           "\nresources\n"
           "  full                             float1        0.0 MiB  1-2       part 1 at 0\n"
           "  half                             float1        0.0 MiB  2-end     part 1 at 16384 of 1/2\n"
           "\nmemory of the planes: 0.0 MiB\n");
}
