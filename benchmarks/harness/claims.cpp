#include "benchmarks/harness/curves.h"
#include "benchmarks/harness/results.h"

#include <algorithm>
#include <functional>
#include <iterator>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

using Optional = std::optional<double>;

/// Claims of a scene, each beside the thesis' number and its goal.
class SceneClaims {
public:
    SceneClaims(const Benchmark& benchmark, const SceneResult& result)
        : list(benchmark.program, result.source.name)
        , goals_(result.source.goals)
    {
        goals_.insert(goals_.end(), benchmark.goals.begin(), benchmark.goals.end());
    }

    /// value: a number or a Summary. of: whose suffixes and numbers of the thesis there are, null for none.
    template <class Value>
    void add(const std::string& quantity, const Value& value, const std::string& unit, const CaseSetting* of = nullptr)
    {
        const std::string suffix = of != nullptr ? of->suffix() : "";
        const Optional exact = numberOf(goals_, quantity + suffix);
        list.add(quantity + suffix, value, unit, of != nullptr ? numberOf(of->of.paper.claims, quantity) : Optional(),
            exact ? exact : numberOf(goals_, quantity + "*"));
    }

    ClaimList list;

private:
    Numbers goals_;
};

void addTimes(SceneClaims& out, const Benchmark& benchmark, const CaseSetting& setting)
{
    if (benchmark.byRays) {
        out.add("rays_per_pixel", setting.raysPerPixel, "rays/pixel", &setting);
    }
    const Timing& t = setting.timing;
    if (t.columns.empty()) {
        return;
    }
    if (!benchmark.byRays) {
        out.add("spp", t.spp, "samples/pixel", &setting);
    }
    constexpr TimeClaim all[] = { { "overhead", "overhead_fraction", "1" }, { "overhead_ms", "overhead", "ms" },
        { "total_ms", "total", "ms" }, { "wall_gap", "wall_gap", "1" } };
    for (const TimeClaim& row : all) {
        out.add(row.quantity, t[row.column], row.unit, &setting);
    }
    for (const TimeClaim& row : benchmark.timeClaims) {
        out.add(row.quantity, t[row.column], row.unit, &setting);
    }
    out.add("first_frame", t.firstFrame, "1", &setting);
    out.add("mrays_s", t.megaraysPerSecond, "Mrays/s", &setting);
}

void addErrors(SceneClaims& out, const Benchmark& benchmark, const CaseSetting& setting)
{
    if (setting.method.runs.empty()) {
        return;
    }
    std::string versus;
    for (const auto& [baseline, saved] : setting.baselines) {
        const bool main = &baseline == &setting.baselines.front().baseline;
        versus = main ? "" : "_vs_" + baseline.name;
        if (!benchmark.byRays) {
            out.add("samples_saved" + versus, summarize(saved.samples), "1", &setting);
        }
        if (!saved.region.empty()) {
            out.add(benchmark.region + ("_saved" + versus), summarize(saved.region), "1", &setting);
        }
        if (benchmark.byRays || main) {
            out.add("rays_saved" + versus, summarize(saved.rays), "1", &setting);
        }
    }
    out.add("rmse", summarize(setting.method.errors()), "radiance", &setting);
    if (!setting.convergence.empty()) {
        out.add("mu_monotonic", falls(setting.convergence) ? 1 : 0, "1", &setting);
    }
    const auto addRatio = [&](const std::string& quantity, const Method& other) {
        std::vector<double> ratios;
        std::ranges::transform(setting.method.runs, other.runs, std::back_inserter(ratios),
            [](const Measured& ours, const Measured& others) { return ours.error / others.error; });
        out.add(quantity, summarize(ratios), "1", &setting);
    };
    if (setting.blur) {
        addRatio("vs_fixed_blur", *setting.blur);
    }
    if (setting.rival) {
        addRatio(std::string("vs_") + benchmark.rival->name, *setting.rival);
    }
    if (setting.fixedWidth) {
        out.add("rmse_ratio_fixed_blur", setting.fixedWidth->measured.error / setting.method.runs.front().error, "1",
            &setting);
    }
}

/// Two mu may ask for the same counts, and have the same error.
double neverRises(const std::vector<Measured>& points)
{
    return std::ranges::is_sorted(points, std::ranges::greater {}, &Measured::error) ? 1 : 0;
}

/// What variants say: rays saved at each budget, whether errors keep falling, what each part of the method is worth.
void addVariants(SceneClaims& out, const Benchmark& benchmark, const SceneResult& result)
{
    if (result.budgets.empty()) {
        return;
    }
    const CaseSetting& setting = result.settings.front();
    const Curve& unfiltered = setting.baselines.front().baseline.rays;
    const std::vector<Measured>& usual = result.curves.front().points;
    const int usualSpp = usualSettings(benchmark, setting.of, false).spp;
    const auto at = static_cast<std::size_t>(std::ranges::find(result.budgets, usualSpp) - result.budgets.begin());
    for (std::size_t i = 0; i < usual.size(); ++i) {
        out.add(fmt::format("rays_saved_{}spp", result.budgets[i]),
            costAt(unfiltered, usual[i].error).cost / usual[i].rays, "1");
    }
    out.add("error_falls", neverRises(usual), "1");
    for (std::size_t i = 1; i < result.curves.size(); ++i) {
        const std::vector<Measured>& points = result.curves[i].points;
        if (benchmark.variants[i].kind == VariantRow::OfPublished) {
            out.add("error_falls_published", neverRises(points), "1");
        } else {
            out.add(fmt::format("rmse_ratio_{}", benchmark.variants[i].name), points[at].error / usual[at].error, "1");
        }
    }
}

} // namespace

std::vector<Claim> claimsOf(const Benchmark& benchmark, const SceneResult& result)
{
    SceneClaims out(benchmark, result);
    for (const CaseSetting& setting : result.settings) {
        addTimes(out, benchmark, setting);
        addErrors(out, benchmark, setting);
    }
    addVariants(out, benchmark, result);
    for (const Bias& bias : result.biases) {
        out.add(fmt::format("bias_mu{:g}{}", bias.mu, bias.published ? "_published" : ""), bias.rms, "radiance");
    }
    if (benchmark.memorySide) {
        out.add("memory_bytes", static_cast<double>(result.memoryBytes), "B");
    }
    return std::move(out.list.claims);
}

} // namespace wedge::benchmark
