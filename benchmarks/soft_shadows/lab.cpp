#include "benchmarks/soft_shadows/lab.h"

#include "host/image/metrics.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

using render::Shading;

// Seeds of references are apart from those of everything measured against them.
constexpr std::uint32_t referenceSeed = 0x2e5eed;

std::string keyOf(const render::Settings& settings)
{
    std::string key = fmt::format("seed {}", settings.seed);
    for (const auto& [name, value] : render::describe(settings)) {
        key += fmt::format(" {} {}", name, value);
    }
    return key;
}

std::string shortDescription(const render::Settings& s)
{
    constexpr const char* shadings[] = { "separate", "inside", "ratio" };
    const std::string shading = shadings[static_cast<int>(s.shading)];
    const std::string sampler = s.sampler == render::Sampler::Sobol ? "sobol" : "stratified";
    if (s.method == render::Method::MonteCarlo) {
        return fmt::format("unfiltered {} {}", sampler, shading);
    }
    const std::string filter = s.filtering == render::Filtering::None ? "UF"
        : s.filtering == render::Filtering::Adaptive                  ? "AF"
                                                                      : fmt::format("NAF {:.2f} px", s.fixedWidth);
    return fmt::format("{} mu {:.2f} {} {}", s.published ? "published" : "default", s.mu,
        s.sampling == render::Sampling::Adaptive ? "AS" : "NAS", filter);
}

} // namespace

void progress(const std::string& text)
{
    fmt::print(stderr, "soft_shadows: {}\n", text);
    std::fflush(stderr);
}

Lab::Lab(const scene::Scene& scene, const device::Device& device, const Plan& plan, std::string name)
    : plan_(plan)
    , name_(std::move(name))
    , renderer_(scene, device)
{
}

Measured Lab::measure(render::Settings settings, std::uint32_t seed)
{
    settings.width = plan_.width;
    settings.height = plan_.height;
    settings.seed = seed;
    const std::string key = keyOf(settings);
    if (const auto found = measured_.find(key); found != measured_.end()) {
        return found->second;
    }
    const image::RgbImage& truth = reference(settings.shading).image;
    const render::FrameStatistics frame = renderer_.render(settings);
    Measured out;
    out.spp = frame.sppMean;
    out.shadowRays =
        static_cast<double>(frame.shadowRays) / static_cast<double>(std::max<std::uint64_t>(1, frame.shadedPixels));
    out.rmse = image::rmse(beautyOf(renderer_, settings, frame), truth);
    out.mu = settings.mu;
    out.seed = seed;
    progress(fmt::format("{}: {:<40} {:7.2f} spp  rmse {:.6f}  {:6.1f} s", name_, shortDescription(settings), out.spp,
        out.rmse, 1e-3 * frame.wallMilliseconds));
    measured_.emplace(key, out);
    return out;
}

const Reference& Lab::reference(Shading shading)
{
    const Shading kind = shading == Shading::Separate ? Shading::Separate : Shading::Ratio;
    if (const auto found = references_.find(kind); found != references_.end()) {
        return found->second;
    }
    // Light that is known exactly where nothing is in the way needs no samples: less noise than plain Monte Carlo has.
    // The thesis' shading is compared at larger errors, so that half the samples do.
    const int spp = kind == Shading::Ratio ? plan_.referenceSpp : plan_.referenceSpp / 2;
    render::Settings settings = render::monteCarlo(spp);
    settings.shading = kind;
    settings.width = plan_.width;
    settings.height = plan_.height;
    settings.seed = referenceSeed;
    const std::string label =
        fmt::format("{}: reference, {}", name_, kind == Shading::Ratio ? "true integral" : "shading apart");
    progress(fmt::format("{}, {} spp ...", label, spp));
    const auto start = std::chrono::steady_clock::now();
    Reference made = obtainReference(renderer_, settings, plan_.referenceFolder, name_);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress(fmt::format(
        "{} {} in {:.1f} s, noise {:.6f} RMS", label, made.cached ? "read" : "rendered", seconds, made.noise));
    if (made.otherKernels) {
        progress(fmt::format("{}: kernels have changed since {} was rendered; delete it if they compute something else",
            name_, made.path));
    }
    return references_.emplace(kind, std::move(made)).first->second;
}

double withoutNoise(double rmse, double noise) { return std::sqrt(std::max(0.0, rmse * rmse - noise * noise)); }

} // namespace wedge::benchmark
