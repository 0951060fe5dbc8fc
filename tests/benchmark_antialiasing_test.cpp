// The benchmark of antialiasing, run as its users do but tiny: the form of what it writes, never a time.
#include "tests/benchmark_testing.h"

#include <cmath>

namespace wedge::app::test {
namespace {

TEST_CASE("curves of sampled squares, of four times the pixels and of unfiltered squares")
{
    const Workplace place;
    const Outcome outcome = place.run({ "--scene", box, "--size", "64", "--spp", "9", "16", "--large-spp", "9",
        "--reference-spp", "64", "--reference-dir", "references", "--json", "results.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["schema"] == 1);
    CHECK(all["benchmark"] == "antialiasing");
    CHECK_FALSE(all["device"].get<std::string>().empty());
    CHECK(all["side"] == 64);
    CHECK(all["reference_spp"] == 64);
    REQUIRE(all["scenes"].size() == 1);
    const Json& scene = all["scenes"][0];
    CHECK(scene["name"] == "cornell");
    CHECK(scene["reference_noise"].get<double>() > 0);
    REQUIRE(scene["curves"].size() == 3);
    const std::string names[] = { "antialiased", "four_times", "unfiltered" };
    for (std::size_t i = 0; i < 3; ++i) {
        const Json& curve = scene["curves"][i];
        CAPTURE(names[i]);
        CHECK(curve["name"] == names[i]);
        CHECK(contains(outcome.out, names[i]));
        REQUIRE(curve["points"].size() == (i == 1 ? 1u : 2u));
        for (const Json& point : curve["points"]) {
            CHECK(keys(point) == std::set<std::string> { "device_ms", "rays_per_pixel", "rmse", "spp" });
            CHECK(point["rmse"].get<double>() > 0);
            CHECK(point["rmse"].get<double>() < 0.05); // a black image's is 0.2
        }
    }
    // Unfiltered, each sample is a primary ray and, where it sees a surface, a shadow ray; of four times the pixels
    // each has one primary ray.
    const auto rays = [&](std::size_t curve) {
        return scene["curves"][curve]["points"][0]["rays_per_pixel"].get<double>();
    };
    const double surfaces = rays(2) / 9 - 1;
    CHECK(surfaces > 0.5);
    CHECK(surfaces < 1);
    CHECK(rays(1) == doctest::Approx(4 * (1 + 9 * surfaces)).epsilon(0.06));
    CHECK(place.has("references"));
}

TEST_CASE("what antialiasing costs")
{
    const Workplace place;
    const Outcome outcome = place.run({ "--costs", "--scene", box, "--size", "32", "--reference-spp", "1024",
        "--reference-dir", "references", "--json", "results.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(contains(outcome.out, "at equal error "));
    const Json all = Json::parse(place.text("results.json"));
    REQUIRE(all["claims"].size() == 2);
    for (const Json& claim : all["claims"])
        CHECK(claim["value"].get<double>() > 0);
    CHECK(all["claims"][0]["id"] == "antialiasing.cornell.time_vs_pinhole");
    CHECK(all["claims"][1]["id"] == "antialiasing.cornell.time_at_equal_error");
    REQUIRE(all["scenes"].size() == 1);
    CHECK(all["scenes"][0]["beyond"].get<bool>() == contains(outcome.out, "more than"));
}

TEST_CASE("wrong calls end in one line")
{
    const Workplace place;
    checkWrongCalls(place, "antialiasing",
        {
            { { "--scene", "nothing" }, 2, "cornell_figure, tentacles, chess, room" },
            { { "--size", "4" }, 2, "--size" },
            { { "--scene", box, "--size", "8", "--spp", "7", "--reference-spp", "16", "--reference-dir", "references" },
                2, "8 or more" },
            { { "--scene", box, "--size", "8", "--spp", "9", "--large-spp", "9", "--reference-spp", "16",
                  "--reference-dir", "references", "--json", "gone/r.json" },
                1, "gone/r.json" },
        });
}

} // namespace
} // namespace wedge::app::test
