#include "benchmarks/harness/benchmark.h"

#include "benchmarks/common/variants.h"

#include <algorithm>

namespace wedge::benchmark {
namespace {

render::Settings shown(const Case& of, render::Settings settings)
{
    settings.bounces = of.bounces.value_or(0);
    if (of.ambient) {
        settings.integrator = render::Integrator::AmbientOcclusion;
        settings.indirect.ambientDistance = of.ambientDistance;
    }
    return settings;
}

} // namespace

render::Settings methodSettings(const Case& of, bool published, std::optional<int> spp, std::optional<float> mu)
{
    return shown(of, published ? render::asPublished(mu) : render::axisAligned(spp, mu));
}

render::Settings usualSettings(const Benchmark& benchmark, const Case& of, bool published)
{
    return published ? methodSettings(of, true, {}, benchmark.usualMu) : methodSettings(of, false, benchmark.usualSpp);
}

render::Settings baselineSettings(const BaselineRow& row, const Case& of, int spp)
{
    render::Settings out = shown(of, plain(row.sampler, spp));
    if (row.change) {
        row.change(out);
    }
    return out;
}

const char* settingName(bool published) { return published ? "published" : "default"; }

std::optional<double> numberOf(const Numbers& numbers, const std::string& name)
{
    const auto found = std::ranges::find(numbers, name, &std::pair<std::string, double>::first);
    return found == numbers.end() ? std::nullopt : std::optional(found->second);
}

} // namespace wedge::benchmark
