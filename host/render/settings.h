#pragma once

#include "host/image/image.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wedge::render {

enum class Method {
    MonteCarlo, ///< "mc": unbiased, no filter
    AxisAligned, ///< "aaf": axis-aligned filtering, thesis chapters 3 and 4
};

/// What the filters of area lights are made of with method maaf where pixels have one receiver, docs/maaf.md.
enum class Maaf {
    Printed, ///< components with the paper's weights, (10)
    Refitted, ///< components with weights by least squares
    TwoSlope, ///< a Gaussian of distance and place on the light, sheared along both slopes
};

/// What a frame shows.
enum class Integrator {
    Path, ///< direct light and, with bounces, paths
    AmbientOcclusion, ///< how much of each point's hemisphere is open, on white surfaces; no lights
};

/// How antialiased pixels weigh what is around their centres.
enum class PixelFilter {
    Box, ///< the mean over their square
    Gaussian, ///< standard deviation half a pixel, to one and a half pixels
    BlackmanHarris, ///< the window of four terms, to one and a half pixels
};

/// How paths find the area lights. All three converge to the same image.
enum class LightSampling {
    Both, ///< points on lights and reflected directions, combined by the power heuristic
    Lights, ///< points on lights
    Directions, ///< reflected directions that happen to meet a light; point and directional lights as before
};

/// How directions to what is beyond the scene are chosen by its brightness.
enum class EnvironmentSampling {
    Map, ///< each by the map
    Precomputed, ///< among 4096 that a frame begins with: the thesis (section 6.5)
};

/// How points on a light and directions are chosen.
enum class Sampler {
    Sobol, ///< Owen-scrambled Sobol sequence, a scramble of its own for each pixel and term
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

/// What the least distance of a reflector is a fraction of.
enum class ReflectorExtent {
    Scene, ///< the scene's largest dimension
    Visible, ///< the largest dimension of what the camera sees
};

/// Where counts of indirect samples come from.
enum class IndirectCounts {
    Uniform,
    Spectrum, ///< equation (4.21)
    Variance, ///< variance of the neighbours' first paths
};

/// What frames of a sequence have of those before them; docs/temporal.md has the equations.
enum class Temporal {
    Off,
    On, ///< a mean over a window of frames
    Published, ///< of the frame before, whatever lights it: (6.24) to (6.26) of thesis chapter 6
};

/// A filter, by its name, and its parameters' values in their order (filter_chain.h); those that are left out at the
/// end are the filter's own.
struct ChosenFilter {
    std::string name;
    std::vector<float> values;
    std::vector<std::string> on = {}; ///< what it filters, by names that it may; none: what it does where nobody says

    bool operator==(const ChosenFilter&) const = default;
};

/// Indirect light and ambient occlusion; docs/indirect.md has the equations.
struct IndirectSettings {
    float mu = 1.0f; ///< sampling beyond the critical rate, (4.15), (4.21)
    float alpha =
        0.65f; ///< spatial bandlimit relative to the pixel's: no width is below widthScale / (mu alpha) pixels
    float widthScale = 0.5f; ///< standard deviation times bandwidth: beta = widthScale / Omega_r; thesis (4.16): 2
    ReflectorExtent extent = ReflectorExtent::Visible;
    float leastReflector = 0.005f; ///< reflectors nearer than this fraction of the extent count as this far
    float meanFraction =
        0.3f; ///< WEDGE_NEAREST_FRACTION: of the harmonic mean of distances, for the least one; 0: the least itself
    IndirectCounts counts = IndirectCounts::Variance;
    float countExponent = 0.4f; ///< counts ~ (variance / gathered pixels)^this
    int maxSpp = 256; ///< most samples of a pixel
    float widening = 4.0f; ///< pixels: as of lights
    float ambientDistance = 0.0f; ///< metres: farther surfaces do not occlude; 0: any distance does

