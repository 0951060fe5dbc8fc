// What a graph becomes, without a device: random graphs are carried out on marks in place of memory and pixels.
#include "host/graph/explain.h"
#include "host/graph/interface.h"
#include "host/graph/plan.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>

using namespace wedge;
using namespace wedge::graph;
using device::PassKind;

namespace {

constexpr Format halfFloats { .name = "half1", .bytes = 2, .storage = "half" };

struct Metres { };
struct Radiance { };

constexpr std::uint64_t alignment = 64, noLimit = ~std::uint64_t { 0 };
constexpr int width = 80, height = 24;

std::string faultOf(const std::function<void()>& f)
{
    try {
        f();
    } catch (const std::logic_error& error) {
        return error.what();
    }
    return "";
}

std::vector<std::string> namesOf(const Plan& plan)
{
    std::vector<std::string> names;
    for (const PlannedPass& planned : plan.passes) {
        names.push_back(planned.pass->name);
    }
    return names;
}

using Names = std::vector<std::string>;

/// A pass of a kernel that nobody runs.
Pass passOf(const std::string& name, std::vector<Argument> arguments)
{
    return { .name = name,
        .kind = PassKind::Filter,
        .kernel = { .file = "none.cl", .name = name },
        .arguments = std::move(arguments) };
}

void add(Graph& graph, const std::string& name, std::vector<Argument> arguments)
{
    graph.add(passOf(name, std::move(arguments)));
}

const auto once = [](Run&) { return std::size_t { 1 }; };

/// Carries out a plan on marks: who wrote each unit of memory last, and which pixels of each resource hold what they
/// should.
class Simulation {
public:
    explicit Simulation(const Plan& plan)
        : plan_(plan)
        , valid_(plan.lifetimes.size(), std::vector<bool>(static_cast<std::size_t>(width) * height))
    {
        for (const std::uint64_t bytes : plan.slabs) {
            CHECK(bytes % alignment == 0);
            owners_.emplace_back(bytes / alignment, -1);
        }
    }

    void run(std::size_t begin, std::size_t end, int loop, std::mt19937& random)
    {
        for (std::size_t i = begin; i < end;) {
            int inner = plan_.passes[i].pass->loop;
            if (inner == loop) {
                step(plan_.passes[i++]);
                continue;
            }
            while (parent(inner) != loop) {
                inner = parent(inner);
            }
            std::size_t last = i;
            while (last < end && plan_.graph.holds(inner, plan_.passes[last].pass->loop)) {
                ++last;
            }
            const bool repeats = plan_.graph.loops()[static_cast<std::size_t>(inner)].repeats;
            for (auto k = repeats ? 1 + random() % 3 : 1; k > 0; --k) {
                run(i, last, inner, random);
            }
            i = last;
        }
    }

    void requireContents(std::size_t resource, const Window& window)
    {
        const Resource& r = plan_.graph.resources()[resource];
        eachUnit(resource, [&](int& owner) { faults += owner != static_cast<int>(resource); });
        for (int y = window.y0; r.plane && y < window.y1; ++y) {
            for (int x = window.x0; x < window.x1; ++x) {
                faults += !valid_[resource][static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
            }
        }
    }

    int faults = 0;

private:
    int parent(int loop) const { return plan_.graph.loops()[static_cast<std::size_t>(loop)].parent; }

    template <class F>
    void eachUnit(std::size_t resource, const F& f)
    {
        const Place& place = plan_.places[resource];
        const std::uint64_t units = plan_.graph.resources()[resource].bytes() / alignment;
        for (std::uint64_t u = 0; u < units; ++u) {
            f(owners_.at(place.slab).at(place.offset / alignment + u));
        }
    }

    void step(const PlannedPass& planned)
    {
        const Window& w = planned.window;
        for (const Argument& use : planned.pass->arguments) {
            if (use.access != Access::Write) {
                const int dx = std::min(use.reach.x, width), dy = std::min(use.reach.y, height);
                requireContents(use.version.resource,
                    w.empty() ? w
                              : Window { std::max(0, w.x0 - dx), std::max(0, w.y0 - dy), std::min(width, w.x1 + dx),
                                  std::min(height, w.y1 + dy) });
            }
        }
        for (const Argument& use : planned.pass->arguments) {
            if (use.access == Access::Read) {
                continue;
            }
            const std::uint32_t resource = use.version.resource;
            eachUnit(resource, [&](int& owner) { owner = static_cast<int>(resource); });
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    valid_[resource][static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] =
                        x >= w.x0 && x < w.x1 && y >= w.y0 && y < w.y1;
                }
            }
        }
    }

