#include "benchmarks/soft_shadows/tables.h"

#include "benchmarks/common/tables.h"
#include "benchmarks/soft_shadows/results.h"

#include <algorithm>
#include <iterator>

namespace wedge::benchmark {
namespace {

std::string errorLines(const SceneResult& result)
{
    std::string out;
    for (const ShadowSetting& setting : result.settings) {
        if (!setting.method.runs.empty()) {
            out += errorLine(result.source.name, setting, result.noiseOf(setting.name));
        }
    }
    return result.fixedBlur ? out + errorLine(result.source.name, *result.fixedBlur) : out;
}

} // namespace

std::string tablesOf(const std::vector<SceneResult>& results)
{
    std::vector<TimingRow> rows;
    std::string errors;
    std::vector<Claim> claims;
    for (const SceneResult& result : results) {
        for (const ShadowSetting& setting : result.settings) {
            rows.push_back(
                { result.source.name, setting.name, static_cast<double>(result.triangles), &setting.timing });
        }
        if (result.source.paper != nullptr) {
            rows.push_back({ "", "", 0, nullptr, result.source.paper });
        }
        errors += errorLines(result);
        std::ranges::move(claimsOf(result), std::back_inserter(claims));
    }
    return timingTable(rows, "primary", "primary") + errorTable(errors) + goalTable(claims);
}

} // namespace wedge::benchmark
