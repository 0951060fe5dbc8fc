#include "benchmarks/distributed/tables.h"

#include "benchmarks/common/tables.h"
#include "benchmarks/distributed/results.h"

#include <iterator>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

constexpr const char* row = "{:<18}{:>10}{:>10}{:>8}{:>11}{:>11}{:>10}{:>10}{:>11}{:>9}{:>10}\n";

std::string fixed(double value, int digits) { return fmt::format("{:.{}f}", value, digits); }
std::string percent(double fraction) { return fmt::format("{:.1f} %", 100 * fraction); }
template <class Form>
std::string orNothing(const std::optional<double>& value, const Form& form)
{
    return value ? form(*value) : "";
}

std::string timeLine(const DistributedResult& result, std::size_t index)
{
    const Timing& t = result.settings[index].timing;
    const auto seconds = [&](const char* column) { return fixed(1e-3 * t[column].median, 2); };
    return fmt::format(fmt::runtime(row), result.source.name, result.settings[index].name, result.triangles,
        fixed(result.raysPerPixel[index], 0), seconds("tracing"), seconds("overhead"), seconds("total"),
        percent(t["overhead_fraction"].median), seconds("wall"), percent(t["overhead_wall_fraction"].median),
        fixed(t.megaraysPerSecond, 2));
}

std::string paperLine(const PaperFrame& p)
{
    const auto whole = [](double v) { return fixed(v, 0); };
    const auto tenths = [](double v) { return fixed(v, 1); };
    return fmt::format(fmt::runtime(row), "", "thesis", orNothing(p.triangles, whole), whole(p.raysPerPixel), "", "",
        orNothing(p.seconds, tenths), orNothing(p.overhead, percent), "", "", "");
}

std::string timeLines(const DistributedResult& result)
{
    std::string out;
    for (std::size_t i = 0; i < result.settings.size(); ++i) {
        if (!result.settings[i].timing.columns.empty()) {
            out += timeLine(result, i);
        }
    }
    return !out.empty() && result.source.paper ? out + paperLine(*result.source.paper) : out;
}

std::string pointLines(const std::string& label, const std::vector<Measured>& points, double best)
{
    std::string out = fmt::format("  {:<16}", label);
    for (const Measured& point : points) {
        out += fmt::format("{:>7.0f}: {:.5f}", point.rays, point.error);
    }
    return out + (best > 0 ? fmt::format("   best widths {:.2f} px and so on\n", best) : "\n");
}

std::string errorLines(const DistributedResult& result)
{
    if (result.curves.empty()) {
        return "";
    }
    std::string out = fmt::format("{}, without the reference's noise of {:.6f}\n", result.source.name, result.noise());
    for (const VariantCurve& curve : result.curves) {
        out += pointLines(curve.name, curve.points, curve.widths.empty() ? 0.0 : curve.widths.front());
    }
    for (const auto& [baseline, saved] : result.settings.front().baselines) {
        out += pointLines(baseline.name, baseline.points, 0.0);
    }
    for (const SettingResult& setting : result.settings) {
        out += fmt::format("  rays saved, {}:", setting.name);
        for (const auto& [baseline, saved] : setting.baselines) {
            const Summary s = summarize(saved.rays);
            out += fmt::format(
                "  {} {:.2f} ({:.2f}..{:.2f}){}", baseline.name, s.median, s.min, s.max, saved.extrapolated ? "*" : "");
        }
        out += "\n";
    }
    return out;
}

} // namespace

std::string tablesOf(const std::vector<DistributedResult>& results)
{
    std::string times, errors;
    std::vector<Claim> claims;
    for (const DistributedResult& result : results) {
        times += timeLines(result);
        errors += errorLines(result);
        std::ranges::move(claimsOf(result), std::back_inserter(claims));
    }
    if (!times.empty()) {
        times.insert(0,
            "Median seconds a frame on the device, and by the host's clock\n"
                + fmt::format(fmt::runtime(row), "scene", "setting", "triangles", "rays/px", "sampling", "filter",
                    "total", "overhead", "wall", "ovh wall", "Mrays/s"));
    }
    if (!errors.empty()) {
        errors.insert(0, "\nRays a pixel: RMS error, and rays saved at equal error (* extrapolated)\n");
    }
    return times + errors + goalTable(claims);
}

} // namespace wedge::benchmark
