// The benchmark of frames' memory, run as its users do but small.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

TEST_CASE("memory of five kinds of frames, beside what it may be")
{
    const Workplace place;
    const Outcome outcome = place.run({ "--size", "1024", "--plan-only", "--json", "memory.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("memory.json"));
    CHECK(all["benchmark"] == "frame_memory");
    const auto of = [&](const std::string& id) { return claim(all["claims"], "frame_memory." + id); };
    for (const std::string kind : { "pinhole", "lens", "progressive", "layers" }) {
        CAPTURE(kind);
        CHECK(contains(outcome.out, kind));
        const double mebibytes = of(kind + ".mebibytes")["value"];
        CHECK(mebibytes == doctest::Approx(of(kind + ".bytes_per_pixel")["value"].get<double>()));
        CHECK(of(kind + ".mebibytes")["goal"].is_number());
    }
    CHECK(of("direct_4k.bytes_per_pixel")["goal"] == 150);
    // Goals that are reached, and what was reached where they are not.
    CHECK(of("lens.mebibytes")["value"] < 144);
    CHECK(of("layers.mebibytes")["value"] < 400);
    CHECK(of("pinhole.mebibytes")["value"] < 165);
    CHECK(of("progressive.mebibytes")["value"] < 420);
    CHECK(of("direct_4k.bytes_per_pixel")["value"] < 150);
    CHECK(of("pinhole.further_light_mebibytes")["value"] < 24);
    // The frame of one light is at what it has in use at once, that of two is not: it is the sum that counts.
    CHECK(of("lens.further_light_mebibytes")["value"] < 28);
    CHECK(
        of("lens.further_light_mebibytes")["value"].get<double>() + of("lens.mebibytes")["value"].get<double>() < 172);
    CHECK(of("lens.further_light_mebibytes")["goal"] == 24);
    CHECK(of("layers.further_light_mebibytes")["goal"].is_null());
}

TEST_CASE("what is planned is what is allocated")
{
    const Workplace place;
    const Outcome outcome = place.run({ "--size", "128", "--json", "memory.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json all = Json::parse(place.text("memory.json"));
    for (const std::string kind : { "pinhole", "lens", "progressive", "layers", "direct_4k" }) {
        CAPTURE(kind);
        const Json& ratio = claim(all["claims"], "frame_memory." + kind + ".planned_vs_allocated");
        CHECK(ratio["goal"] == 1);
        CHECK(ratio["unit"] == "1");
        // Tables of lights and what stands in for what a scene lacks, a few KB, are not planned.
        CHECK(ratio["value"].get<double>() == doctest::Approx(1.0).epsilon(0.001));
    }
}

TEST_CASE("a wrong call says so")
{
    const Workplace place;
    CHECK(place.run({ "--size", "0" }).status == 2);
    CHECK(place.run({ "--scene", "none.toml" }).status == 2);
}

} // namespace
} // namespace wedge::app::test
