// What benchmarks of error against samples compute with: claims beside their goals, tables, blurs, heat maps, what rays
// are counted by.
#include "benchmarks/harness/curves.h"
#include "benchmarks/harness/heat_map.h"
#include "benchmarks/harness/image_blur.h"
#include "benchmarks/harness/results.h"
#include "benchmarks/harness/tables.h"
#include "benchmarks/harness/thesis_table.h"
#include "benchmarks/subjects/whole_image.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wedge::benchmark {
namespace {

double sum(const image::RgbImage& image) { return std::accumulate(image.rgb.begin(), image.rgb.end(), 0.0); }

TEST_CASE("a blurred point is a Gaussian of the asked width, in its own channel, and an even image stays")
{
    constexpr int side = 41;
    image::RgbImage point { side, side, std::vector<float>(3 * side * side, 0.0f) };
    const auto at = [](int x, int y, int c) { return static_cast<std::size_t>(3 * (y * side + x) + c); };
    point.rgb[at(20, 20, 1)] = 1.0f;
    CHECK(blurred(point, 0.0).rgb == point.rgb);
    for (const double sigma : { 1.0, 3.0 }) {
        const image::RgbImage out = blurred(point, sigma);
        CHECK(sum(out) == doctest::Approx(1.0));
        double variance = 0;
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                CHECK(out.rgb[at(x, y, 0)] == 0.0f);
                variance += static_cast<double>(out.rgb[at(x, y, 1)]) * (x - 20) * (x - 20);
            }
        }
        // What the cut at three standard deviations leaves of the variance is 97 %, or more.
        CHECK(std::sqrt(variance) == doctest::Approx(sigma).epsilon(0.02));
        CHECK(out.rgb[at(23, 20, 1)] == doctest::Approx(out.rgb[at(20, 17, 1)]));
    }
    const image::RgbImage even { 7, 3, std::vector<float>(63, 0.25f) };
    for (const float value : blurred(even, 5.0).rgb) {
        CHECK(value == doctest::Approx(0.25));
    }
}

TEST_CASE("heat maps go from black to white, ever lighter")
{
    const std::vector<float> values = { -1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 };
    const image::RgbImage map = heatMap(values, 11, 1, 0.0, 8.0, false);
    const auto light = [&](std::size_t i) {
        return 0.2126f * map.rgb[3 * i] + 0.7152f * map.rgb[3 * i + 1] + 0.0722f * map.rgb[3 * i + 2];
    };
    CHECK(light(0) == 0.0f);
    CHECK(light(1) == 0.0f);
    for (std::size_t i = 2; i < 10; ++i) {
        CHECK(light(i) > light(i - 1));
    }
    CHECK(light(9) == doctest::Approx(1.0));
    CHECK(light(10) == doctest::Approx(1.0));

    // Equal ratios are equal steps, what is not above 0 is black, and a map of one value is no division by 0.
    const image::RgbImage logs = heatMap({ 0, 1, 4, 16 }, 4, 1, 1.0, 16.0, true);
    const image::RgbImage steps = heatMap({ 0, 0, 1, 2 }, 4, 1, 0.0, 2.0, false);
    for (std::size_t i = 0; i < logs.rgb.size(); ++i) {
        CHECK(logs.rgb[i] == doctest::Approx(steps.rgb[i]));
    }
    CHECK(heatMap({ 3 }, 1, 1, 3.0, 3.0, false).rgb[0] == 0.0f);
}

TEST_CASE("rays are counted by all pixels, whether they see something or not")
{
    MeasurePlan plan;
    plan.width = 10;
    plan.height = 4;
    const WholeImage subject("name", plan);
    render::FrameStatistics frame;
    frame.shadedPixels = 20;
    frame.primaryRays = 80;
    frame.shadowRays = 200;
    frame.indirectRays = 120;
    CHECK(subject.raysOf(frame) / subject.pixelsOf(frame) == 10.0);
}

TEST_CASE("curves are at the plan's budgets and the usual one, each once")
{
    constexpr int usual = 28;
    MeasurePlan plan;
    plan.budgets = { 2 * usual, 64 * usual, usual };
    CHECK(budgetsOf(plan, usual) == std::vector<int> { usual, 2 * usual, 64 * usual });
    plan.budgets = { usual + 1 };
    CHECK(budgetsOf(plan, usual) == std::vector<int> { usual, usual + 1 });
}

TEST_CASE("settings show what the case has, whatever the method")
{
    Case ambient, twice;
    ambient.ambient = true;
    ambient.ambientDistance = 0.5f;
    twice.bounces = 2;
    const BaselineRow row { "strata", "", render::Sampler::Stratified, true, true,
        [](render::Settings& s) { s.shading = render::Shading::Inside; } };
    for (const render::Settings& settings :
        { methodSettings(ambient, false), methodSettings(ambient, true), baselineSettings(row, ambient, 16) }) {
        CHECK(settings.integrator == render::Integrator::AmbientOcclusion);
        CHECK(settings.indirect.ambientDistance == 0.5f);
        CHECK(settings.bounces == 0);
    }
    CHECK(methodSettings(twice, false).bounces == 2);
    CHECK(methodSettings(twice, true).published);
    CHECK(baselineSettings(row, twice, 64).spp == 64);
    CHECK(baselineSettings(row, twice, 64).bounces == 2);
    CHECK(baselineSettings(row, twice, 64).shading == render::Shading::Inside);
    CHECK(methodSettings(twice, false, 40).spp == 40);
    CHECK(methodSettings(twice, true, {}, 3.0f).mu == 3.0f);
}

