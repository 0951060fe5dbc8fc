// What a graph becomes, without a device: random graphs are carried out on marks in place of memory and pixels.
#include "tests/graph_cases.h"

#include <algorithm>
#include <random>
#include <set>

using namespace wedge;
using namespace wedge::graph;
using namespace wedge::graph::test;

namespace {

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
