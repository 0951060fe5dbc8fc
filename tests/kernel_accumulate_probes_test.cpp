// Probes of samples, as accumulate.cl adds waves of receivers to their pixels, against their definition.
#include "tests/stored_samples_support.h"

// Behind the other, whose parameters are called as its constants are.
#include "tests/accumulate_oracle.h"

#include <algorithm>
#include <vector>

using namespace wedge;
using namespace wedge::test;

TEST_CASE("accumulateProbes: sums and surfaces of all waves, and rays of the image's pixels, the wave's, or none")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool ofImage : { false, true })
            for (const bool counts : { false, true }) {
                CAPTURE(ofImage);
                CAPTURE(counts);
                Accumulation a(device, width, height, window, Receivers::All);
                SurfacePixels surfaces(a);
                const auto found = a.pixelBuffer(3);
                const auto size = a.waves.layout.size;
                const auto seen = a.waves.bench.filled(size, 0u), rays = a.waves.bench.filled(size, 1u),
                           pathRays = a.waves.bench.filled(size, 2u);
                Planes<std::uint32_t> expectedRays(a.waves.layout, 1, 1u), expectedPaths(a.waves.layout, 1, 2u);
                for (const auto& upTo : threeRounds) {
                    a.begin(upTo);
                    a.launch("accumulateProbes",
                        std::vector { value("raysOfImage", ofImage ? 1u : 0u), plane("objectId", a.objectId),
                            plane("sums", a.vectors([](const SeenPoint& p) { return p.irradiance; })),
                            vectors("found", found), plane("seen", seen),
                            onlyIf(counts,
                                plane("rays",
                                    a.receiverBuffer<std::uint32_t>(
                                        1, [](const SeenPoint& p, std::size_t) { return p.rays; }))),
                            onlyIf(counts,
                                plane("pathRays",
                                    a.receiverBuffer<std::uint32_t>(
                                        1, [](const SeenPoint& p, std::size_t) { return p.pathRays; }))),
                            onlyIf(counts, plane("kept_rays", rays)),
                            onlyIf(counts, plane("kept_pathRays", pathRays)) });
                    for (std::size_t slot = 0; counts && slot < a.lists.wave.tiles * WEDGE_TILE_PIXELS; ++slot)
                        for (std::size_t r = a.lists.firsts[slot];
                             a.lists.counts[slot] > 0 && r < a.lists.firsts[slot] + a.lists.counts[slot]; ++r) {
                            const std::size_t to = ofImage ? expectedRays.index(a.lists.x(r), a.lists.y(r)) : slot;
                            expectedRays.values[to] += a.points[r].rays;
                            expectedPaths.values[to] += a.points[r].pathRays;
                        }
                    accumulateSurfaces(a, surfaces);
                }
                REQUIRE(a.waves.bench.read(rays) == expectedRays.values);
                REQUIRE(a.waves.bench.read(pathRays) == expectedPaths.values);
                const auto sums = a.read(found);
                const auto surfacesSeen = a.read(seen);
                everyPixelOf({ 0, 0, width, height }, [&](int x, int y) {
                    CAPTURE(x);
                    CAPTURE(y);
                    if (x < window.x0 || x >= window.x1 || y < window.y0 || y >= window.y1) {
                        REQUIRE(sums.vector(x, y) == glm::dvec3(Accumulation::elsewhere));
                        REQUIRE(surfacesSeen.at(x, y) == 0);
                        return;
                    }
                    std::vector<SeenPoint> points = a.seen(x, y);
                    std::erase_if(points, [](const SeenPoint& p) { return p.object == 0; });
                    REQUIRE(surfacesSeen.at(x, y) == points.size());
                    REQUIRE(nearTo(
                        sums.vector(x, y), sumOf(points, [](const SeenPoint& p) { return p.irradiance; }), 1e-5));
                });
            }
    });
}