    bool operator==(const IndirectSettings&) const = default;
};

/// What the widths of environment light's filters follow from where pixels have one receiver.
enum class EnvironmentWidths {
    Penumbrae, ///< distances of what hides directions, and how wide what is there is
    Curvature, ///< (6.13), (6.17) of thesis chapter 6, along x and y
    LightTransport, ///< as Curvature, but by (6.19), of Durand et al., Frequency Analysis of Light Transport
    Corrected, ///< as Curvature, with other constants, of smoothed occluders, and bounded in pixels
};

/// How direct light from beyond the scene is found where the camera looks; docs/shadow-lights.md.
enum class Shadows {
    Sampled, ///< by samples of the map
    Additive, ///< of directional lights that stand for the map, what they bring
    Subtractive, ///< the map's whole light, less what shadows take of those lights
    Ratio, ///< the map's whole light times the share that shadows leave of those lights
};

/// What counts as a map's whole light, of which shadows take some.
enum class WholeLight {
    Map, ///< sums over parts of the map, as small as each surface needs them (kernels/light/light_tree.h)
    Prefiltered, ///< nine harmonics, and of lobes means over the map (kernels/light/unshadowed_environment.h)
    Lights, ///< what the lights bring without shadows
    Cache, ///< looked up by the normal, as if everything were seen from one direction (kernels/light/light_cache.cl)
};

/// Direct light from beyond the scene by lights that stand for its map; docs/shadow-lights.md.
struct ShadowSettings {
    Shadows shadows = Shadows::Sampled;
    int lights = 40;
    WholeLight whole = WholeLight::Map;
    bool clamp = true; ///< of Subtractive: no light is below 0
    int chosen = 0; ///< lights that a pixel traces rays to, those that bring it most; 0: all
    int blockSide = 1; ///< pixels along each side of the blocks of which one traces rays: 1, 2, 4 or 32

    bool operator==(const ShadowSettings&) const = default;
};

/// Direct light from beyond the scene, besides IndirectSettings; docs/environment.md says how they were chosen.
struct EnvironmentSettings {
    EnvironmentSampling sampling = EnvironmentSampling::Map;
    /// Samples are filtered as fractions of what would arrive if nothing were hidden, which is known (kernels/light/
    /// unshadowed_environment.h).
    bool relative = true;
    float normalDegrees = 14.0f; ///< as Settings::normalDegrees
    float widthScale = 0.3f; ///< as that of IndirectSettings, which holds where pixels have several receivers
    float lobeWidening = 1.5f; ///< pixels, as Settings::widening, of what lobes reflect, which has no other width
    float firstShare =
        0.25f; ///< of the samples, that the analysis of pixels with one receiver begins with; 1: as many as of paths
    float leastShare = 0.25f; ///< of the mean count, that every such pixel takes
    EnvironmentWidths widths = EnvironmentWidths::Penumbrae;
    ShadowSettings shadows;

    bool operator==(const EnvironmentSettings&) const = default;
};

/// Where texture and irradiance are taken apart in pixels of several receivers.
enum class Factoring {
    Never, ///< the image alone is filtered
    Error, ///< where the product of their means is near the mean of their products, (5.30)
};

/// Defocus, motion blur and antialiasing; docs/multiple-effects.md has the equations.
struct DistributedSettings {
    int firstPaths = 8; ///< primary samples of the first pass, each with one secondary of each term
    int maxSpp = 512; ///< most samples of a pixel and term
    bool published = false; ///< terms, widths and counts of chapter 5 and appendix B; spp has no say
    float leastShare =
        0.25f; ///< of the mean count, that every pixel takes: counts follow variances, which may be seen late
    float leastTermShare = 0.5f; ///< the same of samples of terms
    float leastPrimaries = 0.5f; ///< primary samples a sample of a term
    float leastSecondaries = 0.2f; ///< samples of a term a primary one where texture and irradiance are taken apart
    int frames =
        1; ///< independent ones of which the image is the mean: filters are as narrow as the samples of all allow
    float mu = 1.0f; ///< as published: bandwidths beyond the critical ones (5.29)
    int mixedPaths = 64; ///< as published: primary samples where motions differ
    Factoring factoring = Factoring::Error;
    float factoringError = 0.01f; ///< radiance
    int factoringRadius = 2; ///< pixels: errors are averaged over a square
    bool blur = true; ///< the image is filtered by what lens and shutter blur
    float blurWidth =
        0.65f; ///< standard deviation of that filter: blurWidth r (n r^2)^-blurExponent pixels, of the circle
    float blurExponent = 0.176f; ///< of confusion's radius r and n primary samples
    float shutterWidth = 0.86f; ///< likewise shutterWidth h (n h)^-shutterExponent, of half the motion's length, h
    float shutterExponent = 0.25f;
    float leastRadius = 0.5f; ///< pixels
    float irradianceWidth = 0.18f; ///< irradiances are filtered at least as far
    float countExponent = 0.3f;
    float varianceSpread = 0.5f;
    float oneVelocity = 0.1f; ///< motions of a pixel differ by less than this fraction where it is filtered along them

