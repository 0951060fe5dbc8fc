// accumulate.cl alone, surfaces and point lights: pixels hold the means over their receivers.
#include "tests/accumulate_support.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

TEST_CASE("point lights: the mean of the receivers' radiance, black where there is no surface")
{
    onEveryDevice([](const device::Device& device) {
        for (const Rounds& rounds : { oneRound, threeRounds }) {
            Accumulation a(device, width, height, window, Receivers::All);
            const device::Buffer<float> direct = a.pixelBuffer(3);
            auto squares = a.pixelBuffer(1);
            SurfacePixels surfaces(a);
            for (const auto& upTo : rounds) {
                a.begin(upTo);
                a.launch("accumulateDelta", a.lists.pixelFirst, a.lists.pixelCount, a.primaryTaken, a.objectId,
                    a.vectors([](const SeenPoint& p) { return p.irradiance; }), direct, squares);
                accumulateSurfaces(a, surfaces);
            }
            const auto radiance = a.read(direct), squared = a.read(squares);
            checkElsewhere(a, radiance);
            checkElsewhere(a, squared);
            a.waves.everyPixel([&](int x, int y) {
                const std::vector<SeenPoint> seen = a.seen(x, y);
                const glm::dvec3 sum = sumOf(seen, [](const SeenPoint& p) { return p.object != 0 ? p.irradiance : glm::dvec3(0); });
                const double n = std::max<double>(1, static_cast<double>(seen.size()));
                REQUIRE(nearTo(radiance.vector(x, y), sum / n));
                REQUIRE(nearTo(squared.at(x, y), sumOf(seen, [](const SeenPoint& p) {
                    return p.object != 0 ? std::pow(luminanceOf(p.irradiance), 2) : 0.0;
                }) / n));
            });
        }
    });
}

