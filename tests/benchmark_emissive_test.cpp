// The benchmark of meshes that emit, run as its users do but small.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

TEST_CASE("noise of a lamp beside a quad's, and times of many lights beside one's")
{
    const Workplace place;
    const Outcome outcome =
        place.run({ "--width", "64", "--height", "48", "--spp", "16", "--seeds", "4", "--json", "emissive.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("emissive.json"));
    CHECK(all["benchmark"] == "emissive");
    CHECK(all["claims"].size() == 6);
    const auto of = [&](const std::string& id) { return claim(all["claims"], "emissive." + id); };
    // A mesh of one parallelogram is sampled and filtered as a quad is, with other random numbers at most.
    for (const std::string kind : { "lamp.noise_vs_quad", "lamp.filtered_noise_vs_quad" }) {
        CAPTURE(kind);
        CHECK(of(kind)["goal"] == 1.3);
        CHECK(of(kind)["value"] > 0.7);
        CHECK(of(kind)["value"] < 1.3);
    }
    for (const std::string scene : { "thousand", "quads64" }) {
        CAPTURE(scene);
        CHECK(of(scene + ".time_vs_one")["value"] > 0);
        CHECK(of(scene + ".filtered_time_vs_one")["value"] > 0);
        CHECK(contains(outcome.out, scene));
    }
}

TEST_CASE("a wrong call says so")
{
    const Workplace place;
    CHECK(place.run({ "--seeds", "1" }).status == 2);
    CHECK(place.run({ "--spp", "8" }).status == 2);
}

} // namespace
} // namespace wedge::app::test
