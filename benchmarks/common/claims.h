#pragma once

#include "benchmarks/common/statistics.h"
#include "host/device/limits.h"

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace wedge::benchmark {

using Json = nlohmann::ordered_json;

/// One measured quantity, beside what the paper reports and what we aim at.
struct Claim {
    std::string id; ///< "<benchmark>.<scene>.<quantity>"
    double value = 0;
    std::string unit; ///< "1" for ratios and fractions
    std::optional<double> spread; ///< between the quartiles of its repetitions; none for a single measurement
    std::optional<double> paper, goal;
};

/// Collects the claims of one scene.
class ClaimList {
public:
    ClaimList(const std::string& benchmark, const std::string& scene);

    /// The median, with the distance between the quartiles as spread.
    void add(const std::string& quantity, const Summary& value, const std::string& unit,
        std::optional<double> paper = {}, std::optional<double> goal = {});
    void add(const std::string& quantity, double value, const std::string& unit, std::optional<double> paper = {},
        std::optional<double> goal = {});

    std::vector<Claim> claims;

private:
    std::string prefix_;
};

/// null for values that are not finite.
Json number(double value);
/// {"median", "q1", "q3", "min", "max"}.
Json json(const Summary& summary);
Json json(const device::DeviceInfo& device);
Json json(const Claim& claim);

/// The skeleton of a benchmark's results: {"benchmark", "wedge", "device", "claims": []}.
Json resultSkeleton(const std::string& benchmark, const device::DeviceInfo& device);

/// Adds claims to results.
void addClaims(Json& results, const std::vector<Claim>& claims);

/// Writes results as text of several lines; the file appears whole or not at all. Throws Error.
void writeJson(const std::string& path, const Json& results);

} // namespace wedge::benchmark
