// The benchmark of rays, run as its users do but tiny: the form of what it writes and that hits agree, never a time.
#include "tests/app_testing.h"

#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

using Json = nlohmann::json;

/// A tiny run; fails the test unless it succeeds.
Json results(const Workplace& place, std::vector<std::string> arguments)
{
    for (const char* more : { "--quick", "--size", "64x48", "--repeats", "2", "--json", "results.json" })
        arguments.push_back(more);
    const Outcome outcome = place.run(arguments);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    return Json::parse(place.text("results.json"));
}

void checkSummary(const Json& summary)
{
    CHECK(summary["median"].get<double>() > 0);
    CHECK(summary["q1"].get<double>() <= summary["q3"].get<double>());
}

/// Nothing that rounding does not explain, and every difference counted once.
void checkDifference(const Json& difference)
{
    std::size_t sum = 0;
    for (const auto& [kind, count] : difference["kinds"].items())
        sum += count.get<std::size_t>();
    CHECK(sum == difference["differ"].get<std::size_t>());
    CHECK(difference["kinds"]["unexplained"] == 0);
    CHECK(100 * sum < difference["rays"].get<std::size_t>());
    const Json& right = difference["right"];
    CHECK(right["ours"].get<std::size_t>() + right["embree"].get<std::size_t>() + right["both"].get<std::size_t>()
        == sum);
}

void checkClass(const Json& c)
{
    INFO(c["name"].get<std::string>());
    CHECK(c["rays"].get<std::size_t>() > 1000);
    std::set<std::string> columns;
    for (const Json& contender : c["contenders"]) {
        CHECK(columns.insert(contender["name"].get<std::string>()).second);
        checkSummary(contender["mrays_s"]);
        checkSummary(contender["ns_per_ray"]);
        CHECK(contender.contains("ours_over_this") != contender["ours"].get<bool>());
    }
    for (const char* name : { "wedge single", "wedge packets", "wedge single quality", "wedge packets quality",
             "embree single", "embree single bvh4", "embree single bvh8", "embree single high", "embree single robust",
             "embree packets", "embree packets high" }) {
        INFO(name);
        CHECK(columns.count(name) == 1);
    }
    CHECK(columns.contains("embree stream") == (WEDGE_EMBREE_MAJOR == 3)); // Embree 4 has them no more
    CHECK(columns.count(c["chosen"].get<std::string>()) == 1);
    CHECK(columns.count(c["embree_best"].get<std::string>()) == 1);
    CHECK(c["model"]["nodes_per_ray"].get<double>() >= 1);
    CHECK(c["model"]["port_cycles"].get<double>() > 0);
    checkDifference(c["difference"]);
    checkDifference(c["difference_from_robust"]);
    CHECK(c["packets_differ_from_single"] == 0);
}

void checkFrame(const Json& frame)
{
    REQUIRE(frame.is_object());
    checkSummary(frame["vs_embree_single"]);
    checkSummary(frame["vs_embree_packet"]);
    CHECK(frame["runs"].size() == 3);
    // The same samples on both sides: pixels differ only where rounding turns a shadow ray.
    CHECK(frame["rmse"].get<double>() < 0.02 * frame["mean"].get<double>());
    CHECK(frame["different_pixels"].get<std::size_t>() < 64 * 48 / 50);
}

TEST_CASE("results of a generated scene have all that docs/benchmarks.md says, and hits agree")
{
    const Workplace place;
    const Json all = results(place, { "--scene", "spheres" });
    CHECK(all["benchmark"] == "rays");
    CHECK(all["plan"]["width"] == 64);
    CHECK(all["plan"]["clock"] == "wall");
    CHECK(all["growth"].empty());
    REQUIRE(all["scenes"].size() == 1);
    const Json& scene = all["scenes"][0];
    CHECK(scene["triangles"] == 72120);
    CHECK(scene["builds"].size() == 7);
    for (const Json& build : scene["builds"])
        CHECK(build["bytes_per_triangle"].get<double>() > 20);
    std::vector<std::string> classes;
    for (const Json& c : scene["classes"]) {
        classes.push_back(c["name"].get<std::string>());
        checkClass(c);
    }
    CHECK(classes == std::vector<std::string> { "primary", "area_shadow", "ambient", "diffuse" });
    checkFrame(scene["frame"]);
}