    const Plan& plan_;
    std::vector<std::vector<int>> owners_; ///< of each unit of each slab
    std::vector<std::vector<bool>> valid_;
};

/// A graph of random passes and loops that nothing is wrong with.
class RandomGraph {
public:
    explicit RandomGraph(unsigned seed)
        : graph(width, height, 7 * alignment / 4, static_cast<int>(seed % 3) * 5)
        , random_(seed)
    {
        body(0, 6);
        for (const Handle<Metres>& handle : handles_) {
            if (handle.number > 0 && random_() % 3 == 0 && graph.resources()[handle.resource].loop == -1) {
                graph.want(handle, randomWindow());
            }
        }
    }

    Graph graph;

private:
    void body(int depth, unsigned passes)
    {
        const std::size_t outer = handles_.size();
        for (unsigned i = 0; i < passes; ++i) {
            if (depth < 2 && random_() % 4 == 0) {
                const auto inner = [&] { body(depth + 1, 1 + random_() % 4); };
                if (random_() % 2 == 0) {
                    graph.loop("loop", once, inner);
                } else {
                    graph.only(
                        "condition", [](Run&) { return true; }, inner);
                }
            }
            onePass();
        }
        if (depth > 0) {
            handles_.resize(outer); // the body's own
        }
    }

    void onePass()
    {
        while (handles_.size() < 3 || random_() % 3 == 0) {
            const std::string name = "resource " + std::to_string(handles_.size());
            handles_.push_back(random_() % 3 == 0
                    ? graph.list<Metres>(name, floats, alignment / 4 * (1 + random_() % 6))
                    : graph.plane<Metres>(name, random_() % 2 == 0 ? vectors : floats));
        }
        std::vector<Argument> uses;
        std::vector<std::size_t> order(handles_.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            order[i] = i;
        }
        std::shuffle(order.begin(), order.end(), random_);
        uses.push_back(writes("out", handles_[order[0]]));
        for (std::size_t i = 1; i < std::min<std::size_t>(order.size(), 4); ++i) {
            Handle<Metres>& handle = handles_[order[i]];
            if (handle.number == 0) {
                continue;
            }
            if (random_() % 3 == 0) {
                uses.push_back(updates("inOut", handle));
            } else {
                constexpr Reach reaches[] = { around(0), { 1, 0 }, { 0, 5 }, around(17), wholeImage };
                uses.push_back(reads("in", handle, reaches[random_() % 5]));
            }
        }
        Pass pass = passOf("pass " + std::to_string(graph.passes().size()), std::move(uses));
        pass.everywhere = random_() % 8 == 0;
        pass.ofShown = random_() % 8 == 0;
        pass.constant = pass.arguments.size() == 1 && random_() % 2 == 0;
        graph.add(std::move(pass));
    }

    Window randomWindow()
    {
        const int x = static_cast<int>(random_() % width), y = static_cast<int>(random_() % height);
        return { x, y, x + 1 + static_cast<int>(random_() % static_cast<unsigned>(width - x)),
            y + 1 + static_cast<int>(random_() % static_cast<unsigned>(height - y)) };
    }

    std::mt19937 random_;
    std::vector<Handle<Metres>> handles_;
};

std::uint64_t mostAtOnce(const Plan& plan)
{
    std::uint64_t most = 0;
    for (std::uint32_t at = 0; at <= plan.passes.size(); ++at) {
        std::uint64_t sum = 0;
        for (const std::optional<Tenant>& life : plan.lifetimes) {
            sum += life && life->first <= at && at <= life->last ? life->bytes : 0;
        }
        most = std::max(most, sum);
    }
    return most;
}

} // namespace

