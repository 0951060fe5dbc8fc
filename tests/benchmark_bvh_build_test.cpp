// The benchmark of builds, run as its users do but tiny: the form of what it writes, never a time.
#include "tests/app_testing.h"

#include <set>

#include <nlohmann/json.hpp>

namespace wedge::app::test {
namespace {

using Json = nlohmann::json;

} // namespace

TEST_CASE("A quick run writes times, memory and claims of every builder")
{
    const Workplace place;
    const Outcome outcome =
        place.run({ "--quick", "--repeats", "2", "--scene", "field_1k", "--scene", "field_10k", "--json", "out.json" });
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(contains(outcome.out, "field_10k, 10000 triangles"));
    const Json results = Json::parse(place.text("out.json"));
    CHECK(results["benchmark"] == "bvh_build");
    REQUIRE(results["scenes"].size() == 2);
    for (const Json& scene : results["scenes"]) {
        REQUIRE(scene["sets"].size() == 2);
        for (const Json& set : scene["sets"]) {
            std::set<std::string> names;
            for (const Json& builder : set["builders"]) {
                names.insert(builder["name"].get<std::string>());
                CHECK(builder["wall_ms"]["median"].get<double>() > 0);
                CHECK(builder["cpu_ms"]["median"].get<double>() >= 0);
                CHECK(builder["bytes"].get<std::size_t>() > 20 * scene["triangles"].get<std::size_t>());
            }
            CHECK(names
                == std::set<std::string> {
                    "default", "fast", "quality", "refit", "embree_default", "embree_low", "embree_high" });
        }
    }
    std::set<std::string> ids;
    for (const Json& claim : results["claims"]) {
        CHECK(ids.insert(claim["id"].get<std::string>()).second);
        CHECK(claim["value"].get<double>() > 0);
    }
    for (const char* scene : { "field_1k", "field_10k" })
        for (const char* quantity :
            { "build_vs_embree", "build_vs_embree_1_thread", "bytes_per_triangle", "bytes_per_triangle_fast",
                "fast_build_vs_embree_low", "quality_build_vs_embree_high", "refit_vs_default" }) {
            INFO(quantity);
            CHECK(ids.count(std::string("bvh_build.") + scene + "." + quantity) == 1);
        }
}

TEST_CASE("Wrong calls say what to do")
{
    const Workplace place;
    const Outcome unknown = place.run({ "--scene", "nonsense" });
    CHECK(unknown.status == 2);
    CHECK(contains(unknown.err, "nonsense"));
    CHECK(place.run({ "--threads", "0" }).status == 2);
}

} // namespace wedge::app::test
