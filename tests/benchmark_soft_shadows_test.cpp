// The benchmark of soft shadows, run as its users do but tiny: the form of what it writes, never a time.
#include "tests/app_testing.h"

#include <set>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

using Json = nlohmann::json;

std::set<std::string> keys(const Json& object)
{
    std::set<std::string> out;
    for (const auto& [key, value] : object.items()) {
        out.insert(key);
    }
    return out;
}

/// A tiny run over a scene file; fails the test unless it succeeds.
Json results(const Workplace& place, const std::string& scene, std::vector<std::string> more = {})
{
    std::vector<std::string> arguments = { "--quick", "--size", "48x36", "--reference-spp", "64", "--reference-dir",
        "references", "--scene", scene, "--json", "results.json" };
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = place.run(arguments);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(contains(outcome.out, "penumbra"));
    return Json::parse(place.text("results.json"));
}

/// Points of a curve: positive, finite, of the form that the plots read.
void checkPoints(const Json& points, std::size_t atLeast)
{
    CHECK(points.size() >= atLeast);
    for (const Json& point : points) {
        CHECK(keys(point) == std::set<std::string> { "mu", "rmse", "rmse_corrected", "seed", "shadow_rays", "spp" });
        CHECK(point["spp"].get<double>() >= 8.9);
        CHECK(point["rmse"].get<double>() > 0);
        CHECK(point["rmse_corrected"].get<double>() <= point["rmse"].get<double>());
        CHECK(point["shadow_rays"].get<double>() > 0);
    }
}

void checkClaims(const Json& claims)
{
    std::set<std::string> quantities;
    const std::string prefix = "soft_shadows.penumbra.";
    for (const Json& claim : claims) {
        CHECK(keys(claim) == std::set<std::string> { "goal", "id", "paper", "spread", "unit", "value" });
        const auto id = claim["id"].get<std::string>();
        REQUIRE(id.starts_with(prefix));
        CHECK(quantities.insert(id.substr(prefix.size())).second);
        CHECK(claim["value"].is_number());
        CHECK(claim["unit"].is_string());
        CHECK(claim["paper"].is_null());
    }
    for (const char* quantity : { "samples_saved", "samples_saved_published", "samples_saved_vs_sobol",
             "samples_saved_vs_plain_mc", "rays_saved", "rmse_ratio_fixed_blur", "overhead", "overhead_published",
             "overhead_ms", "wall_gap", "rmse", "mu_monotonic", "mu_monotonic_published" }) {
        INFO(quantity);
        CHECK(quantities.count(quantity) == 1);
    }
}

void checkSetting(const Json& setting, std::size_t baselines)
{
    CHECK(setting["timing"]["total"]["median"].get<double>() > 0);
    CHECK(keys(setting["timing"]["overhead"]) == std::set<std::string> { "max", "median", "min", "q1", "q3" });
    checkPoints(setting["method"], 3);
    CHECK(setting["baselines"].size() == baselines);
    for (const Json& baseline : setting["baselines"]) {
        checkPoints(baseline["points"], 3);
        CHECK(baseline["samples_saved"]["median"].get<double>() > 0);
        CHECK(baseline["extrapolated"].is_boolean());
    }
    checkPoints(setting["convergence"], 2);
}

TEST_CASE("results of a scene file have all that docs/benchmarks.md says")
{
    const Workplace place;
    const Json all = results(place, scenes + "/penumbra.toml");
    CHECK(all["benchmark"] == "soft_shadows");
    CHECK(all["wedge"].is_string());
    CHECK_FALSE(all["device"]["name"].get<std::string>().empty());
    CHECK(all["plan"]["width"] == 48);
    checkClaims(all["claims"]);
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
        checkPoints(curve["points"], 2);
        CHECK((curve["filter"] == "NAF") == curve["fixed_width_pixels"].is_number());
        curves.insert(curve["setting"].get<std::string>() + curve["sampling"].get<std::string>()
            + curve["filter"].get<std::string>());
    }
    CHECK(curves.size() == 12);

    // A second run reads the references and finds the same errors.
    const Json again = results(place, scenes + "/penumbra.toml");
    const Json& cached = again["scenes"][0];
    CHECK(cached["references"][0]["cached"] == true);
    CHECK(cached["settings"]["default"]["method"] == scene["settings"]["default"]["method"]);
    CHECK(cached["references"][0]["noise"] == scene["references"][0]["noise"]);
}

TEST_CASE("times alone need no references")
{
    const Workplace place;
    const Json all = results(place, scenes + "/penumbra.toml", { "--timing-only" });
    CHECK_FALSE(place.has("references"));
    CHECK(all["scenes"][0]["curves"].empty());
    CHECK(all["scenes"][0]["settings"]["published"]["timing"]["tracing"]["median"].get<double>() > 0);
}

TEST_CASE("the four scenes of the chapter and the authors' own are listed")
{
    const Workplace place;
    const Outcome outcome = place.run({ "--list" });
    CHECK(outcome.status == 0);
    for (const char* name :
        { "grids ", "bench ", "tentacles ", "spheres ", "aaf2012_grids_cut2", "aaf2012_spheres " }) {
        CHECK(contains(outcome.out, name));
    }
}

TEST_CASE("wrong calls and files end in one line")
{
    const Workplace place;
    ::setenv("WEDGE_DATA", place.path().c_str(), 1); // no meshes there
    place.write("dark.toml", "[[mesh]]\nfile = \"" + scenes + "/meshes/quad.obj\"\n");
    struct Case {
        std::vector<std::string> arguments;
        int status;
        const char* said;
    };
    for (const Case& wrong : std::vector<Case> {
             { { "--nonsense" }, 2, "--nonsense" },
             { { "--scene", "atlantis" }, 2, "atlantis: name a scene file or one of grids" },
             { { "--scene", "aaf2012_grids" }, 1, "set WEDGE_DATA to the folder that holds aaf2012_grids/grids.obj" },
             { { "--size", "48" }, 2, "--size: 48" },
             { { "--size", "1x1" }, 2, "--size: 1x1" },
             { { "--scene", "dark.toml", "--device", "quantum" }, 1, "quantum" },
             { { "--scene", "dark.toml" }, 1, "no area light" },
             { { "--scene", "dark.toml", "--json", "missing/a.json" }, 1, "missing" },
         }) {
        const Outcome outcome = place.run(wrong.arguments);
        INFO(outcome.err);
        CHECK(outcome.status == wrong.status);
        CHECK(contains(outcome.err, "soft_shadows: error: "));
        CHECK(contains(outcome.err, wrong.said));
    }
}

} // namespace
} // namespace wedge::app::test