TEST_CASE("random graphs: whoever reads finds what was written, on every pixel that is wanted")
{
    double used = 0, needed = 0;
    int passes = 0, left = 0;
    for (unsigned seed = 0; seed < 3000; ++seed) {
        CAPTURE(seed);
        const RandomGraph made(seed);
        const std::uint64_t limit = seed % 4 == 0 ? 24 * alignment : noLimit;
        const Plan plan(made.graph, alignment, { limit });
        Simulation simulation(plan);
        std::mt19937 random(seed);
        simulation.run(0, plan.passes.size(), -1, random);
        for (std::size_t i = 0; i < made.graph.resources().size(); ++i) {
            if (made.graph.resources()[i].wanted) {
                simulation.requireContents(i, *made.graph.resources()[i].wanted);
            }
        }
        REQUIRE(simulation.faults == 0);
        for (const std::uint64_t slab : plan.slabs) {
            CHECK((plan.slabs.size() == 1 || slab <= limit));
        }
        for (const std::uint64_t slab : limit == noLimit ? plan.slabs : std::vector<std::uint64_t>()) {
            used += static_cast<double>(slab);
            needed += static_cast<double>(mostAtOnce(plan));
        }
        passes += static_cast<int>(plan.passes.size());
        left += static_cast<int>(made.graph.passes().size() - plan.passes.size());
    }
    CHECK(passes > 3000);
    CHECK(left > 3000);
    // No plan can do with less than what lives at once.
    MESSAGE("memory over what lives at once: ", used / needed);
    CHECK(used >= needed);
    CHECK(used < 1.005 * needed);
}

TEST_CASE("where nothing may be shared, whatever needs memory has a piece of exactly its own")
{
    for (unsigned seed = 0; seed < 100; ++seed) {
        CAPTURE(seed);
        const RandomGraph made(seed);
        const Plan plan(made.graph, alignment, { 0, Sharing::Apart });
        std::set<std::uint32_t> taken;
        for (std::size_t i = 0; i < plan.lifetimes.size(); ++i) {
            if (plan.lifetimes[i] && !made.graph.resources()[i].imported) {
                const std::uint64_t bytes = made.graph.resources()[i].bytes();
                CHECK(taken.insert(plan.places[i].slab).second);
                CHECK(plan.slabs[plan.places[i].slab] == (bytes + alignment - 1) / alignment * alignment);
            }
        }
        CHECK(taken.size() == plan.slabs.size());
    }
}

TEST_CASE("where parts fail, pieces of memory are used in turns, each from its start")
{
    for (unsigned seed = 0; seed < 1000; ++seed) {
        CAPTURE(seed);
        const RandomGraph made(seed);
        const Plan plan(made.graph, alignment, { 0, Sharing::Turns });
        Simulation simulation(plan);
        std::mt19937 random(seed);
        simulation.run(0, plan.passes.size(), -1, random);
        REQUIRE(simulation.faults == 0);
        for (std::size_t i = 0; i < plan.lifetimes.size(); ++i) {
            if (!plan.lifetimes[i] || made.graph.resources()[i].imported) {
                continue;
            }
            CHECK(plan.places[i].offset == 0);
            CHECK(plan.slabs[plan.places[i].slab] >= made.graph.resources()[i].bytes());
            for (std::size_t other = 0; other < i; ++other) {
                const bool meet = plan.lifetimes[other] && !made.graph.resources()[other].imported
                    && plan.lifetimes[other]->meets(*plan.lifetimes[i]);
                CHECK_FALSE((meet && plan.places[other].slab == plan.places[i].slab));
            }
        }
    }
}

