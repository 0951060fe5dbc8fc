#include "benchmarks/common/lab.h"

#include "benchmarks/common/image_bias.h"
#include "benchmarks/common/smooth_region.h"
#include "host/image/metrics.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

// Seeds of references are apart from those of everything measured against them.
constexpr std::uint32_t referenceSeed = 0x2e5eed;

// Of an error, at least this is taken to be the image's own: the reference's noise is not known better.
constexpr double leastOwnError = 0.1;

std::string keyOf(const render::Settings& settings)
{
    std::string key = fmt::format("seed {}", settings.seed);
    for (const auto& [name, value] : render::describe(settings)) {
        key += fmt::format(" {} {}", name, value);
    }
    return key;
}

} // namespace

void progress(const std::string& program, const std::string& text)
{
    fmt::print(stderr, "{}: {}\n", program, text);
    std::fflush(stderr);
}

std::string describeVariant(const render::Settings& s, float mu, bool adaptiveCounts)
{
    const std::string filter = s.filtering == render::Filtering::None ? "UF"
        : s.filtering == render::Filtering::Adaptive                  ? "AF"
                                                                      : fmt::format("NAF {:.2f} px", s.fixedWidth);
    return fmt::format(
        "{} mu {:.2f} {} {}", s.published ? "published" : "default", mu, adaptiveCounts ? "AS" : "NAS", filter);
}

Lab::Lab(const scene::Scene& scene, const device::Device& device, const Subject& subject, const MeasurePlan& plan,
    std::string name)
    : subject_(subject)
    , plan_(plan)
    , name_(std::move(name))
    , renderer_(scene, device)
{
}

void Lab::say(const std::string& text) const { progress(subject_.program(), name_ + ": " + text); }

render::FrameStatistics Lab::renderFrame(render::Settings& settings, std::uint32_t seed)
{
    settings.width = plan_.width;
    settings.height = plan_.height;
    settings.seed = seed;
    return renderer_.render(settings, {}, !subject_.layer().empty());
}

image::RgbImage Lab::render(render::Settings settings, std::uint32_t seed)
{
    const render::FrameStatistics frame = renderFrame(settings, seed);
    return imageOf(renderer_, settings, frame, subject_.layer());
}

Measured Lab::measure(render::Settings settings, std::uint32_t seed)
{
    settings.seed = seed;
    const std::string key = keyOf(settings);
    if (const auto found = measured_.find(key); found != measured_.end()) {
        return found->second;
    }
    const Reference& truth = reference(settings);
    const render::FrameStatistics frame = renderFrame(settings, seed);
    Measured out;
    out.spp = subject_.sppOf(frame);
    out.rays = subject_.raysOf(frame) / std::max(1.0, subject_.pixelsOf(frame));
    const image::RgbImage image = imageOf(renderer_, settings, frame, subject_.layer());
    out.rmse = image::rmse(image, truth.image);
    if (const std::vector<bool>& part = region(settings); !part.empty()) {
        const RegionError error = regionError(image, truth, part);
        out.regionError = withoutNoiseOf(error.rmse, error.noise);
    }
    out.error = compared(out.rmse, settings);
    out.mu = subject_.muOf(settings);
    out.seed = seed;
    out.corrected = withoutNoise(out.rmse, truth.noise);
    say(fmt::format("{:<40} {:7.2f} spp  rmse {:.6f}  {:6.1f} s", subject_.describe(settings), out.spp, out.rmse,
        1e-3 * frame.wallMilliseconds));
    measured_.emplace(key, out);
    return out;
}

double Lab::compared(double rmse, const render::Settings& settings)
{
    return withoutNoiseOf(rmse, reference(settings).noise);
}

double Lab::withoutNoiseOf(double rmse, double noise) const
{
    return plan_.subtractNoise ? std::max(withoutNoise(rmse, noise), leastOwnError * rmse) : rmse;
}

const std::vector<bool>& Lab::region(const render::Settings& settings)
{
    const std::string integrand = subject_.integrandOf(settings).name;
    const auto found = regions_.find(integrand);
    return found != regions_.end() ? found->second
                                   : regions_.emplace(integrand, subject_.regionOf(reference(settings))).first->second;
}

const Reference& Lab::reference(const render::Settings& settings)
{
    Integrand integrand = subject_.integrandOf(settings);
    if (const auto found = references_.find(integrand.name); found != references_.end()) {
        return found->second;
    }
    integrand.settings.width = plan_.width;
    integrand.settings.height = plan_.height;
    integrand.settings.seed = referenceSeed;
    const std::string label = "reference, " + integrand.name;
    say(fmt::format("{}, {} spp ...", label, integrand.settings.spp));
    const auto start = std::chrono::steady_clock::now();
    Reference made = obtainReference(renderer_, integrand.settings, plan_.referenceFolder, name_, subject_.layer());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    say(fmt::format(
        "{} {} in {:.1f} s, noise {:.6f} RMS", label, made.cached ? "read" : "rendered", seconds, made.noise));
    if (made.otherKernels) {
        say(fmt::format(
            "kernels have changed since {} was rendered; delete it if they compute something else", made.path));
    }
    return references_.emplace(integrand.name, std::move(made)).first->second;
}

std::map<std::string, Reference> summaries(const std::map<std::string, Reference>& references)
{
    std::map<std::string, Reference> out;
    for (const auto& [integrand, reference] : references) {
        Reference summary = reference;
        summary.image = {};
        out.emplace(integrand, std::move(summary));
    }
    return out;
}

} // namespace wedge::benchmark