    bool operator==(const DistributedSettings&) const = default;
};

/// Everything that decides what a frame looks like. monteCarlo(), axisAligned(), multipleAxisAligned() and
/// asPublished() give the presets.
struct Settings {
    Method method = Method::AxisAligned;
    bool published = false; ///< made by asPublished()
    std::optional<Maaf> maaf; ///< method maaf, which is axis-aligned filtering but for those filters; empty: method aaf
    int components = 5; ///< of Printed and Refitted along each axis of a light: 3, 5, 7; 1 is one filter, for tests
    int width = 640, height = 480;
    image::Window crop; ///< pixels to render; empty: all
    std::uint32_t seed = 0;
    std::optional<std::uint32_t> frame; ///< its number in a sequence, which enters the random numbers
    bool sameNumbers = false; ///< all frames of the sequence have the random numbers of frame 0
    Temporal temporal = Temporal::Off; ///< of sequences: whose filter each frame ends with (filters/temporal)

    Integrator integrator = Integrator::Path;
    int bounces = 0; ///< of indirect light: 0 is direct light alone
    /// Mirrors and glass that paths of the camera follow one after the other before Russian roulette is played, at
    /// least 1.
    int maxSurfaces = 16;
    LightSampling lightSampling = LightSampling::Both;
    bool styles = true; ///< shadows are drawn as lights' styles say, docs/stylized-shadows.md; false: as they are
    /// How far beyond the border shadows are known that styles move, in parts of the image's longer side, 0 to 1; at
    /// most half of the shorter one, to the nearest multiple of 16 pixels. docs/stylized-shadows.md says what for
    float styleMargin = 0.125f;
    IndirectSettings indirect;
    EnvironmentSettings environment;
    bool progressive = false; ///< for Renderer::renderProgressively(); spp: of the last image
    bool antialias = false; ///< pixels are what pixelFilter makes of their surroundings, not their centres
    PixelFilter pixelFilter = PixelFilter::Box;
    DistributedSettings distributed;
    std::vector<ChosenFilter> filters; ///< of samples and of the finished image, in the order of their stages

    Sampler sampler = Sampler::Sobol;
    Shading shading = Shading::Ratio;
    Sampling sampling = Sampling::Adaptive;
    Filtering filtering = Filtering::Adaptive;
    Counts counts = Counts::Variance;
    Slopes slopes = Slopes::Smoothed;

    /// Samples a pixel and term (a light, indirect diffuse, indirect glossy): of each pixel (uniform), or their mean
    /// (counts from variance). Counts from the spectrum follow from mu alone.
    int spp = 28;
    int maxSpp = 256; ///< most samples of a pixel
    float mu = 1.5f; ///< sampling beyond the critical rate: larger is narrower, and more samples (section 3.5.2)
    float k = 3.0f; ///< spread of the Gaussian's energy, (3.13)
    float alpha = 1.0f; ///< bandlimit of the occluders relative to the pixel's, (3.5)

    bool oblique = true; ///< distances along the ray to the light's centre instead of (3.12)
    bool narrower = true; ///< a pair of pixels is weighted by the narrower of both kernels
    bool surface =
        true; ///< pixels weigh by the surface that they see, and those off a pixel's own surface are left out
    bool sheared = true; ///< filters of lights follow the gradients of shadows, where pixels have one receiver
    float shearedWidth = 1.5f; ///< how much wider than others they are then, less what an edge of the light's takes
    float countWidth = 0.2f; ///< and with it widths ~ (mean count / own)^this
    /// And where a light's standard deviation blurs shadows over more pixels than so many, ~ (wideBlur /
    /// blur)^wideBlurExponent.
    float wideBlur = 12.0f, wideBlurExponent = 0.4f;
    bool fitted = true; ///< adaptive filters fit lines to neighbours in the place of means
    bool fallback =
        true; ///< where filters are off by more than noise explains, samples show (kernels/analysis/fallback.cl)
    /// Pixels: lights' filters that are narrower are compared with one of this width, and widened where nothing speaks
    /// for them (kernels/analysis/widening.cl); 0: never.
    float widening = 2.0f;
    float normalDegrees = 10.0f; ///< neighbours whose normals differ by more are not gathered (by components: 20)
    float cut = 3.0f; ///< kernel radius in standard deviations
    int maxRadius = 40; ///< kernel radius in pixels at most
    float fixedWidth = 3.0f; ///< pixels, for Filtering::Fixed

