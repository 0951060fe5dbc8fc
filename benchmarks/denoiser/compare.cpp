#include "benchmarks/denoiser/compare.h"

#include "benchmarks/common/lab.h"
#include "benchmarks/common/references.h"
#include "host/render/layers.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

// Apart from those of what is measured.
constexpr std::uint32_t referenceSeed = 0x2e5eed;

constexpr const char* program = "denoiser";

class DenoiserLab {
public:
    DenoiserLab(const SceneSource& source, const device::Device& device, const DenoiserPlan& plan)
        : plan_(plan)
        , scene_(scene::loadScene(source.file()))
        , renderer_(scene_, device)
        , name_(source.name)
        , reference_(obtainReference(
              renderer_, sized(render::monteCarlo(plan.referenceSpp), referenceSeed), plan.referenceFolder, name_))
    {
    }

    TimedError ours(std::vector<image::RgbImage>& images)
    {
        TimedError out { plan_.spp, {}, timeOf(render::axisAligned(plan_.spp)), 0 };
        for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(plan_.seeds); ++seed) {
            const render::Settings settings = sized(render::axisAligned(plan_.spp), seed);
            const render::FrameStatistics frame = renderer_.render(settings);
            images.push_back(imageOf(renderer_, settings, frame));
        }
        out.error = squaredError(images, reference_);
        say("filtered", out);
        return out;
    }

    TimedError denoised(const OpenImageDenoise& oidn, int spp, std::vector<image::RgbImage>& images)
    {
        TimedError out { spp, {}, timeOf(render::monteCarlo(spp)), 0 };
        std::vector<double> times;
        for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(plan_.seeds); ++seed) {
            const render::Settings settings = sized(render::monteCarlo(spp), seed);
            const render::FrameStatistics frame = renderer_.render(settings, {}, true);
            const image::LayeredImage layers = render::readLayers(renderer_, settings, frame, { "albedo", "normal" });
            const Denoised found = oidn.denoise(guidedImage(layers));
            images.push_back(found.image);
            times.push_back(found.milliseconds);
        }
        out.denoiseMilliseconds = summarize(times).median;
        out.error = squaredError(images, reference_);
        say("denoised", out);
        return out;
    }

    /// RMS error over a region without the reference's noise, radiance. x0, y0: its first pixel
    double regionError(const std::vector<image::RgbImage>& images, int x0, int y0) const
    {
        const int x1 = std::min(plan_.width, x0 + plan_.region), y1 = std::min(plan_.height, y0 + plan_.region);
        const auto cut = [&](const image::RgbImage& image) {
            image::RgbImage out { x1 - x0, y1 - y0, {} };
            for (int y = y0; y < y1; ++y) {
                const auto row = image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + x0);
                out.rgb.insert(out.rgb.end(), row, row + 3 * (x1 - x0));
            }
            return out;
        };
        Reference reference;
        reference.image = cut(reference_.image);
        reference.deviation = cut(reference_.deviation);
        std::vector<image::RgbImage> parts;
        parts.reserve(images.size());
        for (const image::RgbImage& image : images) {
            parts.push_back(cut(image));
        }
        return squaredError(parts, reference).rmse();
    }

    /// Where neither has a hundredth of the image's error nobody sees one: both count as if they had as much.
    WorstRegion worstRegion(const std::vector<image::RgbImage>& ours, const std::vector<image::RgbImage>& others) const
    {
        WorstRegion worst;
        const double least = 0.01 * squaredError(ours, reference_).rmse();
        for (int y = 0; y < plan_.height; y += plan_.region) {
            for (int x = 0; x < plan_.width; x += plan_.region) {
                const double other = regionError(others, x, y), own = regionError(ours, x, y);
                const double ratio = std::max(own, least) / std::max({ other, least, 1e-30 });
                if (ratio > worst.ratio) {
                    worst = { x, y, ratio };
                }
            }
        }
        return worst;
    }

    double noise() const { return reference_.noise; }

private:
    render::Settings sized(render::Settings s, std::uint32_t seed) const
    {
        s.width = plan_.width;
        s.height = plan_.height;
        s.seed = seed;
        s.bounces = scene_.settings.bounces.value_or(0);
        s.antialias = true;
        return s;
    }

    /// Milliseconds of the device for the image alone.
    double timeOf(const render::Settings& wanted)
    {
        const render::Settings settings = sized(wanted, 1);
        renderer_.rehearse(settings);
        std::vector<double> times;
        for (int i = 0; i <= plan_.frames; ++i) {
            const double time = renderer_.render(settings).deviceMilliseconds;
            if (i > 0) { // the first one warms up
                times.push_back(time);
            }
        }
        return summarize(times).median;
    }

    void say(const char* what, const TimedError& e) const
    {
        progress(program,
            fmt::format("{}: {} {:4} spp  rmse {:.6f}  without the worst pixels {:.6f}  {:.0f} + {:.0f} ms", name_,
                what, e.spp, e.error.rmse(), e.error.trimmedRmse(), e.renderMilliseconds, e.denoiseMilliseconds));
    }

    const DenoiserPlan& plan_;
    scene::Scene scene_;
    render::Renderer renderer_;
    std::string name_;
    Reference reference_;
};

