// The benchmark of light from beyond the scene, run as its users do but tiny: the form of what it writes, never a time.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

const std::set<std::string> keysOfPoints { "mu", "rays", "rmse", "rmse_corrected", "rmse_region", "seed", "spp" };
const PointRule points { 15.9, keysOfPoints, "rays" };

TEST_CASE("results of a scene that needs nothing else have all that docs/benchmarks.md says")
{
    const Workplace place;
    const Json all = tinyResults(place, "sky", {});
    checkHead(all, "environment");
    CHECK(all["plan"]["default_spp"] == 16);
    checkClaims(all["claims"], "environment.sky.",
        { "samples_saved", "samples_saved_vs_stratified", "samples_saved_published", "smooth_saved",
            "smooth_saved_vs_stratified", "vs_fixed_blur", "rays_saved", "rmse", "overhead", "overhead_published",
            "overhead_ms", "total_ms", "spp", "wall_gap" });
    CHECK(claim(all["claims"], "environment.sky.smooth_saved")["goal"] == 25);
    CHECK(claim(all["claims"], "environment.sky.vs_fixed_blur")["goal"] == 1);
    CHECK(claim(all["claims"], "environment.sky.overhead")["goal"] == 0.12);
    CHECK(claim(all["claims"], "environment.sky.samples_saved")["goal"].is_null());
    REQUIRE(all["scenes"].size() == 1);
    const Json& scene = all["scenes"][0];
    REQUIRE(scene["references"].size() == 1);
    CHECK(scene["references"][0]["integrand"] == "whole image");
    REQUIRE(scene["settings"].size() == 2);
    for (const Json& setting : scene["settings"]) {
        checkTiming(setting);
        checkPoints(setting["method"], 2, points);
        REQUIRE(setting["baselines"].size() == 2);
        CHECK(setting["baselines"][0]["name"] == "sobol");
        CHECK(setting["baselines"][1]["name"] == "stratified");
        checkBaselines(setting, 2, points);
        for (const Json& baseline : setting["baselines"]) {
            CHECK(baseline["region_saved"]["median"].get<double>() > 0);
            CHECK(baseline["region_extrapolated"].is_boolean());
            for (const Json& point : baseline["points"]) { // powers of four
                const double power = std::log2(point["spp"].get<double>()) / 2;
                CHECK(power == doctest::Approx(std::round(power)));
            }
        }
        CHECK(setting["region_fraction"].get<double>() > 0);
        CHECK(setting["region_fraction"].get<double>() < 1);
    }
    const Json& usual = scene["settings"][0];
    CHECK(usual["setting"] == "default");
    CHECK(usual["blur"]["width_pixels"] == 2);
    checkPoints(usual["blur"]["points"], 2, points);
    CHECK(usual["blur"]["points"][0]["rmse"] != usual["method"][0]["rmse"]);
    CHECK_FALSE(scene["settings"][1].contains("blur"));

    // A second run reads the reference and finds the same errors.
    const Json again = tinyResults(place, "sky", {});
    CHECK(again["scenes"][0]["references"][0]["cached"] == true);
    CHECK(again["scenes"][0]["settings"][0]["method"] == usual["method"]);
}

TEST_CASE("scenes are listed by probe and object, skipped without their files, and wrong calls end in one line")
{
    const Workplace place;
    ::setenv("WEDGE_DATA", place.path().c_str(), 1); // neither meshes nor maps there
    const Outcome list = place.run({ "--list" });
    CHECK(list.status == 0);
    for (const char* name : { "sky ", "uffizi_diffuse ", "uffizi_glossy ", "sunrise_diffuse ", "sunrise_glossy ",
             "grace_diffuse ", "grace_glossy ", "field_diffuse ", "field_glossy " }) {
        CHECK(contains(list.out, name));
    }
    const Outcome times = place.run({ "--quick", "--size", "16x12", "--timing-only" });
    CHECK_MESSAGE(times.status == 0, times.err);
    CHECK(contains(times.err, "skipped uffizi_diffuse, uffizi_glossy"));
    CHECK_FALSE(place.has("references"));

    place.write("dark.toml", "[[mesh]]\nfile = \"" + scenes + "/meshes/quad.obj\"\n");
    std::filesystem::create_directories(place.path() / "models/dragon");
    place.write("models/dragon/dragon_aaf.obj", "v 0 0 0\n");
    checkWrongCalls(place, "environment",
        {
            { { "--scene", "grace_glossy" }, 1, "set WEDGE_DATA to the folder that holds hdr/grace_latlong.exr" },
            { { "--scene", "dark.toml", "--quick", "--size", "16x16", "--reference-dir", "references" }, 1,
                "no error to compare" },
        });
}

} // namespace
} // namespace wedge::app::test
