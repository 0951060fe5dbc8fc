// The lottery, run as its users do but tiny: the form of what it writes, and that it goes on where it stopped.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

std::vector<std::string> tiny(const std::string& seeds)
{
    return { "--seeds", seeds, "--size", "16x12", "--reference-spp", "64", "--reference-dir", "references", "--json",
        "results.json" };
}

TEST_CASE("claims and scenes; a second call measures what is missing and keeps the rest")
{
    const Workplace place;
    const Outcome first = place.run(tiny("6:7"));
    REQUIRE_MESSAGE(first.status == 0, first.err);
    const Json before = Json::parse(place.text("results.json"));
    CHECK(before["benchmark"] == "lottery");
    CHECK(before["plan"]["budgets"] == Json::array({ 16, 28, 64, 256, 512 }));
    REQUIRE(before["scenes"].size() == 2);
    std::set<std::string> ids;
    for (const Json& claim : before["claims"]) {
        CHECK(keys(claim) == std::set<std::string> { "id", "value", "unit", "spread", "paper", "goal" });
        ids.insert(claim["id"].get<std::string>());
    }
    for (const char* id : { "lottery.direct.saved_time_median", "lottery.bounce.saved_time_median",
             "lottery.all.worse_than_mc", "lottery.all.behind_fixed_blur", "lottery.all.slower_than_mc",
             "lottery.all.slope_p95", "lottery.all.slope_worst", "lottery.all.bias_worst" }) {
        CHECK(ids.contains(id));
    }
    for (const Json& scene : before["scenes"]) {
        CHECK(scene["triangles"].get<int>() > 10);
        for (const char* method : { "mc", "aaf" }) {
            REQUIRE(scene[method].size() == 5);
            for (const Json& point : scene[method]) {
                CHECK(point["error"]["mse"].get<double>() > 0);
                CHECK(point["error"]["mse_trimmed"].get<double>() <= 1.000001 * point["error"]["mse"].get<double>());
                CHECK(point["device_ms"].get<double>() > 0);
            }
        }
        CHECK(scene["fixed_blur"]["mse"].get<double>() > 0);
    }
    CHECK(contains(first.out, "lottery.all.slope_worst"));

    const Outcome second = place.run(tiny("6:8"));
    REQUIRE_MESSAGE(second.status == 0, second.err);
    CHECK_FALSE(contains(second.err, "seed 6"));
    CHECK(contains(second.err, "seed 8"));
    const Json after = Json::parse(place.text("results.json"));
    REQUIRE(after["scenes"].size() == 3);
    CHECK(after["scenes"][0] == before["scenes"][0]);
    CHECK(after["scenes"][1] == before["scenes"][1]);
}

TEST_CASE("pictures and scene files where they are asked for")
{
    const Workplace place;
    const Outcome pictures = place.run({ "--seeds", "6", "--size", "16x12", "--reference-spp", "16", "--reference-dir",
        "references", "--images", "pictures" });
    REQUIRE_MESSAGE(pictures.status == 0, pictures.err);
    for (const char* what : { "reference", "mc", "aaf" })
        CHECK(place.has("pictures/lottery_6_" + std::string(what) + ".png"));
    const Outcome scenes = place.run({ "--seeds", "1001:1002", "--write-scenes", "scenes" });
    REQUIRE_MESSAGE(scenes.status == 0, scenes.err);
    CHECK(place.has("scenes/lottery_1001.toml"));
    CHECK(place.has("scenes/lottery_1002.obj"));
}

TEST_CASE("version 2 is another lottery, whose results are not mixed with the first one's")
{
    const Workplace place;
    std::vector<std::string> call = tiny("2022");
    call.insert(call.end(), { "--lottery-version", "2" });
    const Outcome outcome = place.run(call);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json results = Json::parse(place.text("results.json"));
    CHECK(results["plan"]["version"] == 2);
    CHECK(contains(results["scenes"][0]["hard_cases"].dump(), "textured_lamp"));
    CHECK(place.run(tiny("2022")).status == 1);
    const Outcome scenes = place.run({ "--seeds", "2022", "--lottery-version", "2", "--write-scenes", "scenes" });
    REQUIRE_MESSAGE(scenes.status == 0, scenes.err);
    CHECK(place.has("scenes/lottery2_2022.toml"));
    CHECK(contains(place.text("scenes/lottery2_2022.mtl"), "map_Ke lottery2_2022_screen.png"));
}

TEST_CASE("version 3 is written with its sky, and loads")
{
    const Workplace place;
    const Outcome scenes = place.run({ "--seeds", "2:3", "--lottery-version", "3", "--write-scenes", "scenes" });
    REQUIRE_MESSAGE(scenes.status == 0, scenes.err);
    CHECK(contains(place.text("scenes/lottery3_2.toml"), "[environment]\nradiance = ["));
    CHECK(contains(place.text("scenes/lottery3_3.toml"), "map = \"lottery3_3_sky.exr\""));
    std::vector<std::string> call = tiny("3");
    call.insert(call.end(), { "--lottery-version", "3" });
    const Outcome outcome = place.run(call);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(contains(Json::parse(place.text("results.json"))["scenes"][0]["hard_cases"].dump(), "clear_sky"));
}

TEST_CASE("wrong calls end in one line")
{
    const Workplace place;
    place.write("other.json", "{}");
    place.write("broken.json", "{ \"benchmark\": ");
    checkWrongCalls(place, "lottery",
        {
            { { "--seeds", "7:3" }, 2, "A up to B" },
            { { "--seeds", "x" }, 2, "whole numbers" },
            { { "--seeds", "1:99999999" }, 2, "at most" },
            { { "--size", "16" }, 2, "--size" },
            { { "--lottery-version", "4" }, 2, "--lottery-version" },
            { { "--seeds", "1", "--json", "other.json" }, 1, "other.json" },
            { { "--seeds", "1", "--json", "broken.json" }, 1, "broken.json" },
            { { "--seeds", "1", "--json", "gone/r.json" }, 1, "gone/r.json" },
        });
}

} // namespace
} // namespace wedge::app::test
