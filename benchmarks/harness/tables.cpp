#include "benchmarks/harness/tables.h"

#include "benchmarks/common/image_bias.h"
#include "benchmarks/harness/results.h"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

std::string rowStart(const std::string& scene, const std::string& setting)
{
    return fmt::format("{:<22}{:>10}", scene, setting);
}

std::string rowStart(const SceneResult& result, const CaseSetting& setting)
{
    return rowStart(result.source.name + setting.of.label, settingName(setting.published));
}

double valueOf(const CaseSetting& setting, const std::string& value)
{
    return value == "triangles"     ? static_cast<double>(setting.triangles)
        : value == "spp"            ? setting.timing.spp
        : value == "rays_per_pixel" ? setting.raysPerPixel
        : value == "mrays_s"        ? setting.timing.megaraysPerSecond
                                    : setting.timing[value].median;
}

std::optional<double> valueOf(const Paper& paper, const std::string& key)
{
    const auto found = paper.row.find(key);
    return found == paper.row.end() || found->is_null() ? numberOf(paper.claims, key)
                                                        : std::optional(found->get<double>());
}

/// A row of a table of times, of what `cell` says of each column.
template <class Cell>
std::string timeRow(const Benchmark& benchmark, const std::string& start, const Cell& cell)
{
    std::string out = start;
    for (const TableColumn& column : benchmark.times) {
        out += fmt::format("{:>{}}", cell(column), column.width);
    }
    return out + "\n";
}

std::string timeLines(const Benchmark& benchmark, const SceneResult& result)
{
    std::string out;
    for (const CaseSetting& setting : result.settings) {
        if (setting.timing.columns.empty()) {
            continue;
        }
        out += timeRow(benchmark, rowStart(result, setting),
            [&](const TableColumn& column) { return column.form(valueOf(setting, column.value)); });
        if (setting.published && !setting.of.paper.row.is_null()) {
            out += timeRow(benchmark, rowStart("", "thesis"), [&](const TableColumn& column) {
                const std::optional<double> value = valueOf(setting.of.paper, column.paper);
                return value ? column.form(*value) : std::string();
            });
        }
    }
    return out;
}

/// Times that each setting's frames differ in, and what the host's clock adds.
std::string spreadLines(const SceneResult& result)
{
    std::string out;
    for (const CaseSetting& setting : result.settings) {
        const Timing& t = setting.timing;
        if (!t.columns.empty()) {
            out += fmt::format("{}  total {:.1f} to {:.1f} ms, overhead {:.2f} to {:.2f} ms, wall clock {:.1f} ms, "
                               "gap {}, {:.1f} Mrays/s\n",
                rowStart(result, setting), t["total"].min, t["total"].max, t["overhead"].min, t["overhead"].max,
                t["wall"].median, percent(t["wall_gap"].median), t.megaraysPerSecond);
        }
    }
    return out;
}

std::string savedText(const Benchmark& benchmark, const CaseSetting& setting)
{
    std::string out;
    for (const auto& [baseline, saved] : setting.baselines) {
        const Summary s = summarize(benchmark.byRays ? saved.rays : saved.samples);
        out += fmt::format(
            "  {} {:.2f} ({:.2f}..{:.2f}){}", baseline.name, s.median, s.min, s.max, saved.extrapolated ? "*" : "");
    }
    return out;
}

/// What is saved in Subject::regionOf(); empty where there is none.
std::string regionText(const CaseSetting& setting)
{
    std::string out;
    for (const auto& [baseline, saved] : setting.baselines) {
        if (!saved.region.empty()) {
            const Summary s = summarize(saved.region);
            out += fmt::format("  {} {:.2f} ({:.2f}..{:.2f}){}", baseline.name, s.median, s.min, s.max,
                saved.regionExtrapolated ? "*" : "");
        }
    }
    return out;
}

/// A variant's, or a baseline's, errors by rays.
std::string pointLine(const std::string& name, const std::vector<Measured>& points, const std::vector<double>& widths)
{
    std::string out = fmt::format("  {:<20}", name);
    for (const Measured& point : points) {
        out += fmt::format("{:>7.0f}: {:.5f}", point.rays, point.error);
    }
    return out + (widths.empty() ? "\n" : fmt::format("   best widths {:.2f} px and so on\n", widths.front()));
}