TEST_CASE("what is constant is made right before it is used, and stays in its loop")
{
    Graph graph(width, height, 1024);
    auto sum = graph.plane<Radiance>("sum", vectors), image = graph.plane<Radiance>("image", vectors);
    const auto zeros = [&](Handle<Radiance>& handle) {
        Pass pass = passOf("zeros", { writes("out", handle) });
        pass.constant = true;
        graph.add(std::move(pass));
    };
    zeros(sum);
    zeros(image);
    auto first = graph.plane<Metres>("first", floats);
    add(graph, "trace", { writes("out", first) });
    graph.loop("loop", once, [&] {
        auto own = graph.plane<Radiance>("own", vectors);
        zeros(own);
        add(graph, "sample", { reads("first", first), updates("image", image) });
        add(graph, "gather", { reads("in", image), updates("own", own) });
        add(graph, "add", { reads("in", own), updates("sum", sum) });
        zeros(image); // of the next iteration
    });
    graph.want(sum, { 0, 0, width, height });
    const Plan plan(graph, alignment);
    CHECK(namesOf(plan) == Names { "trace", "zeros", "zeros", "sample", "zeros", "gather", "add", "zeros" });
    CHECK(plan.lifetimes[sum.resource]->first == 2);
    Pass reading = passOf("reading", { reads("in", first), writes("out", image) });
    reading.constant = true;
    CHECK(faultOf([&] { graph.add(reading); })
        == "pass \"reading\" reads \"first\", though it is constant: it may write one resource, always");
}

TEST_CASE("what a body writes is what was there before where the body is left out")
{
    for (const bool repeats : { false, true }) {
        CAPTURE(repeats);
        Graph graph(width, height, 1024);
        auto radiance = graph.plane<Radiance>("radiance", vectors);
        auto mask = graph.plane<Metres>("mask", floats);
        add(graph, "noisy", { writes("out", radiance) });
        const auto body = [&] {
            auto own = graph.plane<Radiance>("own", vectors);
            add(graph, "first", { writes("out", own) });
            add(graph, "own", { writes("out", own) });
            add(graph, "filtered", { reads("in", own), writes("out", radiance), writes("mask", mask) });
        };
        if (repeats) {
            graph.loop("loop", once, body);
        } else {
            graph.only(
                "condition", [](Run&) { return false; }, body);
        }
        const Window wanted { 3, 2, 40, 20 };
        graph.want(radiance, wanted);
        const Plan plan(graph, alignment);
        // What the body has for itself is nobody else's, and its passes are run all or none.
        CHECK(namesOf(plan) == Names { "noisy", "own", "filtered" });
        CHECK(plan.passes.front().window == wanted);
        CHECK(plan.lifetimes[radiance.resource]->first == 0);
    }
}

TEST_CASE("what nobody wants is left out, and so is what only that needed")
{
    Graph graph(width, height, 1024);
    auto position = graph.plane<Metres>("position", vectors);
    auto radiance = graph.plane<Radiance>("radiance", vectors);
    auto layer = graph.plane<Radiance>("layer", vectors);
    auto onlyForLayer = graph.plane<Radiance>("only for the layer", vectors);
    add(graph, "trace", { writes("position", position) });
    add(graph, "prepare", { reads("position", position), writes("out", onlyForLayer) });
    add(graph, "shade", { reads("position", position), writes("out", radiance) });
    add(graph, "show", { reads("in", onlyForLayer), writes("out", layer) });
    Pass report = passOf("report", { reads("in", position) });
    report.always = true;
    graph.add(std::move(report));
    SUBCASE("one")
    {
        graph.want(radiance, { 0, 0, width, height });
        CHECK(namesOf(Plan(graph, alignment)) == Names { "trace", "shade", "report" });
    }
    SUBCASE("all")
    {
        graph.want(layer, { 0, 0, 1, 1 });
        graph.want(radiance, { 0, 0, width, height });
        CHECK(namesOf(Plan(graph, alignment)) == Names { "trace", "prepare", "shade", "show", "report" });
    }
    SUBCASE("none") { CHECK(namesOf(Plan(graph, alignment)) == Names { "trace", "report" }); }
}

TEST_CASE("an older version's maker is not needed where the next writes all anew, and is where it updates")
{
    for (const bool inPlace : { false, true }) {
        Graph graph(width, height, 1024);
        auto plane = graph.plane<Metres>("plane", floats);
        add(graph, "first", { writes("out", plane) });
        if (inPlace) {
            add(graph, "second", { updates("out", plane) });
        } else {
            add(graph, "second", { writes("out", plane) });
        }
        graph.want(plane, { 0, 0, width, height });
        CHECK(namesOf(Plan(graph, alignment)) == (inPlace ? Names { "first", "second" } : Names { "second" }));
    }
}

