// Progressive renders as users see them: an image after each step, the report of steps, and calls that are wrong.
#include "tests/app_testing.h"

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

TEST_CASE("each step is said, reported, and its image written")
{
    const Workplace place;
    const Outcome outcome =
        place.run({ "render", box, "--size", "64x48", "--progressive", "--spp", "64", "-o", "a.exr", "-o", "b.png",
            "--layers", "emission,direct,indirectNoisy,filterWidth", "--bounces", "1", "--report", "r.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(outcome.err == "");
    const nlohmann::json report = nlohmann::json::parse(place.text("r.json"));
    const nlohmann::json& progressive = report.at("progressive");
    CHECK(progressive.at("target_error").is_null());
    CHECK(progressive.at("ended_by") == "samples");
    REQUIRE(progressive.at("steps").size() == 3);
    double rays = 0, time = 0;
    int spp = 16;
    for (const nlohmann::json& step : progressive.at("steps")) {
        CHECK(step.at("spp") == spp);
        CHECK(contains(outcome.out, std::to_string(spp) + " spp, "));
        CHECK(step.at("error") > 0);
        CHECK(step.at("rays_per_pixel") > rays);
        CHECK(step.at("wall_ms") > time);
        CHECK(step.at("files") == nlohmann::json({ "a.exr", "b.png" }));
        rays = step.at("rays_per_pixel");
        time = step.at("wall_ms");
        spp *= 2;
    }
    CHECK(report.at("frames").at(0).at("rays_per_pixel") == rays);
    CHECK(report.at("method").at("progressive") == true);
    CHECK(place.files() == std::vector<std::string> { "a.exr", "b.png", "r.json" });
}

TEST_CASE("a target error ends a render without a count, and a time limit does")
{
    const Workplace place;
    const Outcome target = place.run({ "render", box, "--size", "32x24", "--progressive", "--target-error", "0.5", "-o",
        "a.exr", "--report", "r.json" });
    CHECK(target.status == 0);
    const nlohmann::json first = nlohmann::json::parse(place.text("r.json")).at("progressive");
    CHECK(first.at("ended_by") == "target error");
    CHECK(first.at("target_error") == 0.5);
    CHECK(first.at("steps").back().at("error") <= 0.5);
    const Outcome limit = place.run({ "render", box, "--size", "32x24", "--progressive", "--time-limit", "0.3", "-o",
        "a.exr", "--report", "r.json" });
    CHECK(limit.status == 0);
    CHECK(contains(limit.err, "time limit"));
    CHECK(nlohmann::json::parse(place.text("r.json")).at("progressive").at("ended_by") == "time limit");
    CHECK(place.has("a.exr"));
}

TEST_CASE("options of progressive renders that are wrong are refused in one line")
{
    const Workplace place;
    checkRenderRefused(
        place, box, { "--target-error", "0.1" }, wrongCall, "--target-error 0.1: leave it out, or add --progressive");
    for (const std::string bad : { "0", "-1", "nan", "inf", "much", "" }) {
        checkRenderRefused(place, box, { "--progressive", "--target-error", bad }, wrongCall, "--target-error");
    }
    checkRenderRefused(place, box, { "--progressive", "--as-published" }, wrongCall, "--as-published");
    checkRenderRefused(place, box, { "--progressive", "--counts", "spectrum" }, wrongCall, "--counts spectrum");
    checkRenderRefused(place, box, { "--progressive", "--sampler", "stratified" }, wrongCall, "--sampler stratified");
    checkRenderRefused(place, box, { "--progressive", "--spp", "12" }, wrongCall, "12");
}

} // namespace
} // namespace wedge::app::test