std::string errorLines(const Benchmark& benchmark, const SceneResult& result)
{
    std::string out;
    for (const CaseSetting& setting : result.settings) {
        if (setting.method.runs.empty()) {
            continue;
        }
        const Measured& run = setting.method.runs.front();
        out += fmt::format("{}{:>7.1f} spp  rmse {:.6f}  without the reference's noise ({:.6f}) {:.6f}{}\n",
            rowStart(result, setting), run.spp, run.rmse, setting.noise, run.corrected, savedText(benchmark, setting));
        if (const std::string apart = regionText(setting); !apart.empty()) {
            out += fmt::format("{}  {} part, {} of the image:{}\n", rowStart("", ""), benchmark.region,
                percent(setting.regionFraction), apart);
        }
        if (setting.blur) {
            const Measured& blurred = setting.blur->runs.front();
            out += fmt::format("{}{:>7.1f} spp  rmse {:.6f}  {:g} pixels for the whole image\n",
                rowStart(result.source.name + setting.of.label, "blur"), blurred.spp, blurred.rmse,
                *benchmark.blurWidth);
        }
        if (setting.rival) {
            const Measured& other = setting.rival->runs.front();
            out += fmt::format("{}{:>7.1f} spp  rmse {:.6f}  {}\n",
                rowStart(result.source.name + setting.of.label, benchmark.rival->name), other.spp, other.rmse,
                benchmark.rival->meaning);
        }
        if (setting.fixedWidth) {
            const Measured& fixed = setting.fixedWidth->measured;
            out += fmt::format("{}{:>7.1f} spp  rmse {:.6f}  one width of {:.2f} pixels for the whole image\n",
                rowStart(result.source.name + setting.of.label, "fixed"), fixed.spp, fixed.rmse,
                setting.fixedWidth->width);
        }
    }
    for (std::size_t i = 0; i < benchmark.variants.size() && !result.curves.empty(); ++i) {
        out += pointLine(benchmark.variants[i].name, result.curves[i].points, result.curves[i].widths);
    }
    if (!benchmark.variants.empty() && !result.curves.empty()) {
        for (const auto& [baseline, saved] : result.settings.front().baselines) {
            out += pointLine(baseline.name, baseline.points, {});
        }
    }
    return out;
}

std::string biasLines(const SceneResult& result)
{
    std::string out;
    for (const Bias& b : result.biases) {
        out += fmt::format("{}{:>7.1f} spp  mu {:g}  bias {:.6f}  of the mean {:+.2f} %  rmse {:.6f}\n",
            rowStart(result.source.name, settingName(b.published)), b.spp, b.mu, b.rms, 100 * b.meanError, b.rmse);
    }
    return out;
}

bool met(const Claim& claim)
{
    const bool upperBound =
        std::ranges::any_of(std::array { ".overhead", ".wall_gap", ".first_frame", ".memory_bytes", ".vs_fixed_blur" },
            [&](const char* quantity) { return claim.id.find(quantity) != std::string::npos; });
    return upperBound ? claim.value <= *claim.goal : claim.value >= *claim.goal;
}

/// Claims that have a goal, and whether each is met. Goals of what met() lists are
/// upper bounds.
std::string goalLines(const std::vector<Claim>& claims)
{
    std::string out;
    for (const Claim& claim : claims) {
        if (claim.goal) {
            out += fmt::format("{:<60}{:>10.3f}  goal {:>6g}  {}\n", claim.id, claim.value, *claim.goal,
                met(claim) ? "met" : "missed");
        }
    }
    return out;
}

std::string headed(const std::string& heading, const std::string& lines)
{
    return lines.empty() ? "" : heading + "\n" + lines;
}

} // namespace

std::string wholeNumber(double value) { return fmt::format("{:.0f}", value); }
std::string shortNumber(double value) { return value < 1e3 ? wholeNumber(value) : fmt::format("{:.1f}K", value / 1e3); }
std::string tenths(double value) { return fmt::format("{:.1f}", value); }
std::string hundredths(double value) { return fmt::format("{:.2f}", value); }
std::string secondsOf(double milliseconds) { return hundredths(1e-3 * milliseconds); }
std::string percent(double fraction) { return fmt::format("{:.1f} %", 100 * fraction); }

std::string tablesOf(const Benchmark& benchmark, const std::vector<SceneResult>& results)
{
    std::string times, spreads, errors, biases, goals;
    for (const SceneResult& result : results) {
        times += timeLines(benchmark, result);
        spreads += spreadLines(result);
        errors += errorLines(benchmark, result);
        biases += biasLines(result);
        goals += goalLines(claimsOf(benchmark, result));
    }
    const std::string heads = timeRow(
        benchmark, rowStart("scene", "setting"), [](const TableColumn& column) { return std::string(column.heading); });
    const std::string saved = benchmark.byRays ? "rays" : "samples";
    return headed(fmt::format("Median {} a frame on the device", benchmark.byRays ? "seconds" : "milliseconds"),
               times.empty() ? "" : heads + times)
        + headed("\nSpread over the frames, and the host's clock", spreads)
        + headed("\nRMS errors, and " + saved + " saved against each unfiltered baseline (* extrapolated)"
                + (benchmark.byRays ? "; errors by rays a pixel" : ""),
            errors)
        + headed("\nWhat the filter blurs: RMS of many images' mean", biases) + headed("\nGoals", goals);
}

} // namespace wedge::benchmark