TEST_CASE("claims are named as docs/benchmarks.md says")
{
    const Workplace place;
    const Json all = results(place, { "--scene", scenes + "/penumbra.toml", "--cpu-time" });
    CHECK(all["plan"]["clock"] == "processor");
    std::set<std::string> quantities;
    const std::string prefix = "rays.penumbra.";
    for (const Json& claim : all["claims"]) {
        const auto id = claim["id"].get<std::string>();
        REQUIRE(id.starts_with(prefix));
        CHECK(quantities.insert(id.substr(prefix.size())).second);
        CHECK(claim["value"].is_number());
        CHECK(claim["paper"].is_null());
    }
    for (const char* ray : { "primary", "area_shadow", "ambient", "diffuse" })
        for (const char* quantity : { "_mrays_s", "_vs_embree_single", "_vs_embree_packet", "_vs_embree_best",
                 "_vs_embree_single_quality", "_unexplained_hits" }) {
            INFO(ray, quantity);
            CHECK(quantities.count(std::string(ray) + quantity) == 1);
        }
    CHECK(quantities.count("frame_vs_embree_single") == 1);
}

TEST_CASE("the field grows")
{
    const Workplace place;
    const Json all = results(place, { "--growth-only", "--growth-steps", "3" });
    CHECK(all["scenes"].empty());
    REQUIRE(all["growth"].size() == 3);
    const std::size_t sizes[] = { 1000, 3162, 10000 };
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(all["growth"][i]["triangles"] == sizes[i]);
        for (const char* ray : { "primary", "diffuse" })
            for (const char* column : { "wedge single", "embree single", "embree packets high" })
                checkSummary(all["growth"][i]["classes"][ray]["ns_per_ray"][column]);
    }
    // About as many rays start from the field at each size, and a larger hierarchy takes more nodes.
    const auto& first = all["growth"][0]["classes"]["diffuse"];
    const auto& last = all["growth"][2]["classes"]["diffuse"];
    CHECK(std::fabs(last["rays"].get<double>() / first["rays"].get<double>() - 1) < 0.2);
    CHECK(last["nodes_per_ray"].get<double>() > first["nodes_per_ray"].get<double>());
    CHECK(all["claims"].size() == 4);
}

TEST_CASE("scenes that have no light, or nothing to see, leave out what they cannot have")
{
    const Workplace place;
    place.write("dark.toml", "[[mesh]]\nfile = \"" + scenes + "/meshes/quad.obj\"\n");
    const Json all = results(place, { "--scene", "dark.toml" });
    const Json& scene = all["scenes"][0];
    CHECK(scene["frame"].is_null());
    CHECK(contains(scene["no_frame"].get<std::string>(), "no area light"));
    for (const Json& c : scene["classes"])
        CHECK(c["name"] != "area_shadow");
}

TEST_CASE("wrong calls end in one line")
{
    const Workplace place;
    ::setenv("WEDGE_DATA", place.path().c_str(), 1); // no meshes there
    struct Case {
        std::vector<std::string> arguments;
        int status;
        const char* said;
    };
    for (const Case& wrong : std::vector<Case> {
             { { "--nonsense" }, 2, "--nonsense" },
             { { "--scene", "atlantis" }, 2, "atlantis: name a scene file or one of grids" },
             { { "--scene", "conference" }, 1, "set WEDGE_DATA to the folder that holds conference/conference.obj" },
             { { "--scene", "grids", "--size", "50x48" }, 2, "--size: 50x48" },
             { { "--scene", "grids", "--size", "48" }, 2, "--size: 48" },
             { { "--scene", "grids", "--device", "quantum" }, 1, "quantum" },
             { { "--scene", "grids", "--json", "missing/a.json" }, 1, "missing" },
         }) {
        const Outcome outcome = place.run(wrong.arguments);
        INFO(outcome.err);
        CHECK(outcome.status == wrong.status);
        CHECK(contains(outcome.err, "rays: error: "));
        CHECK(contains(outcome.err, wrong.said));
    }
}

} // namespace
} // namespace wedge::app::test
