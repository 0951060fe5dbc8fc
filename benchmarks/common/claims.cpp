#include "benchmarks/common/claims.h"

#include "host/image/atomic_file.h"
#include "host/render/metadata.h"

#include <cmath>

namespace wedge::benchmark {
namespace {

Json orNull(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

} // namespace

ClaimList::ClaimList(const std::string& benchmark, const std::string& scene)
    : prefix_(benchmark + "." + scene + ".")
{
}

void ClaimList::add(const std::string& quantity, const Summary& value, const std::string& unit,
    std::optional<double> paper, std::optional<double> goal)
{
    claims.push_back({ prefix_ + quantity, value.median, unit, value.spread(), paper, goal });
}

void ClaimList::add(const std::string& quantity, double value, const std::string& unit, std::optional<double> paper,
    std::optional<double> goal)
{
    claims.push_back({ prefix_ + quantity, value, unit, {}, paper, goal });
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json(const Summary& s)
{
    return { { "median", number(s.median) }, { "q1", number(s.q1) }, { "q3", number(s.q3) }, { "min", number(s.min) },
        { "max", number(s.max) } };
}

Json json(const device::DeviceInfo& d)
{
    return { { "name", d.name }, { "platform", d.platform }, { "platform_version", d.platformVersion },
        { "driver", d.driver }, { "type", device::deviceTypeName(d.type) }, { "compute_units", d.computeUnits },
        { "host_timers", d.hostTimers } };
}

Json json(const Claim& c)
{
    return { { "id", c.id }, { "value", number(c.value) }, { "unit", c.unit }, { "spread", orNull(c.spread) },
        { "paper", orNull(c.paper) }, { "goal", orNull(c.goal) } };
}

Json resultSkeleton(const std::string& benchmark, const device::DeviceInfo& device)
{
    Json out;
    out["benchmark"] = benchmark;
    out["wedge"] = render::version();
    out["device"] = json(device);
    out["claims"] = Json::array();
    return out;
}

void addClaims(Json& results, const std::vector<Claim>& claims)
{
    for (const Claim& claim : claims) {
        results["claims"].push_back(json(claim));
    }
}

void writeJson(const std::string& path, const Json& results)
{
    image::AtomicFile file(path);
    // Paths may hold bytes that are not UTF-8: replaced, as JSON has no other way.
    file.write(results.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    file.commit();
}

} // namespace wedge::benchmark