TEST_CASE("what is made on a condition alone may be what was there before")
{
    Graph graph(width, height, 1024);
    auto plane = graph.plane<Metres>("plane", floats);
    add(graph, "first", { writes("out", plane) });
    Pass second = passOf("second", { writes("out", plane) });
    second.condition = [](const Run&) { return false; };
    graph.add(std::move(second));
    graph.want(plane, { 0, 0, width, height });
    CHECK(namesOf(Plan(graph, alignment)) == Names { "first", "second" });
}

TEST_CASE("a loop keeps what it carries, and not what is its own")
{
    Graph graph(width, height, 1024);
    auto sums = graph.plane<Radiance>("sums", vectors);
    auto seldom = graph.plane<Radiance>("read at its start", vectors);
    auto image = graph.plane<Radiance>("image", vectors);
    add(graph, "clear", { writes("sums", sums) });
    add(graph, "begin", { writes("out", seldom) });
    graph.loop("waves", once, [&] {
        auto own = graph.plane<Radiance>("own", vectors);
        auto second = graph.plane<Radiance>("own, too", vectors);
        add(graph, "trace", { reads("seldom", seldom), writes("own", own) });
        add(graph, "shade", { reads("own", own), writes("second", second) });
        add(graph, "add", { reads("second", second), updates("sums", sums) });
        add(graph, "next", { writes("seldom", seldom) });
    });
    add(graph, "show", { reads("sums", sums), writes("image", image) });
    graph.want(image, { 0, 0, width, height });
    const Plan plan(graph, alignment);
    // "next" is behind all its readers, and is there for the next iteration's.
    CHECK(namesOf(plan) == Names { "clear", "begin", "trace", "shade", "add", "next", "show" });
    const auto life = [&](const char* name) {
        for (std::size_t i = 0; i < plan.lifetimes.size(); ++i) {
            if (graph.resources()[i].name == name) {
                return std::pair(plan.lifetimes[i]->first, plan.lifetimes[i]->last);
            }
        }
        return std::pair(99u, 99u);
    };
    CHECK(life("sums") == std::pair(0u, 6u));
    CHECK(life("read at its start") == std::pair(1u, 5u));
    CHECK(life("own") == std::pair(2u, 3u));
    CHECK(life("own, too") == std::pair(3u, 4u));
    CHECK(life("image") == std::pair(6u, 7u));
    // sums all through, and beside them three at most.
    CHECK(plan.slabs == std::vector<std::uint64_t> { 4 * 12 * 1024 });
}

TEST_CASE("a crop's windows grow backwards by what filters reach, and analyses cover everything")
{
    Graph graph(1000, 600, 1024);
    const Window crop { 100, 50, 130, 60 };
    auto first = graph.plane<Metres>("first", floats);
    auto samples = graph.plane<Metres>("samples", floats);
    auto rows = graph.plane<Metres>("rows", floats);
    auto image = graph.plane<Metres>("image", floats);
    auto scale = graph.list<Metres>("scale", floats, 1);
    add(graph, "first", { writes("first", first) });
    add(graph, "scale", { reads("first", first), writes("scale", scale) });
    add(graph, "sample", { reads("scale", scale), reads("first", first), writes("samples", samples) });
    add(graph, "rows", { reads("samples", samples, { .x = 20 }), writes("rows", rows) });
    add(graph, "columns", { reads("rows", rows, { .y = 4 }), writes("image", image) });
    graph.want(image, crop);
    const Plan plan(graph, alignment);
    std::vector<Window> windows;
    for (const PlannedPass& planned : plan.passes) {
        windows.push_back(planned.window);
    }
    const Window all { 0, 0, 1000, 600 };
    CHECK(windows == std::vector<Window> { all, all, { 80, 46, 150, 64 }, { 100, 46, 130, 64 }, crop });
    CHECK(reached({ 2, 0, 7, 5 }, around(1), { 0, 0, 20, 6 }) == Window { 1, 0, 8, 6 });
    CHECK(reached({ 0, 0, 7, 5 }, wholeImage, { 0, 0, 20, 6 }) == Window { 0, 0, 20, 6 });
    CHECK(reached({}, around(30), { 0, 0, 20, 6 }).empty());
}

