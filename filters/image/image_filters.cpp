// Filters of images (kernels/filter/image.cl, docs/image-filters.md).
#include "host/render/filter_chain.h"
#include "kernels/shared/image_filter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace wedge::filters {

using device::PassKind;
using graph::reads;
using graph::value;
using graph::writes;
using render::Arguments;
using render::FilterParameter;
using render::FrameBuilder;
using Image = graph::Handle<render::Radiance>;
using Values = std::vector<float>;

namespace {

constexpr const char* pass = "filters of the image";
constexpr const char* file = "filter/image.cl";
/// Of Gaussians along rows and columns, and of those that look at a square of pixels.
constexpr double mostSigma = 32.0, mostBilateralSigma = 4.0;
constexpr double mostBoxRadius = 8.0;
/// How much wider the second and the third of a bloom's Gaussians are than the first.
constexpr float middleOfBloom = 2.0f, farOfBloom = 4.0f;

int reachOf(float sigma) { return static_cast<int>(std::ceil(WEDGE_IMAGE_CUT * sigma)); }

/// A pass over pixels that makes an image of others.
Image made(FrameBuilder& f, const char* kernel, const Arguments& arguments)
{
    auto out = f.graph.plane<render::Radiance>("filtered image", graph::vectors);
    f.pixels(pass, PassKind::Filter, { file, kernel },
        render::joined({ f.rectangle(f.analysisParams()) }, arguments, Arguments { writes("out", out) }));
    return out;
}

Image blurred(FrameBuilder& f, float sigma, const Image& image)
{
    const int reach = reachOf(sigma);
    const Image rows =
        made(f, "imageRows", { value("sigma", sigma), reads("image", image, graph::Reach { .x = reach }) });
    return made(f, "imageColumns", { value("sigma", sigma), reads("image", rows, graph::Reach { .y = reach }) });
}

FilterParameter sigmaParameter(double most, float standard)
{
    return { "sigma", 0.0, most, standard, "standard deviation, pixels" };
}
FilterParameter radiusParameter(double most = WEDGE_IMAGE_MEDIAN_RADIUS)
{
    return { "radius", 0.0, most, 1.0f, "of the square, pixels", true };
}

class Gaussian : public render::ImageFilter {
public:
    std::string name() const override { return "gaussian"; }
    std::string meaning() const override { return "blurs"; }
    std::vector<FilterParameter> parameters() const override { return { sigmaParameter(mostSigma, 1.0f) }; }
    Image declare(FrameBuilder& f, const Values& values, const Image& image) const override
    {
        return values[0] > 0.0f ? blurred(f, values[0], image) : image;
    }
};

class Bilateral : public render::ImageFilter {
public:
    std::string name() const override { return "bilateral"; }
    std::string meaning() const override { return "blurs what is about as bright, and keeps edges"; }
    std::vector<FilterParameter> parameters() const override
    {
        return { sigmaParameter(mostBilateralSigma, 2.0f),
            { "tolerance", 0.01, 64.0, 0.5f, "standard deviation of brightness, stops" } };
    }
    Image declare(FrameBuilder& f, const Values& values, const Image& image) const override
    {
        const float sigma = values[0];
        return sigma > 0.0f ? made(f, "imageBilateral",
                   { value("sigma", sigma), value("tolerance", values[1]),
                       reads("image", image, graph::around(reachOf(sigma))) })
                            : image;
    }
};

Image medianOf(FrameBuilder& f, float radius, float factor, const Image& image)
{
    const auto pixels = static_cast<std::uint32_t>(radius);
    return pixels > 0 ? made(f, "imageMedian",
               { value("radius", pixels), value("factor", factor),
                   reads("image", image, graph::around(static_cast<int>(pixels))) })
                      : image;
}

class Median : public render::ImageFilter {
public:
    std::string name() const override { return "median"; }
    std::string meaning() const override { return "the median of each channel around each pixel"; }
    std::vector<FilterParameter> parameters() const override { return { radiusParameter() }; }
    Image declare(FrameBuilder& f, const Values& values, const Image& image) const override
    {
        return medianOf(f, values[0], -1.0f, image);
    }
};

class MadMedian : public render::ImageFilter {
public:
    std::string name() const override { return "mad-median"; }
    std::string meaning() const override { return "the median in the place of what lies far from it"; }
    std::vector<FilterParameter> parameters() const override
    {
        return { radiusParameter(),
            { "factor", 0.0, 1000.0, 4.45f, "median deviations that a value may lie off; 1 as published" } };
    }
    Image declare(FrameBuilder& f, const Values& values, const Image& image) const override
    {
        return medianOf(f, values[0], values[1], image);
    }
};

class Sharpen : public render::ImageFilter {
public:
    std::string name() const override { return "sharpen"; }
    std::string meaning() const override { return "adds what a Gaussian takes away"; }
    std::vector<FilterParameter> parameters() const override
    {
        return { sigmaParameter(mostSigma, 1.0f), { "amount", 0.0, 10.0, 0.5f, "of what is added" } };
    }
    Image declare(FrameBuilder& f, const Values& values, const Image& image) const override
    {
        if (values[0] <= 0.0f || values[1] <= 0.0f) {
            return image;
        }
        const Image soft = blurred(f, values[0], image);
        return made(f, "sharpenImage", { value("amount", values[1]), reads("image", image), reads("blurred", soft) });
    }
};

class Bloom : public render::ImageFilter {
public:
    std::string name() const override { return "bloom"; }
    std::string meaning() const override { return "adds light around what is bright"; }
    std::vector<FilterParameter> parameters() const override
    {
        return { { "threshold", 0.0, 1e6, 1.0f, "luminance above which light is spread, radiance" },
            { "strength", 0.0, 10.0, 0.1f, "of what is added" }, sigmaParameter(mostSigma, 4.0f) };
    }
    Image declare(FrameBuilder& f, const Values& values, const Image& image) const override
    {
        const float threshold = values[0], strength = values[1], sigma = values[2];
        if (strength <= 0.0f || sigma <= 0.0f) {
            return image;
        }
        const Image bright = made(f, "brightParts", { value("threshold", threshold), reads("image", image) });
        // One after the other: variances add up.
        const Image near = blurred(f, sigma, bright);
        const auto wider = [&](const Image& from, float before, float times) {
            return blurred(f, sigma * std::sqrt(times * times - before * before), from);
        };
        const Image middle = wider(near, 1.0f, middleOfBloom), far = wider(middle, middleOfBloom, farOfBloom);
        return made(f, "addBloom",
            { value("strength", strength), reads("image", image), reads("near", near), reads("middle", middle),
                reads("far", far) });
    }
};

class Colour : public render::ImageFilter {
public:
    std::string name() const override { return "colour"; }
    std::string meaning() const override { return "multiplies by a colour"; }
    std::vector<FilterParameter> parameters() const override
    {
        const auto gain = [](const char* name) {
            return FilterParameter { name, 0.0, 1000.0, 1.0f, "what it is multiplied by at full density" };
        };
        return { gain("red"), gain("green"), gain("blue"), { "density", 0.0, 1.0, 1.0f, "0: nothing; 1: all of it" } };
    }
    Image declare(FrameBuilder& f, const Values& values, const Image& image) const override
    {
        const bool neutral = values[3] <= 0.0f
            || std::all_of(values.begin(), values.begin() + 3, [](float gain) { return gain == 1.0f; });
        return neutral ? image
                       : made(f, "colourImage",
                           { value("red", values[0]), value("green", values[1]), value("blue", values[2]),
                               value("density", values[3]), reads("image", image) });
    }
};

// In the order in which help lists them.
class Box : public render::ImageFilter {
public:
    std::string name() const override { return "box"; }
    std::string meaning() const override { return "the mean over a square"; }
    std::vector<FilterParameter> parameters() const override { return { radiusParameter(mostBoxRadius) }; }
    Image declare(FrameBuilder& f, const Values& values, const Image& image) const override
    {
        const auto radius = static_cast<std::uint32_t>(values[0]);
        return radius > 0 ? made(f, "imageBox",
                   { value("radius", radius), reads("image", image, graph::around(static_cast<int>(radius))) })
                          : image;
    }
};

const bool registered = render::registerFilters<Gaussian, Bilateral, Median, MadMedian, Sharpen, Bloom, Colour, Box>();

} // namespace
} // namespace wedge::filters
