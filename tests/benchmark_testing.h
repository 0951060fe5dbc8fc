// What tests of benchmarks that measure errors share: tiny runs, and the form of what they write.
#pragma once

#include "tests/app_testing.h"

#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace wedge::app::test {

using Json = nlohmann::json;

inline std::set<std::string> keys(const Json& object)
{
    std::set<std::string> out;
    for (const auto& [key, value] : object.items()) {
        out.insert(key);
    }
    return out;
}

/// A tiny run over a scene, whose table names it; fails the test unless it succeeds.
inline Json tinyResults(const Workplace& place, const std::string& scene, const std::vector<std::string>& more,
    const std::string& referenceSpp = "64")
{
    std::vector<std::string> arguments = { "--quick", "--size", "48x36", "--reference-spp", referenceSpp,
        "--reference-dir", "references", "--scene", scene, "--json", "results.json" };
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = place.run(arguments);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(contains(outcome.out, std::filesystem::path(scene).stem().string()));
    return Json::parse(place.text("results.json"));
}

inline void checkHead(const Json& all, const std::string& benchmark)
{
    CHECK(all["benchmark"] == benchmark);
    CHECK(all["wedge"].is_string());
    CHECK_FALSE(all["device"]["name"].get<std::string>().empty());
    CHECK(all["plan"]["width"] == 48);
}

/// What points of curves have.
struct PointRule {
    double leastSpp;
    std::set<std::string> keys;
    std::string rays; ///< the key of rays
};

/// Points of a curve: positive, finite, of the form that the plots read.
inline void checkPoints(const Json& points, std::size_t atLeast, const PointRule& rule)
{
    CHECK(points.size() >= atLeast);
    for (const Json& point : points) {
        CHECK(keys(point) == rule.keys);
        CHECK(point["spp"].get<double>() >= rule.leastSpp);
        CHECK(point["rmse"].get<double>() > 0);
        CHECK(point["rmse_corrected"].get<double>() <= point["rmse"].get<double>());
        CHECK(point[rule.rays].get<double>() > 0);
    }
}

inline void checkTiming(const Json& setting)
{
    CHECK(setting["timing"]["total"]["median"].get<double>() > 0);
    CHECK(setting["timing"]["tracing"]["median"].get<double>() > 0);
    CHECK(keys(setting["timing"]["overhead"]) == std::set<std::string> { "max", "median", "min", "q1", "q3" });
}

inline void checkBaselines(const Json& setting, std::size_t points, const PointRule& rule)
{
    for (const Json& baseline : setting["baselines"]) {
        checkPoints(baseline["points"], points, rule);
        CHECK(baseline["samples_saved"]["median"].get<double>() > 0);
        CHECK(baseline["extrapolated"].is_boolean());
    }
}

/// Claims of a scene that the thesis does not have: their form, and that these quantities are among them.
inline void checkClaims(const Json& claims, const std::string& prefix, const std::vector<std::string>& quantities)
{
    std::set<std::string> found;
    for (const Json& claim : claims) {
        CHECK(keys(claim) == std::set<std::string> { "goal", "id", "paper", "spread", "unit", "value" });
        const auto id = claim["id"].get<std::string>();
        REQUIRE(id.starts_with(prefix));
        CHECK(found.insert(id.substr(prefix.size())).second);
        CHECK(claim["value"].is_number());
        CHECK(claim["unit"].is_string());
        CHECK(claim["paper"].is_null());
    }
    for (const std::string& quantity : quantities) {
        INFO(quantity);
        CHECK(found.count(quantity) == 1);
    }
}

/// The claim of that id; fails the test where there is none.
inline const Json& claim(const Json& claims, const std::string& id)
{
    const auto found = std::ranges::find_if(claims, [&](const Json& c) { return c["id"] == id; });
    REQUIRE_MESSAGE(found != claims.end(), id);
    return *found;
}

struct WrongCall {
    std::vector<std::string> arguments;
    int status;
    std::string said;
};

/// Calls that end in one line of the program's.
inline void checkWrongCalls(const Workplace& place, const std::string& name, const std::vector<WrongCall>& calls)
{
    for (const WrongCall& wrong : calls) {
        const Outcome outcome = place.run(wrong.arguments);
        INFO(outcome.err);
        CHECK(outcome.status == wrong.status);
        CHECK(contains(outcome.err, name + ": error: "));
        CHECK(contains(outcome.err, wrong.said));
    }
}

} // namespace wedge::app::test
