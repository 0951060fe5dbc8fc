#pragma once

#include "host/image/image.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wedge::render {

enum class Method {
    MonteCarlo, ///< "mc": unbiased, no filter
    AxisAligned, ///< "aaf": axis-aligned filtering, thesis chapter 3
};

/// How points on a light are chosen.
enum class Sampler {
    Sobol, ///< Owen-scrambled Sobol sequence, a scramble of its own for each pixel and light
    Stratified, ///< jittered strata
};

/// What is accumulated and filtered; docs/soft-shadows.md has the equations.
enum class Shading {
    Separate, ///< mean visibility, shaded with the light's centre: the thesis
    Inside, ///< the shaded radiance, cosine and distance inside the filtered term: Fig. 3.11a, and plain Monte Carlo
    Ratio, ///< visibility weighted by the shading, times the unshadowed shading
};

enum class Sampling {
    Uniform, ///< the same count for each pixel (NAS)
    Adaptive, ///< counts from the analysis (AS)
};

enum class Filtering {
    None, ///< UF
    Fixed, ///< one width in pixels for the whole image (NAF)
    Adaptive, ///< widths from the analysis (AF)
};

/// Where adaptive counts come from.
enum class Counts {
    Spectrum, ///< equation (3.21)
    Variance, ///< variance of the filtered first pass
};

/// How slopes become widths at and around occluded pixels.
enum class Slopes {
    Published, ///< as measured; unoccluded pixels take the mean of those within 5 pixels
    Smoothed, ///< eroded, smoothed, spread with Gaussian weights
};

/// Everything that decides what a frame looks like. monteCarlo(), axisAligned() and asPublished() give the presets.
struct Settings {
    Method method = Method::AxisAligned;
    bool published = false; ///< made by asPublished()
    int width = 640, height = 480;
    image::Window crop; ///< pixels to render; empty: all
    std::uint32_t seed = 0;

    Sampler sampler = Sampler::Sobol;
    Shading shading = Shading::Ratio;
    Sampling sampling = Sampling::Adaptive;
    Filtering filtering = Filtering::Adaptive;
    Counts counts = Counts::Variance;
    Slopes slopes = Slopes::Smoothed;

    /// Samples a pixel and area light: of each pixel (uniform), or their mean (counts from variance). Counts from the
    /// spectrum follow from mu alone.
    int spp = 28;
    int maxSpp = 256; ///< most samples of a pixel
    float mu = 2.0f; ///< sampling beyond the critical rate: larger is narrower, and more samples (section 3.5.2)
    float k = 3.0f; ///< spread of the Gaussian's energy, (3.13)
    float alpha = 1.0f; ///< bandlimit of the occluders relative to the pixel's, (3.5)

    bool oblique = true; ///< distances along the ray to the light's centre instead of (3.12)
    bool narrower = true; ///< a pair of pixels is weighted by the narrower of both kernels
    float normalDegrees = 10.0f; ///< neighbours whose normals differ by more are not gathered
    float cut = 3.0f; ///< kernel radius in standard deviations
    int maxRadius = 40; ///< kernel radius in pixels at most
    float fixedWidth = 3.0f; ///< pixels, for Filtering::Fixed

    float fillSigma = 6.0f; ///< pixels: how slopes spread to unoccluded pixels (Slopes::Smoothed)
    int fillRadius = 16; ///< pixels
    float countExponent = 0.5f; ///< counts ~ (variance / gathered pixels)^this
    float varianceFloor = 0.001f; ///< least variance assumed where there are slopes
    float varianceSpread = 0.25f; ///< least fraction of the neighbourhood's largest variance
};

/// Plain Monte Carlo with spp samples a pixel and light.
Settings monteCarlo(int spp);

/// Axis-aligned filtering as measured best. Without spp, the mean count follows from mu; without mu, widths follow
/// from the count, so that either one alone converges.
Settings axisAligned(std::optional<int> spp = {}, std::optional<float> mu = {});

/// Axis-aligned filtering as thesis chapter 3 has it.
Settings asPublished(float mu = 2.0f);

/// The pixels that a frame of these settings produces: the crop, or all.
image::Window outputWindow(const Settings& settings);

/// Throws UsageError if a value is out of its range.
void validate(const Settings& settings);

/// "aaf" and the like.
std::string methodName(Method method);

/// Name and value of each setting that shapes the image, for metadata and report.
std::vector<std::pair<std::string, std::string>> describe(const Settings& settings);

} // namespace wedge::render