/// Samples of what is denoised that take as long as ours, from the two points around; at least one.
int equalTimeSpp(const std::vector<TimedError>& points, double milliseconds)
{
    for (std::size_t i = 1; i < points.size(); ++i) {
        const TimedError &a = points[i - 1], &b = points[i];
        if (b.milliseconds() >= milliseconds || i + 1 == points.size()) {
            const double perSample =
                std::max(1e-9, (b.milliseconds() - a.milliseconds()) / static_cast<double>(b.spp - a.spp));
            // Times have noise: no farther beyond the last point than four times its samples.
            const double spp = a.spp + (milliseconds - a.milliseconds()) / perSample;
            return static_cast<int>(std::lround(std::clamp(spp, 1.0, 4.0 * b.spp)));
        }
    }
    return 1;
}

Json dataOf(const TimedError& e)
{
    return { { "spp", e.spp }, { "rmse", number(e.error.rmse()) }, { "rmse_trimmed", number(e.error.trimmedRmse()) },
        { "render_ms", number(e.renderMilliseconds) }, { "denoise_ms", number(e.denoiseMilliseconds) } };
}

} // namespace

double timeToError(const std::vector<std::pair<double, double>>& timesAndErrors, double error, bool* reached)
{
    *reached = true;
    for (std::size_t i = 0; i < timesAndErrors.size(); ++i) {
        const auto [time, there] = timesAndErrors[i];
        if (there > error) {
            continue;
        }
        if (i == 0) {
            return time;
        }
        const auto [before, above] = timesAndErrors[i - 1];
        const double share = std::log(above / error) / std::log(above / there);
        return before * std::pow(time / before, share);
    }
    *reached = false;
    return timesAndErrors.back().first;
}

DenoiserResult compareWithDenoiser(
    const SceneSource& source, const device::Device& device, const DenoiserPlan& plan, const OpenImageDenoise& oidn)
{
    DenoiserLab lab(source, device, plan);
    DenoiserResult out;
    out.source = source;
    out.referenceNoise = lab.noise();
    std::vector<image::RgbImage> ours;
    out.ours = lab.ours(ours);
    std::vector<std::pair<double, double>> whole, trimmed;
    for (const int spp : plan.denoised) {
        std::vector<image::RgbImage> images;
        out.denoised.push_back(lab.denoised(oidn, spp, images));
        const TimedError& last = out.denoised.back();
        whole.emplace_back(last.milliseconds(), last.error.rmse());
        trimmed.emplace_back(last.milliseconds(), last.error.trimmedRmse());
        if (last.error.mean < out.ours.error.mean && last.error.trimmed < out.ours.error.trimmed
            && last.milliseconds() > out.ours.milliseconds()) {
            break;
        }
    }
    out.savedTime = timeToError(whole, out.ours.error.rmse(), &out.reached) / out.ours.milliseconds();
    out.savedTimeTrimmed =
        timeToError(trimmed, out.ours.error.trimmedRmse(), &out.reachedTrimmed) / out.ours.milliseconds();
    std::vector<image::RgbImage> equal;
    out.equalTime = lab.denoised(oidn, equalTimeSpp(out.denoised, out.ours.milliseconds()), equal);
    out.region = lab.worstRegion(ours, equal);
    return out;
}

std::vector<Claim> claimsOf(const DenoiserResult& result)
{
    ClaimList list(program, result.source.name);
    list.add("saved_time", result.savedTime, "1", {}, 4);
    list.add("saved_time_trimmed", result.savedTimeTrimmed, "1", {}, 4);
    list.add("worst_region", result.region.ratio, "1", {}, 1.3);
    list.add("rmse_ratio_equal_time", result.equalTime.error.rmse() / result.ours.error.rmse(), "1");
    return list.claims;
}

Json dataOf(const DenoiserResult& result)
{
    Json out { { "name", result.source.name }, { "reference_noise", number(result.referenceNoise) },
        { "ours", dataOf(result.ours) }, { "equal_time", dataOf(result.equalTime) } };
    out["denoised"] = Json::array();
    for (const TimedError& e : result.denoised) {
        out["denoised"].push_back(dataOf(e));
    }
    out["reached"] = result.reached;
    out["reached_trimmed"] = result.reachedTrimmed;
    out["worst_region"] = { { "x", result.region.x }, { "y", result.region.y },
        { "ratio", number(result.region.ratio) } };
    return out;
}

std::string tableOf(const DenoiserResult& result)
{
    const auto times = [](double value, bool reached) { return fmt::format("{}{:.2f}", reached ? "" : "> ", value); };
    return fmt::format("{:<16} ours {:.6f} in {:.0f} ms, denoised in equal time {:.6f} ({} spp)\n{:<16} time to equal "
                       "error {} of ours, without the worst pixels {}; worst region {:.2f} at {},{}\n",
        result.source.name, result.ours.error.rmse(), result.ours.milliseconds(), result.equalTime.error.rmse(),
        result.equalTime.spp, "", times(result.savedTime, result.reached),
        times(result.savedTimeTrimmed, result.reachedTrimmed), result.region.ratio, result.region.x, result.region.y);
}

} // namespace wedge::benchmark