    float fillSigma = 6.0f; ///< pixels: how slopes spread to unoccluded pixels (Slopes::Smoothed)
    int fillRadius = 16; ///< pixels
    float countExponent = 0.5f; ///< counts ~ (variance / gathered pixels)^this
    float varianceFloor = 0.001f; ///< least variance assumed where there are slopes
    float varianceSpread = 0.25f; ///< least fraction of the neighbourhood's largest variance

    bool operator==(const Settings&) const = default;
};

/// Plain Monte Carlo with spp samples a pixel and light.
Settings monteCarlo(int spp);

/// Axis-aligned filtering as measured best. Without spp, the mean count follows from mu; without mu, widths follow
/// from the count, so that either one alone converges.
Settings axisAligned(std::optional<int> spp = {}, std::optional<float> mu = {});

/// The same with several filters of area lights' shadows.
Settings multipleAxisAligned(Maaf maaf, std::optional<int> spp = {}, std::optional<float> mu = {});

/// Axis-aligned filtering as thesis chapters 3 and 4 have it. Without mu, each effect's own: 2 for soft shadows, 0.9
/// for indirect light.
Settings asPublished(std::optional<float> mu = {});

/// The settings of one of the two halves of a progressive render when both together have spp samples a pixel: widths go
/// with the samples of both, as axisAligned() has it, since their mean is as little noisy as one frame with all of
/// them.
Settings halfAt(const Settings& settings, int spp);

/// The seed of a frame's random numbers: of frame 0, of a frame of no sequence, and where all have the same, the
/// settings' own.
std::uint32_t frameSeed(const Settings& settings);

/// The pixels that a frame of these settings produces: the crop, or all.
image::Window outputWindow(const Settings& settings);

/// WEDGE_PIXEL_* of kernels.
std::uint32_t pixelFilterOf(const Settings& settings);

/// Whether frames of these settings look along rays over the hemisphere: for indirect light or ambient occlusion.
bool tracesPaths(const Settings& settings);

/// Whether frames of these settings look where filters are off.
bool usesFallback(const Settings& settings);

/// Most samples a pixel of a distributed frame by method aaf: those of 8x8 pixels have to fit in a wave (waves.h).
constexpr int mostDistributedSpp = 2048;
/// Most samples of one pixel of them: where many of a tile want so many, they take less.
constexpr int mostPixelSpp = 16384;

/// Most lights that a map is taken for, and most that a pixel chooses among them.
constexpr int mostShadowLights = 4096;
constexpr int mostChosenLights = 64;

/// Most bounces that a path may have.
constexpr int mostBounces = 1024;
constexpr int mostSurfaces = 1 << 16; ///< of Settings::maxSurfaces

/// Fewest samples a pixel that method aaf takes: those of the first pass, of progressive frames of both halves'.
/// distributed: whether pixels have several receivers, see isDistributed().
int leastSpp(const Settings& settings, bool distributed);

/// "ratio" and the like.
std::string shadowsName(Shadows shadows);

/// "100:8": lights and how many of them a pixel traces rays to; "100": to all.
std::string shadowLightsText(const ShadowSettings& settings);
/// "1/4": the share of pixels that trace rays; "1": all.
std::string shadowScaleText(const ShadowSettings& settings);

/// Throws UsageError if a value is out of its range. distributed: as above.
void validate(const Settings& settings, bool distributed);

/// "aaf" and the like; of settings "maaf", too.
std::string methodName(Method method);
std::string methodName(const Settings& settings);

/// Name and value of each setting that shapes the image, for metadata and report; of method aaf also those that shape
/// none but distributed frames, whether this is one or not.
std::vector<std::pair<std::string, std::string>> describe(const Settings& settings);

} // namespace wedge::render