TEST_CASE("what is beyond the image that is shown is made where it is read, and lists are of it unless they say other")
{
    Graph graph(100, 60, 1024, 10);
    const Window all { 0, 0, 100, 60 }, shown { 10, 10, 90, 50 };
    CHECK(graph.image() == all);
    CHECK(graph.shown() == shown);
    CHECK(graph.shown(Scale::Quarter) == Window { 2, 2, 23, 13 });
    CHECK(graph.layout(Scale::Full) == PlaneLayout(80, 40, 10));
    auto first = graph.plane<Metres>("first", floats), second = graph.plane<Metres>("second", floats);
    auto counted = graph.plane<Metres>("counted", floats), image = graph.plane<Metres>("image", floats);
    auto ofShown = graph.list<Metres>("list of the image", floats, 1);
    auto ofAll = graph.list<Metres>("list of all", floats, 1);
    const auto everywhere = [&](const char* name, std::vector<Argument> uses) {
        Pass pass = passOf(name, std::move(uses));
        pass.everywhere = true;
        graph.add(std::move(pass));
    };
    everywhere("first", { writes("first", first) });
    everywhere("second", { reads("first", first), writes("second", second) });
    Pass list = passOf("list of the image", { reads("second", second, { .x = 3 }), writes("list", ofShown) });
    list.ofShown = true;
    graph.add(std::move(list));
    add(graph, "counted", { reads("list", ofShown), writes("counted", counted) });
    add(graph, "list of all", { reads("counted", counted), writes("list", ofAll) });
    add(graph, "image", { reads("list", ofAll), reads("counted", counted), writes("image", image) });
    graph.want(image, { 30, 20, 40, 30 });
    std::vector<Window> windows;
    const Plan plan(graph, alignment);
    for (const PlannedPass& planned : plan.passes) {
        windows.push_back(planned.window);
    }
    const Window reach { 7, 10, 93, 50 };
    CHECK(windows == std::vector<Window> { reach, reach, shown, all, all, { 30, 20, 40, 30 } });
}

TEST_CASE("nothing is run for a tally's sake, and none is lost")
{
    Graph graph(width, height, 1024);
    const Window crop { 10, 10, 20, 20 };
    auto rays = graph.plane<Metres>("rays", counts), image = graph.plane<Metres>("image", floats);
    auto unused = graph.plane<Metres>("unused", floats), scale = graph.list<Metres>("scale", floats, 1);
    add(graph, "clear", { writes("rays", rays) });
    add(graph, "idle", { writes("out", unused), tallies("rays", rays) });
    add(graph, "traced", { writes("out", image), tallies("rays", rays) });
    add(graph, "analysed", { writes("scale", scale), tallies("rays", rays) });
    add(graph, "scaled", { reads("scale", scale), updates("image", image) });
    graph.want(image, crop);
    graph.want(rays, { 0, 0, width, height });
    const Plan plan(graph, alignment);
    CHECK(namesOf(plan) == Names { "clear", "traced", "analysed", "scaled" });
    CHECK(plan.passes[0].window == Window { 0, 0, width, height });
    CHECK(plan.passes[1].window == crop);
    CHECK(plan.passes[2].window == Window { 0, 0, width, height });
}