TEST_CASE("surfaces: means over hits of where they are, over samples of how they look; least, largest and counts")
{
    onEveryDevice([](const device::Device& device) {
        for (const Rounds& rounds : { oneRound, threeRounds }) {
            CAPTURE(rounds.size());
            Accumulation a(device, width, height, window, Receivers::All);
            SurfacePixels out(a);
            for (const auto& upTo : rounds) {
                a.begin(upTo);
                accumulateSurfaces(a, out);
            }
            const auto object = a.read(out.object), rays = a.read(out.rays), pathRays = a.read(out.pathRays);
            const auto taken = a.read(a.primaryTaken), hits = a.read(a.hits);
            const auto position = a.read(out.position), normal = a.read(out.normal), gloss = a.read(out.gloss);
            const auto diffuse = a.read(out.diffuse), specular = a.read(out.specular), emission = a.read(out.emission);
            const auto emissionSquares = a.read(out.emissionSquares);
            const auto pixelSize = a.read(out.pixelSize), distance = a.read(out.distance);
            const auto confusion = a.read(out.confusion), motion = a.read(out.motion);
            for (const Planes<float>* planes :
                { &position, &normal, &diffuse, &emission, &emissionSquares, &distance, &confusion, &motion })
                checkElsewhere(a, *planes);
            const shared::CameraParams camera = lens();
            unsigned mixed = 0, missed = 0;
            a.waves.everyPixel([&](int x, int y) {
                const std::vector<SeenPoint> seen = a.seen(x, y);
                std::vector<SeenPoint> hit = seen;
                std::erase_if(hit, [](const SeenPoint& p) { return p.object == 0; });
                const double n = std::max<double>(1, static_cast<double>(seen.size()));
                const double h = std::max<double>(1, static_cast<double>(hit.size()));
                REQUIRE(taken.at(x, y) == seen.size());
                REQUIRE(hits.at(x, y) == hit.size());
                REQUIRE(rays.at(x, y) == sumOf(seen, [](const SeenPoint& p) { return p.rays; }));
                REQUIRE(pathRays.at(x, y) == sumOf(seen, [](const SeenPoint& p) { return p.pathRays; }));
                std::uint32_t expected = hit.empty() ? 0 : hit[0].object;
                for (const SeenPoint& p : hit)
                    expected = p.object == hit[0].object ? expected : 0xffffffffu;
                REQUIRE(object.at(x, y) == expected);
                mixed += expected == 0xffffffffu ? 1 : 0;
                REQUIRE(nearTo(emission.vector(x, y), sumOf(seen, [](const SeenPoint& p) { return p.emission; }) / n));
                // What is seen to emit may have no surface, like a light.
                REQUIRE(nearTo(emissionSquares.at(x, y),
                    sumOf(seen, [](const SeenPoint& p) { return std::pow(luminanceOf(p.emission), 2); }) / n));
                REQUIRE(nearTo(diffuse.vector(x, y), sumOf(hit, [](const SeenPoint& p) { return p.diffuse; }) / n));
                REQUIRE(nearTo(specular.vector(x, y), sumOf(hit, [](const SeenPoint& p) { return p.specular; }) / n));
                if (seen.empty())
                    return;
                double low = 1e30, high = -1e30;
                for (const SeenPoint& p : seen) {
                    const double r = camera.apertureRadius / camera.pixelStep * (1 / p.depth - 1 / camera.focusDistance);
                    low = std::min(low, r);
                    high = std::max(high, r);
                }
                REQUIRE(nearTo(confusion.at(x, y), low));
                REQUIRE(nearTo(confusion.at(x, y, 1), high));
                if (hit.empty()) {
                    ++missed;
                    // As far as one of them went.
                    REQUIRE(std::ranges::any_of(
                        seen, [&](const SeenPoint& p) { return static_cast<float>(p.depth) == distance.at(x, y); }));
                    return;
                }
                const glm::dvec3 mean = sumOf(hit, [](const SeenPoint& p) { return p.position; }) / h;
                REQUIRE(nearTo(position.vector(x, y), mean));
                const shared::Vec3 eye = a.waves.params.eye;
                REQUIRE(nearTo(distance.at(x, y), glm::distance(mean, glm::dvec3(eye.x, eye.y, eye.z))));
                REQUIRE(nearTo(gloss.at(x, y), sumOf(hit, [](const SeenPoint& p) { return p.gloss; }) / h));
                REQUIRE(nearTo(pixelSize.at(x, y), sumOf(hit, [](const SeenPoint& p) { return p.pixelSize; }) / h));
                // A unit vector is added to as if it were the sum: of much the same normals that makes little.
                const glm::dvec3 facing = glm::normalize(sumOf(hit, [](const SeenPoint& p) { return p.normal; }));
                REQUIRE(glm::length(normal.vector(x, y) - facing) < (rounds.size() == 1 ? 1e-5 : 1e-3));
                const glm::dvec2 moves = sumOf(hit, [](const SeenPoint& p) { return p.motion; }) / h;
                REQUIRE(nearTo(motion.at(x, y), moves.x));
                REQUIRE(nearTo(motion.at(x, y, 1), moves.y));
                double spread = 0, apart = 0;
                for (const SeenPoint& p : hit) {
                    spread = std::max(spread, glm::distance(p.motion, moves));
                    for (const SeenPoint& q : hit)
                        apart = std::max(apart, glm::distance(p.motion, q.motion));
                }
                if (rounds.size() == 1)
                    REQUIRE(nearTo(motion.at(x, y, 2), spread));
                // From a mean that itself moves while waves come in.
                REQUIRE(motion.at(x, y, 2) >= (hit.size() > 1 ? 0.1 * apart : 0.0) - 1e-5);
                REQUIRE(motion.at(x, y, 2) <= apart + 1e-5);
            });
            CHECK(mixed > 20);
            CHECK(missed > 3);
        }
    });
}

TEST_CASE("a pinhole has no circles of confusion, whatever is in view")
{
    onEveryDevice([](const device::Device& device) {
        Accumulation a(device, width, height, window, Receivers::All);
        SurfacePixels out(a);
        a.begin(total);
        shared::CameraParams pinhole = lens();
        pinhole.apertureRadius = 0;
        accumulateSurfaces(a, out, pinhole);
        const auto confusion = a.read(out.confusion);
        a.waves.everyPixel([&](int x, int y) {
            REQUIRE(confusion.at(x, y) == 0);
            REQUIRE(confusion.at(x, y, 1) == 0);
        });
    });
}
