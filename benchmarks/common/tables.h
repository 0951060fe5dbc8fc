#pragma once

#include "benchmarks/common/setting_result.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// A row of a table of times: ours, or the thesis'.
struct TimingRow {
    std::string scene, label;
    double triangles = 0;
    const Timing* timing = nullptr;
    const PaperRow* paper = nullptr;
};

/// A row a setting, and the thesis' rows where they are given; beneath, how much the frames differ. heading, column: of
/// what comes before the first pass.
std::string timingTable(const std::vector<TimingRow>& rows, const std::string& heading, const std::string& column);

/// One setting's error, the reference's noise, samples saved against each baseline.
std::string errorLine(const std::string& scene, const SettingResult& setting, double noise);
std::string errorLine(const std::string& scene, const FixedBlur& blur);

/// The lines under their heading; "" for none.
std::string errorTable(const std::string& lines);

/// Claims that have a goal, and whether each is met. Goals of overhead, wall_gap and memory_bytes are upper bounds.
std::string goalTable(const std::vector<Claim>& claims);

} // namespace wedge::benchmark
