// The benchmark of first pictures, run as its users do but small.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

TEST_CASE("a first picture with an empty cache and with a full one")
{
    const Workplace place;
    const Outcome outcome =
        place.run({ "--scene", "cornell", "--rounds", "1", "--size", "32x24", "--json", "start.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(contains(outcome.out, "cornell"));
    const Json all = Json::parse(place.text("start.json"));
    CHECK(all["benchmark"] == "start");
    REQUIRE(all["claims"].size() == 2);
    const Json& cold = claim(all["claims"], "start.cold.cornell.seconds");
    CHECK(cold["goal"] == 4);
    CHECK(cold["unit"] == "s");
    CHECK(cold["value"] > 0);
    CHECK(claim(all["claims"], "start.warm.cornell.seconds")["value"] > 0);
    // What it needed is gone, with the caches.
    CHECK(std::filesystem::is_empty(place.temporary()));
}

TEST_CASE("a wrong call, and a render that fails, say so")
{
    const Workplace place;
    place.write("broken.toml", "[camera]\nnothing = 1\n");
    checkWrongCalls(place, "start",
        { { { "--rounds", "0" }, 2, "--rounds" }, { { "--scene", "none.toml" }, 2, "cornell" },
            { { "--scene", "broken.toml" }, 1, "broken.toml" } });
    CHECK(std::filesystem::is_empty(place.temporary()));
}

} // namespace
} // namespace wedge::app::test