TEST_CASE("what is used wrongly is named")
{
    Graph graph(width, height, 1024), other(width, height, 1024);
    auto width0 = graph.plane<Metres>("width", floats);
    CHECK(faultOf([&] { add(graph, "filter", { reads("in", width0) }); })
        == "pass \"filter\" reads \"width\", which nothing has written before");
    const auto stale = width0;
    add(graph, "analyse", { writes("out", width0) });
    CHECK(faultOf([&] { add(graph, "filter", { reads("in", stale) }); })
        == "pass \"filter\" reads \"width\", of which it has an old version");
    auto staleToo = stale;
    CHECK(faultOf([&] { add(graph, "filter", { writes("out", staleToo) }); })
        == "pass \"filter\" writes \"width\", of which it has an old version");
    CHECK(faultOf([&] {
        graph.want(stale, { 0, 0, 1, 1 });
    }) == "pass \"the end\" reads \"width\", of which it has an old version");
    CHECK(faultOf([&] {
        add(graph, "filter", { reads("in", width0), updates("out", width0) });
    }) == "pass \"filter\" reads \"width\", which it also uses otherwise: update it in place");
    CHECK(faultOf([&] { add(other, "filter", { reads("in", width0) }); })
        == "pass \"filter\" reads a resource, which is of another graph");
    Handle<Metres> own;
    graph.loop("waves", once, [&] {
        own = graph.plane<Metres>("own", floats);
        add(graph, "trace", { writes("out", own) });
    });
    CHECK(faultOf([&] { add(graph, "filter", { reads("in", own) }); })
        == "pass \"filter\" reads \"own\", which is a loop's own, outside of it");
    auto fresh = graph.plane<Metres>("fresh", floats);
    CHECK(faultOf([&] {
        Pass unsure = passOf("second chance", { writes("out", fresh) });
        unsure.condition = [](const Run&) { return true; };
        graph.add(std::move(unsure));
    }) == "pass \"second chance\" writes \"fresh\", which nothing has written before, on a condition alone");
}

TEST_CASE("kernels are handed what their passes declare, and no other")
{
    Graph graph(width, height, 1024);
    auto position = graph.plane<Metres>("position", vectors);
    auto openness = graph.plane<Metres>("openness", halfFloats);
    add(graph, "trace", { writes("position", position) });
    add(graph, "shade",
        { value("scale", 2.0f), reads("where", position), absent("tint", vectors), writes("out", openness) });
    const std::string text = interfaceText(graph, graph.passes().back());
    CHECK(text.find("#define PARAMETERS const float scale, __global const float *restrict where, "
                    "__global half *restrict out\n")
        != std::string::npos);
    CHECK(text.find("#define LOAD_where(size, at) load_float3(where, size, at)") != std::string::npos);
    CHECK(text.find("#define STORE_out(size, at, value) store_half1(out, size, at, value)") != std::string::npos);
    // What there is not is read as nothing, and not written.
    CHECK(text.find("#define HAS_where 1\n") != std::string::npos);
    CHECK(text.find("#define HAS_tint 0\n") != std::string::npos);
    CHECK(text.find("#define LOAD_tint(size, at) ((void)(size), (void)(at), none_float3())") != std::string::npos);
    CHECK(text.find("#define STORE_tint(size, at, value) ((void)(size), (void)(at), (void)(value))")
        != std::string::npos);
    const auto both = programs(graph);
    CHECK(both[0] == both[1]); // of one file
    CHECK(both[0]->generated.contains("pass/trace.h"));
    CHECK(both[0]->generated.at("pass/shade.h") == text);
    auto mean = graph.plane<Metres>("mean", floats);
    add(graph, "shade",
        { value("scale", 2.0f), reads("where", position), absent("tint", vectors), writes("out", mean) });
    add(graph, "shade",
        { value("scale", 3.0f), reads("where", position), absent("tint", vectors), writes("out", openness) });
    const auto all = programs(graph);
    CHECK(all[2] != all[1]); // it hands the kernel something else
    CHECK(all[2]->file == all[1]->file);
    CHECK(all[3] == all[1]);
    struct Unknown {
        int x;
    };
    add(graph, "odd", { value("p", Unknown { 1 }) });
    CHECK(faultOf([&] { interfaceText(graph, graph.passes().back()); })
        == "pass \"odd\" has a value \"p\" of a type without a name");
}

