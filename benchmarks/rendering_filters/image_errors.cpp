#include "benchmarks/rendering_filters/image_errors.h"

#include "benchmarks/common/image_bias.h"
#include "benchmarks/common/lab.h"
#include "host/image/metrics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

// Apart from those of what is measured.
constexpr std::uint32_t referenceSeed = 0x2e5eed;
constexpr double middleGrey = 0.18;
constexpr double bluestShare = 0.1;
constexpr double darkest = 0.1; ///< of the median luminance: colours of what is darker are not judged

double luminance(const image::RgbImage& image, std::size_t pixel)
{
    const float* rgb = image.rgb.data() + 3 * pixel;
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

double medianLuminance(const image::RgbImage& image)
{
    std::vector<double> values(image.rgb.size() / 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = luminance(image, i);
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// The tenth of the pixels that are not dark whose share of blue is largest.
std::vector<std::size_t> bluestPixels(const image::RgbImage& image, double median)
{
    std::vector<std::pair<double, std::size_t>> byBlue;
    for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
        const float* rgb = image.rgb.data() + 3 * i;
        const double sum = static_cast<double>(rgb[0]) + rgb[1] + rgb[2];
        if (sum > 0 && luminance(image, i) >= darkest * median) {
            byBlue.emplace_back(rgb[2] / sum, i);
        }
    }
    std::ranges::sort(byBlue, std::greater {});
    byBlue.resize(static_cast<std::size_t>(std::ceil(bluestShare * static_cast<double>(byBlue.size()))));
    std::vector<std::size_t> out(byBlue.size());
    std::ranges::transform(byBlue, out.begin(), [](const auto& each) { return each.second; });
    return out;
}

} // namespace

Truth::Truth(Reference reference)
    : reference_(std::move(reference))
{
    const double median = medianLuminance(reference_.image);
    exposure_ = median > 0 ? middleGrey / median : 1.0;
    shown_ = shown(reference_.image);
    bluest_ = bluestPixels(reference_.image, median);
}

image::RgbImage Truth::shown(const image::RgbImage& image) const
{
    image::RgbImage out = image;
    for (float& value : out.rgb) {
        value = std::clamp(static_cast<float>(exposure_ * value), 0.0f, 1.0f);
    }
    return out;
}

double Truth::blueOverRed(const image::RgbImage& image) const
{
    double red = 0, blue = 0;
    for (const std::size_t pixel : bluest_) {
        red += image.rgb[3 * pixel];
        blue += image.rgb[3 * pixel + 2];
    }
    return blue / red;
}

ImageErrors Truth::errorsOf(const image::RgbImage& image) const
{
    const image::RgbImage seen = shown(image);
    ImageErrors out;
    out.rmse = image::rmse(image, reference_.image);
    out.corrected = withoutNoise(out.rmse, reference_.noise);
    out.display = image::rmse(seen, shown_);
    out.flip = image::flip(seen, shown_).mean;
    out.energy = meanOf(image) / meanOf(reference_.image) - 1.0;
    out.colour = blueOverRed(image) / blueOverRed(reference_.image);
    return out;
}

Truth obtainTruth(render::Renderer& renderer, render::Settings settings, const std::string& folder,
    const std::string& scene, const std::string& layer)
{
    const std::string what = layer.empty() ? "beauty" : layer;
    settings.seed = referenceSeed;
    Reference made = obtainReference(renderer, settings, folder, scene + "_" + what, layer);
    progress("rendering_filters",
        fmt::format("{}: reference of {} {}, noise {:.6f}{}", scene, what, made.cached ? "read" : "rendered",
            made.noise, made.otherKernels ? "; kernels have changed since" : ""));
    return Truth(std::move(made));
}

Json dataOf(const ImageErrors& errors)
{
    return { { "rmse", number(errors.rmse) }, { "rmse_corrected", number(errors.corrected) },
        { "display", number(errors.display) }, { "flip", number(errors.flip) }, { "energy", number(errors.energy) },
        { "colour", number(errors.colour) } };
}

ImageErrors averaged(const std::vector<ImageErrors>& errors)
{
    const auto n = static_cast<double>(errors.size());
    const auto geometric = [&](double ImageErrors::*value) {
        double sum = 0;
        for (const ImageErrors& each : errors) {
            sum += std::log(each.*value);
        }
        return std::exp(sum / n);
    };
    ImageErrors out { geometric(&ImageErrors::rmse), geometric(&ImageErrors::corrected),
        geometric(&ImageErrors::display), geometric(&ImageErrors::flip), 0, geometric(&ImageErrors::colour) };
    for (const ImageErrors& each : errors) {
        out.energy += each.energy / n;
    }
    return out;
}

} // namespace wedge::benchmark