/// Two settings of a case, of which only times are known: 10 and 20 ms, a tenth of it overhead.
SceneResult timed(const Case& of, const Numbers& goals)
{
    SceneResult out;
    out.source.name = "scene";
    out.source.goals = goals;
    for (const bool published : { false, true }) {
        CaseSetting& setting = out.settings.emplace_back();
        setting.of = of;
        setting.published = published;
        setting.triangles = 1500;
        const double total = published ? 20 : 10;
        for (const auto& [name, value] : Numbers { { "total", total }, { "overhead", 0.1 * total },
                 { "overhead_fraction", 0.1 }, { "wall", 1.25 * total }, { "wall_gap", 0.2 } }) {
            setting.timing.columns.emplace_back(name, Summary { value, value, value, value, value });
        }
    }
    return out;
}

const Claim& claimOf(const std::vector<Claim>& claims, const std::string& id)
{
    const auto found = std::ranges::find(claims, "name.scene." + id, &Claim::id);
    REQUIRE_MESSAGE(found != claims.end(), id);
    return *found;
}

TEST_CASE("claims stand beside the thesis' numbers, and goals of their own suffix or of any")
{
    Benchmark benchmark;
    benchmark.program = "name";
    benchmark.goals = { { "wall_gap*", 0.05 }, { "total_ms_2_bounces", 7 } };
    const Paper paper = thesisRow("Thesis", 1e3, 56, 1, 2, 3, 4, 5, 9, 90, 1, 2, 6.0);
    Case of;
    of.bounces = 2;
    of.paper = paper;
    of.suffix = "_2_bounces";
    const std::vector<Claim> claims = claimsOf(benchmark, timed(of, { { "overhead_2_bounces", 0.3 } }));
    CHECK(claimOf(claims, "overhead_2_bounces").goal == 0.3);
    CHECK_FALSE(claimOf(claims, "overhead_published_2_bounces").goal.has_value());
    CHECK(claimOf(claims, "total_ms_2_bounces").goal == 7);
    for (const std::string suffix : { "_2_bounces", "_published_2_bounces" }) {
        CHECK(claimOf(claims, "wall_gap" + suffix).goal == 0.05);
        CHECK(claimOf(claims, "overhead" + suffix).paper == doctest::Approx(0.1));
        CHECK(claimOf(claims, "overhead_ms" + suffix).paper == 9);
        CHECK(claimOf(claims, "total_ms" + suffix).paper == 90);
        CHECK(claimOf(claims, "spp" + suffix).paper == 56);
    }
    CHECK(claimOf(claims, "total_ms_published_2_bounces").value == 20);
    CHECK(paper.claims.back() == std::pair<std::string, double> { "samples_saved", 6.0 });
}

TEST_CASE("a table has the listed columns, of ours and of the thesis, and says which goals are met")
{
    Benchmark benchmark;
    benchmark.program = "name";
    benchmark.times = { { "tris", 8, "triangles", shortNumber, "triangles" }, { "total", 8, "total", tenths, "total" },
        { "gap", 8, "wall_gap", percent, "" } };
    benchmark.goals = { { "wall_gap", 0.05 }, { "overhead", 0.2 } };
    Case of;
    of.label = ", ao";
    const std::string ours = "scene, ao                default    1.5K    10.0  20.0 %\n";
    const std::string theirs = "                          thesis    1.0K    90.0        \n";
    std::string table = tablesOf(benchmark, { timed(of, {}) });
    CHECK(table.find("scene                    setting    tris   total     gap\n" + ours) != std::string::npos);
    CHECK(table.find("thesis") == std::string::npos);
    CHECK(table.find("RMS") == std::string::npos);
    of.paper = thesisRow("Thesis", 1e3, 56, 1, 2, 3, 4, 5, 9, 90, 1, 2);
    table = tablesOf(benchmark, { timed(of, {}) });
    CHECK(table.find(theirs) != std::string::npos);
    const auto line = [&](const std::string& id) {
        const std::size_t at = table.find("name.scene." + id + " ");
        return table.substr(at, table.find('\n', at) - at);
    };
    CHECK(line("wall_gap").ends_with("missed"));
    CHECK(line("overhead").ends_with("met"));
}

TEST_CASE("a curve falls if each point has less error than the one before")
{
    const auto points = [](std::initializer_list<double> errors) {
        std::vector<Measured> out;
        for (const double error : errors) {
            out.emplace_back().error = error;
        }
        return out;
    };
    CHECK(falls(points({ 3, 2, 1 })));
    CHECK_FALSE(falls(points({ 3, 2, 2 })));
    CHECK_FALSE(falls(points({ 3, 1, 2 })));
}

} // namespace
} // namespace wedge::benchmark
