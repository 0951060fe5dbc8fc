// The benchmark against a learned denoiser, run as its users do but tiny: the form of what it writes, never a time.
// Where there is no pyoidn it has to say so; what it does with a denoiser is then tried with one that a script stands
// in for.
#include "tests/benchmark_testing.h"

namespace wedge::app::test {
namespace {

std::vector<std::string> tiny(const std::string& python)
{
    return { "--quick", "--size", "48x36", "--reference-spp", "64", "--reference-dir", "references", "--scene", box,
        "--json", "results.json", "--python", python };
}

/// An interpreter whose denoiser leaves the image as it is. It looks for the guides.
constexpr const char* stillImage = R"sh(#!/bin/sh
[ $# -eq 1 ] && exit 0
[ "$(wc -c < "$4")" = "$(wc -c < "$5")" ] && [ "$(wc -c < "$4")" = "$(wc -c < "$6")" ] && cp "$4" "$7" && echo 1.5
)sh";

TEST_CASE("without a denoiser it says so, and how to get one")
{
    const Workplace place;
    const Outcome outcome = place.run(tiny("no-such-python"));
    CHECK(outcome.status == 0);
    CHECK(contains(outcome.out, "skipped: no-such-python has no pyoidn; install it (pip install pyoidn)"));
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["denoiser"].is_null());
    CHECK(all["scenes"].empty());
    CHECK(all["claims"].empty());
}

TEST_CASE("results have all that docs/benchmarks.md says")
{
    const Workplace place;
    place.write("still.sh", stillImage);
    std::filesystem::permissions(place.path() / "still.sh", std::filesystem::perms::owner_all);
    const Outcome outcome = place.run(tiny((place.path() / "still.sh").string()));
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(contains(outcome.out, "time to equal error"));
    const Json all = Json::parse(place.text("results.json"));
    CHECK(all["denoiser"] == "Open Image Denoise");
    checkClaims(all["claims"], "denoiser.cornell.",
        { "saved_time", "saved_time_trimmed", "worst_region", "rmse_ratio_equal_time" });
    const Json& scene = all["scenes"][0];
    CHECK(scene["ours"]["spp"] == 28);
    CHECK(scene["ours"]["denoise_ms"] == 0);
    REQUIRE(scene["denoised"].size() >= 1);
    for (const Json& point : scene["denoised"]) {
        CHECK(keys(point) == std::set<std::string> { "denoise_ms", "render_ms", "rmse", "rmse_trimmed", "spp" });
        CHECK(point["denoise_ms"] == 1.5);
        CHECK(point["rmse"].get<double>() > point["rmse_trimmed"].get<double>());
    }
    CHECK(scene["equal_time"]["spp"].get<int>() >= 1);
    CHECK(scene["worst_region"]["ratio"].get<double>() > 0);
}

TEST_CASE("wrong calls end in one line")
{
    const Workplace place;
    place.write("fails.sh", "#!/bin/sh\n[ $# -eq 1 ]\n");
    std::filesystem::permissions(place.path() / "fails.sh", std::filesystem::perms::owner_all);
    std::vector<std::string> fails = tiny((place.path() / "fails.sh").string());
    checkWrongCalls(place, "denoiser",
        {
            { { "--nonsense" }, 2, "--nonsense" },
            { { "--scene", "atlantis" }, 2, "atlantis: name a scene file or one of bench, chess" },
            { { "--size", "48" }, 2, "--size: 48" },
            { { "--json", "missing/a.json" }, 1, "missing" },
            { fails, 1, "Open Image Denoise: has failed" },
        });
}

} // namespace
} // namespace wedge::app::test
