#include "benchmarks/rays/tables.h"

#include <algorithm>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

/// "| a | b |" and the line below a head.
std::string row(const std::vector<std::string>& cells)
{
    std::string out = "|";
    for (const std::string& cell : cells)
        out += " " + cell + " |";
    return out + "\n";
}

std::string head(const std::vector<std::string>& cells)
{
    return row(cells) + row(std::vector<std::string>(cells.size(), "---"));
}

std::string spreadText(const std::vector<double>& values, int digits)
{
    const Summary s = summarize(values);
    return fmt::format("{:.{}f} ±{:.{}f}", s.median, digits, s.spread() / 2, digits);
}

std::string ratioText(const ClassResult& c, const std::string& mode, const std::string& theirs)
{
    return spreadText(c.ratios(c.chosen(mode), theirs), 2);
}

} // namespace

std::string throughputTables(const RayResults& results)
{
    std::string out;
    for (const RaySceneResult& scene : results.scenes) {
        if (scene.classes.empty())
            continue;
        out += fmt::format("\n**{}**, {} triangles, Mrays/s (median ± half the distance of the quartiles)\n\n",
            scene.name, scene.triangles);
        std::vector<std::string> names { "" };
        for (const ClassResult& c : scene.classes)
            names.push_back(c.name);
        out += head(names);
        for (const Runs& runs : scene.classes.front().runs) {
            std::vector<std::string> cells { runs.name };
            for (const ClassResult& c : scene.classes)
                cells.push_back(spreadText(c.megarays(runs.name), 2));
            out += row(cells);
        }
    }
    return out;
}

std::string ratioTable(const RayResults& results)
{
    std::string out = "\nOurs (packets) over Embree's, median of paired runs\n\n"
        + head({ "scene", "rays", "over single", "over packets high", "over best", "which", "quality: over single",
            "over packets high", "over best" });
    for (const RaySceneResult& scene : results.scenes)
        for (const ClassResult& c : scene.classes)
            out += row({ scene.name, c.name, ratioText(c, "", "embree single"), ratioText(c, "", "embree packets high"),
                ratioText(c, "", c.embreeBest()), c.embreeBest(), ratioText(c, "quality", "embree single"),
                ratioText(c, "quality", "embree packets high"), ratioText(c, "quality", c.embreeBest()) });
    return results.scenes.empty() ? "" : out;
}

std::string modelTable(const RayResults& results)
{
    std::string out = "\nWhat a ray does, alone in the default hierarchy, and the distance to the port limit\n\n"
        + head({ "scene", "rays", "nodes", "blocks", "port limit, cycles", "single, cycles", "over the limit" });
    for (const RaySceneResult& scene : results.scenes)
        for (const ClassResult& c : scene.classes) {
            const double cycles = results.plan.timeStampHertz * results.plan.timing.threads * 1e-6
                / summarize(c.megarays(wedgeColumn(false, ""))).median;
            const double limit = portCycles(c.counts);
            out += row({ scene.name, c.name, fmt::format("{:.1f}", c.counts.nodes),
                fmt::format("{:.1f}", c.counts.blocks), fmt::format("{:.0f}", limit), fmt::format("{:.0f}", cycles),
                fmt::format("{:.1f}", cycles / limit) });
        }
    return results.scenes.empty() ? "" : out;
}

std::string differenceTable(const RayResults& results)
{
    std::vector<std::string> names { "scene", "rays", "of", "differ" };
    std::ranges::copy(disagreementKinds(), std::back_inserter(names));
    for (const char* name : { "ours right", "Embree right", "differ from robust", "packets unlike single" })
        names.push_back(name);
    std::string out = "\nHits that differ from Embree's (default build, single rays)\n\n" + head(names);
    for (const RaySceneResult& scene : results.scenes)
        for (const ClassResult& c : scene.classes) {
            const Comparison& d = c.difference;
            std::vector<std::string> cells { scene.name, c.name, std::to_string(d.rays),
                std::to_string(d.disagreements.size()) };
            for (const std::string& kind : disagreementKinds())
                cells.push_back(std::to_string(d.count(kind)));
            for (const std::size_t n :
                { d.right("ours"), d.right("embree"), c.differenceFromRobust.disagreements.size(), c.packetMismatches })
                cells.push_back(std::to_string(n));
            out += row(cells);
        }
    return results.scenes.empty() ? "" : out;
}

std::string frameTable(const RayResults& results)
{
    std::string out = "\nA whole frame of direct light, ms\n\n"
        + head({ "scene", "ours", "Embree single", "Embree packets high", "over single", "over packets", "RMSE / mean",
            "pixels that differ" });
    bool any = false;
    for (const RaySceneResult& scene : results.scenes) {
        if (!scene.frame)
            continue;
        any = true;
        const FrameResult& f = *scene.frame;
        const auto ms = [](const std::vector<double>& s) { return fmt::format("{:.1f}", 1e3 * summarize(s).median); };
        out += row({ scene.name, ms(f.ourSeconds()), ms(f.runs[1].seconds), ms(f.runs[2].seconds),
            spreadText(f.ratios("embree frame single"), 2), spreadText(f.ratios("embree frame packets high"), 2),
            fmt::format("{:.1e}", f.rmse / f.mean), std::to_string(f.differentPixels) });
    }
    return any ? out : "";
}

std::string growthTable(const RayResults& results)
{
    if (results.growth.empty())
        return "";
    std::string out = "\nThe growing field, nanoseconds a ray\n\n";
    std::vector<std::string> names { "triangles" };
    for (const ClassResult& c : results.growth.front().classes)
        for (const std::string& column :
            { c.chosen(), std::string("embree single"), std::string("embree packets high") })
            names.push_back(c.name + ", " + column);
    out += head(names);
    for (const GrowthPoint& point : results.growth) {
        std::vector<std::string> cells { std::to_string(point.triangles) };
        for (const ClassResult& c : point.classes)
            for (const std::string& column :
                { c.chosen(), std::string("embree single"), std::string("embree packets high") })
                cells.push_back(fmt::format("{:.0f}", 1e3 / summarize(c.megarays(column)).median));
        out += row(cells);
    }
    return out;
}

std::string goalTable(const RayResults& results)
{
    std::string out = "\nGoals\n\n" + head({ "claim", "value", "goal", "" });
    for (const Claim& claim : claimsOf(results))
        if (claim.goal) {
            const bool upperBound = claim.id.ends_with("_hits") || claim.id.ends_with("_time_ratio_vs_embree");
            const bool met = upperBound ? claim.value <= *claim.goal : claim.value >= *claim.goal;
            out += row({ claim.id, fmt::format("{:.2f}", claim.value), fmt::format("{:.2f}", *claim.goal),
                met ? "met" : "missed" });
        }
    return out;
}

} // namespace wedge::benchmark
