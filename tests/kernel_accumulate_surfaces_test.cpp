// accumulate.cl alone, surfaces and point lights: pixels hold the means over their receivers.
#include "tests/surface_oracle.h"

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
                a.launch("accumulateDelta",
                    std::vector { plane("objectId", a.objectId),
                        vectors("lit", a.vectors([](const SeenPoint& p) { return p.irradiance; })),
                        vectors("delta", direct), plane("deltaSquares", squares) });
                accumulateSurfaces(a, surfaces);
            }
            const auto radiance = a.read(direct), squared = a.read(squares);
            checkElsewhere(a, radiance);
            checkElsewhere(a, squared);
            a.waves.everyPixel([&](int x, int y) {
                const std::vector<SeenPoint> seen = a.seen(x, y);
                const glm::dvec3 sum =
                    sumOf(seen, [](const SeenPoint& p) { return p.object != 0 ? p.irradiance : glm::dvec3(0); });
                const double n = std::max<double>(1, static_cast<double>(seen.size()));
                REQUIRE(nearTo(radiance.vector(x, y), sum / n));
                REQUIRE(nearTo(squared.at(x, y), sumOf(seen, [](const SeenPoint& p) {
                    return p.object != 0 ? std::pow(luminanceOf(p.irradiance), 2) : 0.0;
                }) / n));
            });
        }
    });
}

TEST_CASE("surfaces: means over hits of where they are, over samples of how they look; least, largest and counts; "
          "of lean frames, too")
{
    onEveryDevice([](const device::Device& device) {
        for (const Keeping& keeping :
            { Keeping { false, 0, true }, { true, 0.1f, true }, { true, 1.5f, true }, { true, 0.1f, false } })
            for (const Rounds& rounds : { oneRound, threeRounds }) {
                CAPTURE(keeping.lean);
                CAPTURE(keeping.oneVelocity);
                CAPTURE(rounds.size());
                Accumulation a(device, width, height, window, Receivers::All);
                a.lean = keeping.lean;
                a.oneVelocity = keeping.oneVelocity;
                a.moves = keeping.motion;
                SurfacePixels out(a);
                for (const auto& upTo : rounds) {
                    a.begin(upTo);
                    accumulateSurfaces(a, out);
                }
                const SurfaceKinds kinds = requireSurfaces(a, SurfacesFound(a, out), rounds, keeping);
                CHECK(kinds.mixed > 20);
                CHECK(kinds.missed > 3);
                CHECK(kinds.sharp > 20);
                CHECK(kinds.nearer > 10);
                CHECK(kinds.farther > 10);
                if (keeping.lean && keeping.motion) {
                    CHECK(kinds.motions[static_cast<int>(OneMotion::One)] > 20);
                    CHECK(kinds.motions[static_cast<int>(OneMotion::Several)] > 20);
                    CHECK(kinds.motions[static_cast<int>(OneMotion::Uncertain)] < 5);
                }
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