TEST_CASE("planes of a group are read and written together, those that there are")
{
    Graph graph(width, height, 1024);
    auto colour = graph.plane<Radiance>("colour", vectors), black = graph.plane<Radiance>("black", vectors);
    auto depth = graph.plane<Metres>("depth", floats);
    add(graph, "trace", { writes("colour", colour), writes("black", black), writes("depth", depth) });
    add(graph, "shade",
        group("seen", { reads("depth", depth), updates("colour", colour), absent("weight"), updates("black", black) }));
    const std::string text = interfaceText(graph, graph.passes().back());
    CHECK(text.find("__global const float *restrict seen_depth, __global float *restrict seen_colour")
        != std::string::npos);
    CHECK(text.find("#define LOAD_seen(size, at, out) do { (out)->depth = LOAD_seen_depth(size, at); "
                    "(out)->colour = LOAD_seen_colour(size, at); (out)->black = LOAD_seen_black(size, at); "
                    "(out)->weight = LOAD_seen_weight(size, at); } while (0)\n")
        != std::string::npos);
    CHECK(text.find("#define STORE_seen(size, at, in) do { STORE_seen_colour(size, at, (in)->colour); "
                    "STORE_seen_black(size, at, (in)->black); } while (0)\n")
        != std::string::npos);
}

TEST_CASE("what belongs together keeps its own names, and is no structure of kernels")
{
    Graph graph(width, height, 1024);
    auto colour = graph.plane<Radiance>("colour", vectors);
    auto depth = graph.plane<Metres>("depth", floats);
    add(graph, "trace", { writes("colour", colour), writes("depth", depth) });
    const auto shade = [&](std::vector<Argument> arguments) {
        add(graph, "shade", std::move(arguments));
        return interfaceText(graph, graph.passes().back());
    };
    const std::vector<Argument> apart { reads("depth", depth), reads("colour", colour), absent("weight") };
    const std::string text = shade(together("seen", apart));
    CHECK(text == shade(apart));
    CHECK(std::ranges::all_of(graph.passes()[1].arguments, [](const Argument& use) { return use.group == "seen"; }));
    CHECK(std::ranges::all_of(graph.passes()[1].absent, [](const Argument& use) { return use.group == "seen"; }));
}

TEST_CASE("a plan explains itself, in words and as a drawing")
{
    Graph graph(width, height, 1024);
    auto position = graph.plane<Metres>("position & more", vectors);
    auto image = graph.plane<Radiance>("image", vectors);
    auto unused = graph.plane<Radiance>("unused", vectors);
    graph.loop("waves", once, [&] { add(graph, "trace", { writes("out", position) }); });
    add(graph, "idle", { writes("out", unused) });
    add(graph, "shade", { reads("in", position, around(3)), writes("out", image) });
    graph.want(image, { 16, 0, 32, 5 });
    const Plan plan(graph, alignment);
    CHECK(explain(plan)
        == "passes\n"
           "   1  waves: trace [filter] trace, 13..35 x 0..8: writes position & more\n"
           "   2  shade [filter] shade, 16..32 x 0..5: reads position & more; writes image\n"
           "   -  idle: nobody wants what it makes\n"
           "\nresources\n"
           "  position & more                  float3        0.0 MiB  1-2       part 1 at 0\n"
           "  image                            float3        0.0 MiB  2-end     part 1 at 12288\n"
           "\nmemory of the planes: 0.0 MiB\n");
    const std::string svg = drawing(plan);
    CHECK(svg.starts_with("<svg "));
    CHECK(svg.ends_with("</svg>\n"));
    CHECK(svg.find(">position &amp; more</text>") != std::string::npos);
    CHECK(svg.find("unused") == std::string::npos);
}

TEST_CASE("sizes beyond all numbers stay beyond, and are refused and not wrapped")
{
    Graph graph(width, height, ~std::uint64_t { 0 } / 5);
    auto plane = graph.plane<Metres>("plane", vectors);
    add(graph, "first", { writes("out", plane) });
    graph.want(plane, { 0, 0, 1, 1 });
    const Plan plan(graph, alignment);
    REQUIRE(plan.slabs.size() == 1);
    CHECK(plan.slabs[0] == ~std::uint64_t { 0 });
    device::MemoryPlan memory;
    plan.addTo(memory);
    CHECK(memory.total() == ~std::uint64_t { 0 });
}
