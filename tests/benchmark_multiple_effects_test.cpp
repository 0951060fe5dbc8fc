// The benchmark of multiple effects, run as its users do but tiny: the form of what it writes, never a time.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

// Points of curves: a primary and a shadow ray a sample at least, and of paths two more.
const PointRule points { 3.9, { "mu", "rays", "rmse", "rmse_corrected", "seed", "spp" }, "rays" };

/// All claims have finite values; returns their quantities.
std::set<std::string> quantities(const Json& claims, const std::string& prefix)
{
    std::set<std::string> found;
    for (const Json& claim : claims) {
        CHECK(keys(claim) == std::set<std::string> { "goal", "id", "paper", "spread", "unit", "value" });
        const auto id = claim["id"].get<std::string>();
        REQUIRE(id.starts_with(prefix));
        CHECK(found.insert(id.substr(prefix.size())).second);
        CHECK_MESSAGE(claim["value"].is_number(), id);
        CHECK(claim["unit"].is_string());
    }
    return found;
}

TEST_CASE("results of a scene of the chapter have all that docs/benchmarks.md says")
{
    const Workplace place;
    const Json all = tinyResults(place, "toasters", { "--maps", "maps" });
    checkHead(all, "multiple_effects");
    const std::set<std::string> found = quantities(all["claims"], "multiple_effects.toasters.");
    for (const char* quantity : { "rays_saved", "rays_saved_vs_sobol", "rays_saved_published", "rays_saved_16spp",
             "error_falls", "rmse", "rmse_published", "rmse_ratio_fixed_blur", "rmse_ratio_no_factoring",
             "rmse_ratio_uniform_counts", "rays_per_pixel", "overhead", "overhead_published", "overhead_wall",
             "overhead_ms", "total_ms", "wall_gap", "mrays_s", "memory_bytes" }) {
        INFO(quantity);
        CHECK(found.count(quantity) == 1);
    }
    const auto quantity = [&](const char* name) {
        return claim(all["claims"], std::string("multiple_effects.toasters.") + name);
    };
    CHECK(quantity("rays_saved")["goal"] == 4);
    CHECK(quantity("rays_saved")["paper"] == 4);
    CHECK(quantity("rays_saved_vs_sobol")["goal"] == 3);
    CHECK(quantity("overhead")["paper"] == 0.055);
    CHECK(quantity("overhead")["goal"] == 0.055);
    CHECK(quantity("overhead_published")["goal"].is_null());
    CHECK(quantity("rays_per_pixel")["paper"] == 125);

    const Json& scene = all["scenes"][0];
    CHECK(scene["bounces"] == 1);
    REQUIRE(scene["references"].size() == 1);
    CHECK(scene["references"][0]["noise"].get<double>() > 0);
    REQUIRE(scene["settings"].size() == 2);
    for (const Json& setting : scene["settings"]) {
        checkTiming(setting);
        checkPoints(setting["method"], 2, points);
        REQUIRE(setting["baselines"].size() == 2);
        for (const Json& baseline : setting["baselines"]) {
            checkPoints(baseline["points"], 3, points);
            CHECK(baseline["rays_saved"]["median"].get<double>() > 0);
        }
    }
    REQUIRE(scene["curves"].size() == 5);
    for (const Json& curve : scene["curves"]) {
        checkPoints(curve["points"], curve["name"] == "published" ? 2 : 3, points);
    }
    CHECK(scene["curves"][4]["widths_pixels"].size() == scene["curves"][4]["points"].size());
    // Variants are renders of their own, not the default's read back.
    CHECK(scene["curves"][2]["points"] != scene["curves"][0]["points"]);
    CHECK(scene["curves"][3]["points"] != scene["curves"][0]["points"]);
    // Unfiltered, each sample of a pixel that sees something is a primary, a shadow, a path's and its shadow ray.
    const Json& unfiltered = scene["settings"][0]["baselines"][0]["points"][0];
    CHECK(unfiltered["rays"].get<double>() > 2 * unfiltered["spp"].get<double>());

    REQUIRE(scene["maps"].size() >= 4);
    for (const Json& map : scene["maps"]) {
        CHECK(place.has(map["file"].get<std::string>()));
        CHECK(map["high"].get<double>() > map["low"].get<double>());
    }
    CHECK(place.has("maps/toasters.png"));
}

TEST_CASE("errors alone have no times, and a pinhole scene is measured too")
{
    const Workplace place;
    const Json all = tinyResults(place, scenes + "/cornell.toml", { "--errors-only", "--maps", "maps" });
    const std::set<std::string> found = quantities(all["claims"], "multiple_effects.cornell.");
    CHECK(found.count("rays_saved") == 1);
    CHECK(found.count("rays_per_pixel") == 1);
    CHECK(found.count("total_ms") == 0);
    CHECK_FALSE(all["scenes"][0]["settings"][0].contains("timing"));
    CHECK(place.has("maps/cornell_samples.png"));
    CHECK_FALSE(place.has("maps/cornell_width_lens.png"));
    CHECK(all["scenes"][0]["paper"].is_null());
}

TEST_CASE("the scenes of the chapter are listed, and wrong calls end in one line")
{
    const Workplace place;
    const Outcome list = place.run({ "--list" });
    CHECK(list.status == 0);
    for (const char* name : { "chess ", "still_life ", "toasters ", "room " }) {
        CHECK(contains(list.out, name));
    }
    place.write("file", "");
    checkWrongCalls(place, "multiple_effects",
        {
            { { "--scene", "nothing" }, 2, "chess, still_life, toasters, room" },
            { { "--timing-only", "--errors-only" }, 2, "excludes" },
            { { "--scene", "toasters", "--timing-only", "--size", "16x16", "--maps", "file" }, 1, "folder for maps" },
        });
}

} // namespace
} // namespace wedge::app::test
