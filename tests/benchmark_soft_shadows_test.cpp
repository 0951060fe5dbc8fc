// The benchmark of soft shadows, run as its users do but tiny: the form of what it writes, never a time.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

const PointRule points { 8.9, { "mu", "rmse", "rmse_corrected", "seed", "shadow_rays", "spp" }, "shadow_rays" };

Json results(const Workplace& place, const std::vector<std::string>& more = {})
{
    return tinyResults(place, scenes + "/penumbra.toml", more);
}

void checkSetting(const Json& setting, std::size_t baselines)
{
    checkTiming(setting);
    checkPoints(setting["method"], 3, points);
    CHECK(setting["baselines"].size() == baselines);
    checkBaselines(setting, 3, points);
    checkPoints(setting["convergence"], 2, points);
}

TEST_CASE("results of a scene file have all that docs/benchmarks.md says")
{
    const Workplace place;
    const Json all = results(place);
    checkHead(all, "soft_shadows");
    checkClaims(all["claims"], "soft_shadows.penumbra.",
        { "samples_saved", "samples_saved_published", "samples_saved_vs_sobol", "samples_saved_vs_plain_mc",
            "rays_saved", "rmse_ratio_fixed_blur", "overhead", "overhead_published", "overhead_ms", "wall_gap", "rmse",
            "mu_monotonic", "mu_monotonic_published" });
    REQUIRE(all["scenes"].size() == 1);
    const Json& scene = all["scenes"][0];
    CHECK(scene["name"] == "penumbra");
    CHECK(scene["triangles"] == 4);
    CHECK(scene["paper"].is_null());
    REQUIRE(scene["references"].size() == 2);
    for (const Json& reference : scene["references"]) {
        CHECK(reference["noise"].get<double>() > 0);
        CHECK(reference["cached"] == false);
    }
    checkSetting(scene["settings"]["default"], 3);
    checkSetting(scene["settings"]["published"], 1);
    std::set<std::string> curves;
    for (const Json& curve : scene["curves"]) {
        checkPoints(curve["points"], 2, points);
        CHECK((curve["filter"] == "NAF") == curve["fixed_width_pixels"].is_number());
        curves.insert(curve["setting"].get<std::string>() + curve["sampling"].get<std::string>()
            + curve["filter"].get<std::string>());
    }
    CHECK(curves.size() == 12);

    // A second run reads the references and finds the same errors.
    const Json again = results(place);
    const Json& cached = again["scenes"][0];
    CHECK(cached["references"][0]["cached"] == true);
    CHECK(cached["settings"]["default"]["method"] == scene["settings"]["default"]["method"]);
    CHECK(cached["references"][0]["noise"] == scene["references"][0]["noise"]);
}

TEST_CASE("times alone need no references")
{
    const Workplace place;
    const Json all = results(place, { "--timing-only" });
    CHECK_FALSE(place.has("references"));
    CHECK(all["scenes"][0]["curves"].empty());
    CHECK(all["scenes"][0]["settings"]["published"]["timing"]["tracing"]["median"].get<double>() > 0);
}

TEST_CASE("the four scenes of the chapter, glossy and open ones and the authors' own are listed")
{
    const Workplace place;
    const Outcome outcome = place.run({ "--list" });
    CHECK(outcome.status == 0);
    for (const char* name : { "grids ", "bench ", "tentacles ", "spheres ", "cornell_glossy ", "lottery_97 ",
             "lottery_122 ", "aaf2012_grids_cut2", "aaf2012_spheres " }) {
        CHECK(contains(outcome.out, name));
    }
}

TEST_CASE("open ground under sharp highlights is measured like any scene")
{
    const Workplace place;
    // So many samples that the reference has less noise than filtered images.
    const Json all = tinyResults(place, "lottery_97", {}, "2048");
    const Json& scene = all["scenes"][0];
    CHECK(scene["curves"].empty());
    checkSetting(scene["settings"]["default"], 3);
    checkSetting(scene["settings"]["published"], 1);
    CHECK(claim(all["claims"], "soft_shadows.lottery_97.samples_saved")["goal"].is_null());
    CHECK(claim(all["claims"], "soft_shadows.lottery_97.rmse")["value"].get<double>() > 0);
}

TEST_CASE("wrong calls and files end in one line")
{
    const Workplace place;
    ::setenv("WEDGE_DATA", place.path().c_str(), 1); // no meshes there
    place.write("dark.toml", "[[mesh]]\nfile = \"" + scenes + "/meshes/quad.obj\"\n");
    checkWrongCalls(place, "soft_shadows",
        {
            { { "--nonsense" }, 2, "--nonsense" },
            { { "--scene", "atlantis" }, 2, "atlantis: name a scene file or one of grids" },
            { { "--scene", "aaf2012_grids" }, 1, "set WEDGE_DATA to the folder that holds aaf2012_grids/grids.obj" },
            { { "--size", "48" }, 2, "--size: 48" },
            { { "--size", "1x1" }, 2, "--size: 1x1" },
            { { "--scene", "dark.toml", "--device", "quantum" }, 1, "quantum" },
            { { "--scene", "dark.toml" }, 1, "no area light" },
            { { "--scene", "dark.toml", "--json", "missing/a.json" }, 1, "missing" },
        });
}

} // namespace
} // namespace wedge::app::test
