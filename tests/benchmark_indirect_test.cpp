// The benchmark of indirect light, run as its users do but tiny: the form of what it writes, never a time.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

const PointRule points { 15.9, { "mu", "rays", "rmse", "rmse_corrected", "seed", "spp" }, "rays" };

/// A tiny run over a scene; fails the test unless it succeeds.
Json results(const Workplace& place, const std::string& scene, const std::vector<std::string>& more = {})
{
    return tinyResults(place, scene, more);
}

void checkSetting(const Json& setting)
{
    checkTiming(setting);
    checkPoints(setting["method"], 2, points);
    REQUIRE(setting["baselines"].size() == 2);
    CHECK(setting["baselines"][0]["name"] == "stratified");
    CHECK(setting["baselines"][1]["name"] == "sobol");
    checkBaselines(setting, 2, points);
}

TEST_CASE("results of a scene file have all that docs/benchmarks.md says")
{
    const Workplace place;
    const Json all = results(place, scenes + "/cornell.toml");
    checkHead(all, "indirect");
    checkClaims(all["claims"], "indirect.cornell.",
        { "samples_saved", "samples_saved_published", "samples_saved_vs_sobol", "rays_saved", "rmse_ratio_fixed_blur",
            "overhead", "overhead_published", "overhead_ms", "wall_gap", "rmse", "rmse_published", "spp" });
    REQUIRE(all["scenes"].size() == 1);
    const Json& scene = all["scenes"][0];
    CHECK(scene["name"] == "cornell");
    REQUIRE(scene["references"].size() == 1);
    CHECK(scene["references"][0]["integrand"] == "1 bounce");
    CHECK(scene["references"][0]["noise"].get<double>() > 0);
    REQUIRE(scene["settings"].size() == 2);
    for (const Json& setting : scene["settings"]) {
        CHECK(setting["bounces"] == 1);
        CHECK(setting["paper"].is_null());
        checkSetting(setting);
    }
    CHECK(scene["settings"][0]["fixed_blur"]["width_pixels"].get<double>() > 0);
    CHECK_FALSE(scene["settings"][1].contains("fixed_blur"));
    CHECK(scene["curves"].empty());
    CHECK(scene["bias"].empty());

    // A second run reads the reference and finds the same errors.
    const Json again = results(place, scenes + "/cornell.toml");
    const Json& cached = again["scenes"][0];
    CHECK(cached["references"][0]["cached"] == true);
    CHECK(cached["settings"][0]["method"] == scene["settings"][0]["method"]);
}

TEST_CASE("a glossy box has times of two bounces, ambient occlusion, and what the filter blurs by mu")
{
    const Workplace place;
    const Json all = results(place, "cornell_glossy");
    const Json& scene = all["scenes"][0];
    REQUIRE(scene["settings"].size() == 6);
    for (const Json& setting : scene["settings"]) {
        checkTiming(setting);
        const bool ambient = setting["bounces"] == 0;
        CHECK(setting["paper"].is_null() == ambient);
        CHECK((ambient || setting["paper"]["spp"] == 59));
        CHECK(setting.contains("method") == (setting["bounces"] != 2));
    }
    // Occlusion is not light: its reference is another, and its error with one width another one's.
    REQUIRE(scene["references"].size() == 2);
    CHECK(scene["references"][1]["integrand"] == "ambient occlusion");
    for (const char* quantity : { "samples_saved_ambient", "rmse_ambient", "rmse_ratio_fixed_blur_ambient" }) {
        CHECK(claim(all["claims"], std::string("indirect.cornell_glossy.") + quantity)["value"].get<double>() > 0);
    }
    REQUIRE(scene["bias"].size() == 4);
    for (const Json& bias : scene["bias"]) {
        CHECK(bias["rmse"].get<double>() > 0);
        CHECK(bias["bias"].get<double>() < bias["rmse"].get<double>());
        CHECK(std::abs(bias["mean_error"].get<double>()) < 0.5);
    }
    const Json& saved = claim(all["claims"], "indirect.cornell_glossy.samples_saved");
    CHECK(saved["goal"] == 5);
    CHECK(saved["paper"].get<double>() == doctest::Approx(361.0 / 59));
    const Json& overhead = claim(all["claims"], "indirect.cornell_glossy.overhead_2_bounces");
    CHECK(overhead["paper"].get<double>() == doctest::Approx(67.0 / 757));
    CHECK(overhead["goal"].is_null());
    CHECK(claim(all["claims"], "indirect.cornell_glossy.overhead")["goal"] == 0.08);
    CHECK(claim(all["claims"], "indirect.cornell_glossy.bias_mu2_published")["value"].is_number());
}

TEST_CASE("times alone need no references")
{
    const Workplace place;
    const Json all = results(place, scenes + "/cornell.toml", { "--timing-only" });
    CHECK_FALSE(place.has("references"));
    CHECK(all["scenes"][0]["settings"][1]["timing"]["tracing"]["median"].get<double>() > 0);
    CHECK_FALSE(all["scenes"][0]["settings"][1].contains("method"));
}

TEST_CASE("the scenes of the chapter are listed, and wrong calls end in one line")
{
    const Workplace place;
    ::setenv("WEDGE_DATA", place.path().c_str(), 1); // no meshes there
    const Outcome list = place.run({ "--list" });
    CHECK(list.status == 0);
    for (const char* name : { "cornell_glossy ", "cornell_figure ", "aaf2013_cornell_bunny ", "crytek_sponza ",
             "conference ", "bench ", "spheres " }) {
        CHECK(contains(list.out, name));
    }
    const std::string quad = "[[mesh]]\nfile = \"" + scenes + "/meshes/quad.obj\"\n";
    place.write("dark.toml", quad);
    checkWrongCalls(place, "indirect",
        {
            { { "--scene", "conference" }, 1, "set WEDGE_DATA to the folder that holds conference/conference.obj" },
            { { "--scene", "dark.toml", "--quick", "--size", "16x16", "--reference-dir", "references" }, 1,
                "no error to compare" },
        });
}

} // namespace
} // namespace wedge::app::test
