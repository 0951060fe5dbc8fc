#include "benchmarks/indirect/tables.h"

#include "benchmarks/common/tables.h"
#include "benchmarks/indirect/results.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

/// The scene's name, and its bounces where they are not one.
std::string rowName(const SceneResult& result, int bounces)
{
    return bounces == 0 ? result.source.name + ", ao"
        : bounces == 1  ? result.source.name
                        : fmt::format("{}, {} b.", result.source.name, bounces);
}

void addTimes(const SceneResult& result, std::vector<TimingRow>& rows)
{
    for (const BounceCase& paths : result.source.cases) {
        for (const IndirectSetting& setting : result.settings) {
            if (setting.bounces == paths.bounces) {
                rows.push_back({ rowName(result, paths.bounces), setting.name, static_cast<double>(result.triangles),
                    &setting.timing });
            }
        }
        if (paths.paper != nullptr) {
            rows.push_back({ "", "", 0, nullptr, paths.paper });
        }
    }
}

std::string errorLines(const SceneResult& result)
{
    std::string out;
    for (const IndirectSetting& setting : result.settings) {
        if (!setting.method.runs.empty()) {
            out += errorLine(rowName(result, setting.bounces), setting, result.noiseOf(setting.bounces));
        }
        if (setting.fixedBlur) {
            out += errorLine(rowName(result, setting.bounces), *setting.fixedBlur);
        }
    }
    return out;
}

std::string biasLines(const SceneResult& result)
{
    std::string out;
    for (const Bias& b : result.biases) {
        out += fmt::format("{:<22}{:>10}{:>7.1f} spp  mu {:g}  bias {:.6f}  of the mean {:+.2f} %  rmse {:.6f}\n",
            result.source.name, b.setting, b.spp, b.mu, b.rms, 100 * b.meanError, b.rmse);
    }
    return out;
}

} // namespace

std::string tablesOf(const std::vector<SceneResult>& results)
{
    std::vector<TimingRow> rows;
    std::string errors, biases;
    std::vector<Claim> claims;
    for (const SceneResult& result : results) {
        addTimes(result, rows);
        errors += errorLines(result);
        biases += biasLines(result);
        std::ranges::move(claimsOf(result), std::back_inserter(claims));
    }
    if (!biases.empty()) {
        biases.insert(0, "\nWhat the filter blurs: RMS of many images' mean\n");
    }
    return timingTable(rows, "cam+dir", "camera_and_direct") + errorTable(errors) + biases + goalTable(claims);
}

} // namespace wedge::benchmark
