// shadow_edges.cl, kernel by kernel, against the host in double.
#include "tests/shadow_bench.h"

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

TEST_CASE("shadowMatte: what the light reaches, what it does not, and what faces away")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        const Seen s(traced);
        const auto origin = traced.matte.pixels<float>("origin");
        const auto rays = traced.matte.pixels<std::uint32_t>("rays");
        const scene::Geometry& g = traced.frame.scene().geometry;
        const bvh::Bvh hierarchy = bvh::build({ g.positions, g.indices });
        unsigned kinds[3] = {}, differ = 0;
        everyPixel(traced.frame.layout, [&](int x, int y) {
            const float v = s.matte.at(x, y);
            const double cosine = glm::dot(s.normal.vector(x, y), sunward);
            if (s.object.at(x, y) == 0 || cosine <= 0) {
                REQUIRE(v == WEDGE_MATTE_UNKNOWN);
                REQUIRE(rays.at(x, y) == 0);
                ++kinds[2];
                return;
            }
            REQUIRE(rays.at(x, y) == 1);
            const bool hidden = bvh::anyHit(hierarchy, { toVec3(origin.vector(x, y)), 0, toVec3(100.0 * sunward), 1 });
            REQUIRE((v == WEDGE_MATTE_LIT || v == WEDGE_MATTE_SHADOW));
            differ += (v == WEDGE_MATTE_SHADOW) == hidden ? 0 : 1;
            ++kinds[hidden ? 0 : 1];
        });
        for (const unsigned kind : kinds)
            CHECK(kind > 300);
        CHECK(differ <= 3); // rays through edges
    });
}

namespace {

/// Lists the edges of that matte, against the host.
void checkEdges(Traced& traced, const Seen& s)
{
    const std::vector<std::vector<Piece>> expected = piecesOfTiles(s);
    PassBench count(traced.frame, "countEdges"), list(traced.frame, "listEdges"), small(traced.frame, "listEdges");
    for (PassBench* bench : { &count, &list, &small }) {
        traced.give(*bench);
        bench->plane("matte", s.matte);
        bench->plane("objectId", s.object);
    }
    count.run();
    const std::vector<std::uint32_t> counts = count.read<std::uint32_t>("counts");
    REQUIRE(counts.size() == expected.size());
    std::vector<std::uint32_t> first;
    first.reserve(counts.size());
    std::uint32_t sum = 0;
    for (std::size_t tile = 0; tile < counts.size(); ++tile) {
        CHECK(counts[tile] == expected[tile].size());
        first.push_back(sum);
        sum += counts[tile];
    }
    CHECK(sum > 200);
    list.plane("first", first);
    list.run();
    const std::vector<float> edges = list.read<float>("edges");
    const std::vector<float> all = listOf(joinedPieces(expected), edges.size());
    double worst = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        worst = std::max(worst, std::abs(double { edges[i] } - all[i]));
    CHECK(worst < 1e-5);
    // Where there is no room nothing is written.
    small.plane("first", first);
    small.value("capacity", std::uint32_t { 100 });
    small.run();
    const std::vector<float> part = small.read<float>("edges");
    constexpr std::size_t end = 100 * WEDGE_EDGE_FLOATS;
    CHECK(std::equal(part.begin(), part.begin() + end, edges.begin()));
    CHECK(std::all_of(part.begin() + end, part.end(), [](float v) { return v == 0; }));
}

} // namespace

TEST_CASE("countEdges and listEdges: marching squares on surfaces, tile by tile, of hard and of soft mattes")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool soft : { false, true }) {
            CAPTURE(soft);
            Traced traced(device);
            Seen s(traced);
            // Noise, for all cases of the table, and objects that end in the midst of surfaces.
            std::mt19937 random(1);
            everyPixel(traced.frame.layout, [&](int x, int y) {
                float& v = s.matte.at(x, y);
                const bool atEdge = soft && random() % 8 == 0; // which is in shadow
                const double noise = atEdge ? 0.5 : soft ? uniform(random) : static_cast<double>(random() % 2);
                v = v >= 0 && y < 30 ? static_cast<float>(noise) : v;
                s.object.at(x, y) += s.object.at(x, y) != 0 && x > 50 ? 100 : 0;
            });
            checkEdges(traced, s);
        }
    });
}

TEST_CASE("boundEdges: boxes around 32 pieces each")
{
    onEveryDevice([](const device::Device& device) {
        Traced traced(device);
        PassBench bench(traced.frame, "boundEdges");
        std::mt19937 random(1);
        constexpr std::uint32_t count = 5 * WEDGE_EDGE_CHUNK + 7;
        std::vector<float> edges = someNumbers(random, bench.elements("edges"));
        bench.plane("edges", edges);
        bench.plane("listed", std::vector<std::uint32_t> { count, 0 });
        bench.run();
        const std::vector<float> boxes = bench.read<float>("boxes");
        const std::size_t room = boxes.size() / WEDGE_EDGE_BOX;
        for (std::size_t chunk = 0; chunk < 6; ++chunk)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                float lo = 2, hi = -2;
                for (std::size_t k = chunk * WEDGE_EDGE_CHUNK;
                     k < std::min<std::size_t>((chunk + 1) * WEDGE_EDGE_CHUNK, count); ++k) {
                    lo = std::min(lo, edges[WEDGE_EDGE_FLOATS * k + axis]);
                    hi = std::max(hi, edges[WEDGE_EDGE_FLOATS * k + axis]);
                }
                CHECK(boxes[axis * room + chunk] == lo);
                CHECK(boxes[(3 + axis) * room + chunk] == hi);
            }
        CHECK(std::ranges::count_if(boxes, [](float v) { return v != 0; }) == 6 * WEDGE_EDGE_BOX);
    });
}
