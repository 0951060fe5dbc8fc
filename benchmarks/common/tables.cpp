#include "benchmarks/common/tables.h"

#include "benchmarks/common/image_bias.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

constexpr const char* timingHead =
    "{:<22}{:>10}{:>8}{:>7}{:>9}{:>9}{:>9}{:>9}{:>9}{:>8}{:>8}{:>9}{:>9}{:>8}{:>8}{:>8}{:>7}\n";
constexpr const char* timingLine =
    "{:<22}{:>10}{:>8}{:>7.1f}{:>9}{:>9.1f}{:>9.1f}{:>9.1f}{:>9.2f}{:>8}{:>8.2f}{:>9}{:>9.2f}"
    "{:>8.1f}{:>8.2f}{:>8.2f}{:>7}\n";

std::string percent(double fraction) { return fmt::format("{:.1f} %", 100 * fraction); }

std::string shortNumber(double n) { return n < 1e3 ? fmt::format("{:.0f}", n) : fmt::format("{:.1f}K", n / 1e3); }

std::string lineOf(const TimingRow& row, const std::string& column)
{
    const Timing& t = *row.timing;
    const auto ms = [&](const std::string& name) { return t[name].median; };
    return fmt::format(fmt::runtime(timingLine), row.scene, row.label, shortNumber(row.triangles), t.spp,
        fmt::format("{:.1f}", ms(column)), ms("first_pass"), ms("second_pass"), ms("tracing"), ms("widths_and_counts"),
        fmt::format("{:.2f}", ms("first_pass_filter")), ms("filter"), fmt::format("{:.2f}", ms("composite")),
        ms("overhead"), ms("total"), ms("fps_with"), ms("fps_without"), percent(ms("overhead_fraction")));
}

std::string lineOf(const PaperRow& p)
{
    return fmt::format(fmt::runtime(timingLine), "", "thesis", shortNumber(p.triangles), p.spp, "", p.firstPass,
        p.secondPass, p.tracing, p.analysis, "", p.filter, "", p.overhead, p.total, p.fpsWith, p.fpsWithout,
        percent(p.overhead / p.total));
}

/// Times that one setting's frames differ in, and what the host's clock adds.
std::string spreadLine(const TimingRow& row)
{
    const Timing& t = *row.timing;
    return fmt::format("{:<22}{:>10}  total {:.1f} to {:.1f} ms, overhead {:.2f} to {:.2f} ms, wall clock {:.1f} ms, "
                       "gap {}, {:.1f} Mrays/s\n",
        row.scene, row.label, t["total"].min, t["total"].max, t["overhead"].min, t["overhead"].max, t["wall"].median,
        percent(t["wall_gap"].median), t.megaraysPerSecond);
}

std::string savingsText(const SettingResult& setting)
{
    std::string out;
    for (const auto& [baseline, saved] : setting.baselines) {
        const Summary s = summarize(saved.samples);
        out += fmt::format(
            "  {} {:.2f} ({:.2f}..{:.2f}){}", baseline.name, s.median, s.min, s.max, saved.extrapolated ? "*" : "");
    }
    return out;
}

bool met(const Claim& claim)
{
    const bool upperBound = std::ranges::any_of(std::array { ".overhead", ".wall_gap", ".memory_bytes" },
        [&](const char* quantity) { return claim.id.find(quantity) != std::string::npos; });
    return upperBound ? claim.value <= *claim.goal : claim.value >= *claim.goal;
}

} // namespace

std::string timingTable(const std::vector<TimingRow>& rows, const std::string& heading, const std::string& column)
{
    std::string out = "Median milliseconds a frame on the device\n";
    out += fmt::format(fmt::runtime(timingHead), "scene", "setting", "tris", "spp", heading, "1st pass", "2nd pass",
        "tracing", "widths+n", "of 1st", "filter", "compos.", "overhead", "total", "fps", "fps w/o", "ovh");
    std::string spreads = "\nSpread over the frames, and the host's clock\n";
    for (const TimingRow& row : rows) {
        if (row.paper != nullptr) {
            out += lineOf(*row.paper);
        } else {
            out += lineOf(row, column);
            spreads += spreadLine(row);
        }
    }
    return out + spreads;
}

std::string errorLine(const std::string& scene, const SettingResult& setting, double noise)
{
    const Measured& run = setting.method.runs.front();
    return fmt::format("{:<22}{:>10}{:>7.1f} spp  rmse {:.6f}  without the reference's noise ({:.6f}) {:.6f}{}\n",
        scene, setting.name, run.spp, run.rmse, noise, withoutNoise(run.rmse, noise), savingsText(setting));
}

std::string errorLine(const std::string& scene, const FixedBlur& blur)
{
    return fmt::format("{:<22}{:>10}{:>7.1f} spp  rmse {:.6f}  one width of {:.2f} pixels for the whole image\n", scene,
        "fixed", blur.measured.spp, blur.measured.rmse, blur.width);
}

std::string errorTable(const std::string& lines)
{
    return lines.empty()
        ? ""
        : "\nRMS errors, and samples saved against each unfiltered baseline (* extrapolated)\n" + lines;
}

std::string goalTable(const std::vector<Claim>& claims)
{
    std::string out = "\nGoals\n";
    for (const Claim& claim : claims) {
        if (claim.goal) {
            out += fmt::format("{:<60}{:>10.3f}  goal {:>6g}  {}\n", claim.id, claim.value, *claim.goal,
                met(claim) ? "met" : "missed");
        }
    }
    return out;
}

} // namespace wedge::benchmark
