// The benchmark of several filters of shadows, run as its users do but tiny: the form of what it writes, never a time.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

TEST_CASE("several filters of a light's shadows against one")
{
    const Workplace place;
    const Outcome outcome =
        place.run({ "--scene", "penumbra", "--size", "48x36", "--timed-size", "48x36", "--spp", "16", "--seeds", "1",
            "--frames", "1", "--reference-spp", "256", "--reference-dir", ".", "--json", "results.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["benchmark"] == "maaf");
    const auto valueOf = [&](const std::string& id) {
        for (const Json& each : all["claims"]) {
            if (each["id"] == "maaf.penumbra." + id) {
                return each["value"];
            }
        }
        FAIL("no claim " << id);
        return Json();
    };
    const auto claim = [&](const std::string& id) {
        const Json value = valueOf(id);
        REQUIRE_MESSAGE(value.is_number(), id << ": " << value.dump());
        return value.get<double>();
    };
    for (const std::string rival : { "aaf", "means", "thesis" }) {
        // Null of both where the rival does not get as far with any number of samples.
        const Json speedup = valueOf("speedup_vs_" + rival), samples = valueOf("samples_vs_" + rival);
        CHECK(speedup.is_null() == samples.is_null());
        for (const Json& value : { speedup, samples }) {
            CAPTURE(value.dump());
            CHECK((value.is_null() || (value.is_number() && value > 0.0)));
        }
    }
    CHECK(claim("filtered_share") > 0.05);
    CHECK(claim("filtered_share") <= 1.0);
    CHECK(claim("memory_vs_aaf") >= 1.0);
    CHECK(claim("memory_vs_aaf") <= 2.0);
    CHECK(claim("overhead") < 1.0);
    CHECK(claim("rmse_vs_aaf_refitted") > 0.0);
    CHECK(claim("rmse_vs_aaf_printed") > 0.0);
    const Outcome wrong = place.run({ "--spp", "2" });
    CHECK(wrong.status == 2);
}

} // namespace
} // namespace wedge::app::test
