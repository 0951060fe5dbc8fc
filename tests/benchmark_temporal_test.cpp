// The benchmark of the filter over time, run as its users do but tiny: the form of what it writes, never a time.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

TEST_CASE("variances of a still camera's frames and of a moving one's, with and without the filter")
{
    const Workplace place;
    const Outcome outcome =
        place.run({ "--scene", "sky", "--size", "32x24", "--spp", "16", "--seeds", "4", "--json", "results.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["benchmark"] == "temporal");
    const auto claim = [&](const std::string& id) {
        for (const Json& each : all["claims"]) {
            if (each["id"] == "environment.temporal." + id) {
                return each["value"].get<double>();
            }
        }
        FAIL("no claim " << id);
        return 0.0;
    };
    CHECK(claim("sky_still.variance_ratio") > 2.0);
    CHECK(claim("sky_moving.variance_ratio") > 0.5);
    CHECK(claim("sky_moving.variance_ratio") < claim("sky_still.variance_ratio"));
    CHECK(claim("sky_still.error_ratio") < 1.0);
    CHECK(claim("sky_still.uncovered_pixels") == 0.0);
    CHECK(claim("sky_moving.uncovered_pixels") > 0.0);
    // 1.3 where pixels were taken of which few see the surface.
    CHECK(claim("sky_moving.uncovered_error_ratio") > 0.3);
    CHECK(claim("sky_moving.uncovered_error_ratio") < 2.0);
    CHECK(claim("sky_still.overhead") < 1.0);
    CHECK(claim("sky_still.memory") > 0.0);
    const Outcome wrong = place.run({ "--spp", "2" });
    CHECK(wrong.status == 2);
}

} // namespace
} // namespace wedge::app::test
