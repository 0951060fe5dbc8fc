#include "benchmarks/rendering_filters/results.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

/// The point of that method, count and variant; null where there is none.
const FilterPoint* pointOf(const FilteredScene& scene, render::Method method, int spp, const std::string& variant)
{
    const auto found = std::ranges::find_if(scene.points, [&](const FilterPoint& point) {
        return point.method == method && point.spp == spp && point.variant == variant;
    });
    return found != scene.points.end() ? &*found : nullptr;
}

const FilterPoint& plainOf(const FilteredScene& scene, const FilterPoint& point)
{
    return *pointOf(scene, point.method, point.spp, plainMean);
}

int sppOfClaims(const FilteredScene& scene)
{
    if (pointOf(scene, render::Method::MonteCarlo, claimedSpp, plainMean) != nullptr) {
        return claimedSpp;
    }
    int most = 0;
    for (const FilterPoint& point : scene.points) {
        most = std::max(most, point.method == render::Method::MonteCarlo ? point.spp : 0);
    }
    return most;
}

Json dataOf(const ImageErrors& errors, const ImageErrors& plain)
{
    Json out = dataOf(errors);
    out["rmse_vs_mean"] = number(errors.rmse / plain.rmse);
    out["display_vs_mean"] = number(errors.display / plain.display);
    out["flip_vs_mean"] = number(errors.flip / plain.flip);
    return out;
}

} // namespace

std::vector<Claim> claimsOf(const FilteredScene& scene)
{
    ClaimList list("rendering_filters", "path_density_" + scene.name);
    const int spp = sppOfClaims(scene);
    const auto point = [&](const char* variant) { return pointOf(scene, render::Method::MonteCarlo, spp, variant); };
    const FilterPoint* ours = point(densityVariant);
    if (ours == nullptr) {
        return {};
    }
    const FilterPoint& plain = plainOf(scene, *ours);
    list.add("error_vs_unfiltered", ours->beauty.rmse / plain.beauty.rmse, "1");
    list.add("display_vs_unfiltered", ours->beauty.display / plain.beauty.display, "1");
    if (const FilterPoint* other = point(reweightVariant)) {
        list.add("error_vs_reweighting", ours->beauty.rmse / other->beauty.rmse, "1");
    }
    if (const FilterPoint* other = point(gmonVariant)) {
        list.add("error_vs_gmon", ours->beauty.rmse / other->beauty.rmse, "1");
    }
    // Over the plain mean's of the same samples, whose own noise is none of the filter's.
    list.add("energy_error", std::abs((1.0 + ours->beauty.energy) / (1.0 + plain.beauty.energy) - 1.0), "1");
    list.add("time_vs_tracing", ours->filter / ours->tracing, "1");
    return list.claims;
}

Json dataOf(const FilteredScene& scene)
{
    Json out { { "name", scene.name }, { "origin", scene.origin },
        { "reference_noise", { { "beauty", number(scene.beautyNoise) }, { "indirect", number(scene.indirectNoise) } } },
        { "exposure", number(scene.exposure) } };
    out["points"] = Json::array();
    for (const FilterPoint& point : scene.points) {
        const FilterPoint& plain = plainOf(scene, point);
        out["points"].push_back({ { "method", render::methodName(point.method) }, { "variant", point.variant },
            { "spp", point.spp }, { "beauty", dataOf(point.beauty, plain.beauty) },
            { "indirect", dataOf(point.indirect, plain.indirect) }, { "tracing_ms", number(point.tracing) },
            { "filter_ms", number(point.filter) }, { "total_ms", number(point.total) },
            { "denoise_ms", number(point.denoising) }, { "memory_bytes", point.memory } });
    }
    return out;
}

std::string tableOf(const FilteredScene& scene)
{
    std::string out =
        fmt::format("{}: noise of references {:.6f}, of indirect light {:.6f}\n"
                    "{:<6} {:>5} {:<22} {:>9} {:>6} {:>6} {:>6} {:>8} {:>6} {:>9} {:>6} {:>8} {:>8} {:>7}\n",
            scene.name, scene.beautyNoise, scene.indirectNoise, "method", "spp", "variant", "rmse", "/mean", "disp.",
            "FLIP", "energy", "colour", "indirect", "/mean", "trace ms", "filt. ms", "MiB");
    for (const FilterPoint& p : scene.points) {
        const FilterPoint& plain = plainOf(scene, p);
        out +=
            fmt::format("{:<6} {:>5} {:<22} {:>9.6f} {:>6.3f} {:>6.3f} {:>6.3f} {:>7.2f}% {:>6.3f} {:>9.6f} {:>6.3f} "
                        "{:>8.1f} {:>8.1f} {:>7.1f}\n",
                render::methodName(p.method), p.spp, p.variant, p.beauty.rmse, p.beauty.rmse / plain.beauty.rmse,
                p.beauty.display / plain.beauty.display, p.beauty.flip / plain.beauty.flip, 100 * p.beauty.energy,
                p.beauty.colour, p.indirect.rmse, p.indirect.rmse / plain.indirect.rmse, p.tracing, p.filter,
                static_cast<double>(p.memory) / (1 << 20));
    }
    return out;
}

} // namespace wedge::benchmark
