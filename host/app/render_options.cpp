#include "host/app/render_options.h"

#include "host/app/shadow_settings.h"
#include "host/app/values.h"
#include "host/render/filter_call.h"
#include "host/render/layers.h"
#include "host/scene/scene.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::app {
namespace {

using Setter = std::function<void(const std::string&)>;

constexpr const char* whatGroup = "What is rendered";
constexpr const char* howGroup = "How";
constexpr const char* ablationGroup = "Parts of the method, one by one";
constexpr const char* talkGroup = "What is said";

/// An option of one value; of several uses the last one counts, so that a script can append to a command.
void addValue(CLI::App& parser, const std::string& group, const std::string& name, const std::string& type,
    const std::string& help, const Setter& set)
{
    parser.add_option_function<std::string>(name, set, help)
        ->type_name(type)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
        ->group(group);
}

std::string alternatives(const std::vector<std::string>& texts)
{
    std::string out;
    for (const std::string& each : texts) {
        out += (out.empty() ? "" : "|") + each;
    }
    return out;
}

/// An option that chooses among the values of an enumeration, named in their order.
template <class Enum>
void addChoice(CLI::App& parser, const std::string& group, const std::string& name,
    const std::vector<std::string>& names, const std::string& help, std::optional<Enum>& target)
{
    addValue(parser, group, name, alternatives(names), help,
        [name, names, &target](const std::string& text) { target = static_cast<Enum>(choice(name, text, names)); });
}

/// An option that may be used several times, one value each.
void addList(CLI::App& parser, const std::string& group, const std::string& name, const std::string& type,
    const std::string& help, std::vector<std::string>& target)
{
    parser.add_option(name, target, help)->type_name(type)->allow_extra_args(false)->group(group);
}

void addFrameOptions(CLI::App& parser, RenderOptions& o)
{
    addList(parser, whatGroup, "-o,--output", "FILE",
        "Image to write, .exr (linear, with layers) or .png (sRGB); may be given several times. Default: the scene's "
        "name with .exr and with .png, in the current folder",
        o.outputs);
    addValue(parser, whatGroup, "--size", "WxH", "Image size in pixels",
        [&o](const std::string& text) { o.size = imageSize("--size", text); });
    addValue(parser, whatGroup, "--crop", "x0,y0,x1,y1", "Render these pixels only, x1 and y1 excluded",
        [&o](const std::string& text) { o.crop = cropWindow("--crop", text); });
    addValue(parser, whatGroup, "--frames", "A:B",
        "Render frames A to B of a sequence, with -o name.%04d.exr; those that are there, whole and of the same "
        "settings, "
        "are left",
        [&o](const std::string& text) { o.frames = frameRange("--frames", text); });
    addValue(parser, whatGroup, "--fps", "N",
        "With --frames: frame n is n / N later, in the time of the scene's keys. Default: the scene's, 24",
        [&o](const std::string& text) { o.fps = finiteNumber("--fps", text, scene::leastFps, scene::mostFps); });
    addChoice(parser, whatGroup, "--temporal", temporals,
        "With --frames: filter each frame with those before it, up to seven, against flicker; published: with one, "
        "whatever "
        "lights it. Default: off",
        o.temporal);
    addValue(parser, whatGroup, "--layers", "LIST",
        "Layers to add to the EXR: all, or names separated by commas, listed below",
        [&o](const std::string& text) { o.layers = text; });
    addValue(parser, whatGroup, "--exposure", "STOPS", "Multiply PNGs by 2^STOPS", [&o](const std::string& text) {
        o.exposureStops = static_cast<float>(finiteNumber("--exposure", text, -64, 64));
    });
    addChoice(parser, whatGroup, "--view", { "srgb", "filmic", "agx" },
        "How PNGs show radiance: clipped, the default; by a film's curve; by AgX, in which bright colours fade to "
        "white",
        o.view);
    parser
        .add_option_function<std::vector<std::string>>(
            "--add-filter",
            [&o](const std::vector<std::string>& texts) {
                o.filters.clear();
                std::ranges::transform(texts, std::back_inserter(o.filters),
                    [](const std::string& text) { return render::filterCall("--add-filter", text); });
            },
            "Filter samples, the image or parts of it, listed below: path-density, bilateral:sigma=2,tolerance=0.5; "
            "several "
            "are done in the order given, after the scene's")
        ->type_name("FILTER")
        ->allow_extra_args(false)
        ->group(whatGroup);
    parser.add_flag("--no-filters", o.noFilters, "Leave out the scene's filters")->group(whatGroup);
    parser.add_flag("--no-style", o.noStyle, "Leave out the styles of lights' shadows")->group(whatGroup);
    addValue(parser, whatGroup, "--reference", "FILE", "Compare with this image (.exr, .png or .hdr) of the same size",
        [&o](const std::string& text) { o.reference = text; });
    addValue(parser, whatGroup, "--report", "FILE", "Write a report as JSON",
        [&o](const std::string& text) { o.report = fileName("--report", text); });
}

void addIntegratorOptions(CLI::App& parser, RenderOptions& o)
{
    addChoice(parser, whatGroup, "--integrator", integrators,
        "path: light, the default; ao: ambient occlusion, how open each point's surroundings are", o.integrator);
    addValue(parser, whatGroup, "--bounces", "N", "Bounces of indirect light, 0 for direct light alone, the default",
        [&o](const std::string& text) {
            o.bounces = static_cast<int>(wholeNumber("--bounces", text, 0, scene::maxBounces));
        });
    addValue(parser, whatGroup, "--max-surfaces", "N",
        "Mirrors and surfaces of glass that paths of the camera follow in a row before some end at each, weighing the "
        "others: more is less noise in glass. Default: 16",
        [&o](const std::string& text) {
            o.maxSurfaces = static_cast<int>(wholeNumber("--max-surfaces", text, 1, scene::mostSurfaces));
        });
    addValue(parser, whatGroup, "--ao-distance", "M",
        "Farther surfaces, in metres, do not occlude, for --integrator ao. Default: all do",
        [&o](const std::string& text) {
            o.ambientDistance = static_cast<float>(
                finiteNumber("--ao-distance", text, scene::leastAmbientDistance, scene::mostAmbientDistance));
        });
}

void addCameraOptions(CLI::App& parser, RenderOptions& o)
{
    parser
        .add_flag_function(
            "--antialias,!--no-antialias", [&o](std::int64_t given) { o.antialias = given > 0; },
            "Sample all of a pixel's square in place of its centre, or not")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
        ->group(whatGroup);
    addChoice(parser, whatGroup, "--pixel-filter", pixelFilters,
        "What antialiased pixels are: the mean over their square, the default, or weighted over the square of three "
        "around it",
        o.pixelFilter);
    addValue(parser, whatGroup, "--aperture", "M",
        "Radius of the lens in metres, 0 for a pinhole. Default: the scene's", [&o](const std::string& text) {
            o.aperture = static_cast<float>(finiteNumber("--aperture", text, 0, scene::mostAperture));
        });
    addValue(parser, whatGroup, "--focus", "M", "Metres to the plane in focus of the lens. Default: the scene's",
        [&o](const std::string& text) {
            o.focus = static_cast<float>(finiteNumber("--focus", text, scene::leastFocus, scene::mostFocus));
        });
}

std::string svgPath(const std::string& text)
{
    if (!text.ends_with(".svg")) {
        throw UsageError("--explain draws SVG", text, "name a file that ends in .svg");
    }
    return text;
}

void addMethodOptions(CLI::App& parser, RenderOptions& o)
{
    addValue(parser, howGroup, "--method", alternatives(methods),
        "mc: plain Monte Carlo; aaf: axis-aligned filtering, the default; maaf: the same, but for shadows of Gaussian "
        "area lights in frames through a pinhole that are not antialiased, which several filters at once smooth",
        [&o](const std::string& text) { o.method = methods[choice("--method", text, methods)]; });
    addChoice(parser, howGroup, "--maaf", maafs,
        "With --method maaf, its filters: two-slope, a Gaussian sheared along both slopes, the default; printed or "
        "refitted, components with the paper's weights or with such by least squares, slow",
        o.maaf);
    addValue(parser, howGroup, "--components", alternatives(componentCounts),
        "With --maaf printed or refitted: filters along each axis of a light. Default: 5",
        [&o](const std::string& text) {
            o.components = std::stoi(componentCounts[choice("--components", text, componentCounts)]);
        });
    parser.add_flag("--as-published", o.asPublished, "aaf as it was published, without later improvements")
        ->group(howGroup);
    addValue(parser, howGroup, "--spp", "N",
        "Samples a pixel and term (each area light, indirect diffuse, indirect glossy), their mean with adaptive "
        "sampling",
        [&o](const std::string& text) { o.spp = static_cast<int>(wholeNumber("--spp", text, 1, scene::maxSamples)); });
    addValue(parser, howGroup, "--max-spp", "N", "Most samples of a pixel and term", [&o](const std::string& text) {
        o.maxSpp = static_cast<int>(wholeNumber("--max-spp", text, 1, scene::maxSamples));
    });
    addValue(parser, howGroup, "--mu", "X", "Sampling beyond the critical rate: larger filters less and samples more",
        [&o](const std::string& text) {
            o.mu = static_cast<float>(finiteNumber("--mu", text, scene::leastMu, scene::mostMu));
        });
    addValue(parser, howGroup, "--seed", "N", "Seed of the random numbers", [&o](const std::string& text) {
        o.seed = static_cast<std::uint32_t>(wholeNumber("--seed", text, 0, std::numeric_limits<std::uint32_t>::max()));
    });
}

void addDeviceOptions(CLI::App& parser, RenderOptions& o)
{
    addList(parser, howGroup, "--device", "SELECTOR", "cpu, gpu, an index from `wedge devices`, or part of a name",
        o.devices);
    addChoice(parser, howGroup, "--traversal", { "auto", "wide", "scalar" },
        "How rays are traced: wide for CPUs, scalar for GPUs, auto by the device; the image is the same", o.traversal);
    addChoice(parser, howGroup, "--bvh", bvhModes,
        "How the hierarchy is built: sooner, or for faster rays; the image is the same", o.bvh);
    addValue(parser, howGroup, "--time-limit", "S", "Stop sampling after so many seconds and write what is there",
        [&o](const std::string& text) { o.timeLimitSeconds = positiveNumber("--time-limit", text, 1e9); });
    addValue(parser, howGroup, "--memory-limit", "MIB", "Use no more than so much of the device's memory",
        [&o](const std::string& text) {
            o.memoryLimitBytes = static_cast<std::uint64_t>(wholeNumber("--memory-limit", text, 1, 1 << 30)) << 20;
        });
    addValue(parser, howGroup, "--max-texture-pixels", "N",
        "Refuse textures of more pixels. Default: 67108864; all together may have 16 times as many",
        [&o](const std::string& text) { o.load.maxTexturePixels = texturePixels("--max-texture-pixels", text); });
    addValue(parser, howGroup, "--kernel-dir", "DIR", "Kernels to use in place of the built-in ones",
        [&o](const std::string& text) { o.kernelDir = text; });
    parser
        .add_flag("--check-launches", o.checkLaunches,
            "Wait for each launch, and give each plane its own memory, so that errors name their kernel")
        ->group(howGroup);
    parser.add_flag("--fast-math", o.fastMath, "Let the device's compiler relax floating-point rules")->group(howGroup);
}

void addProgressiveOptions(CLI::App& parser, RenderOptions& o)
{
    parser
        .add_flag("--progressive", o.progressive,
            "Render in steps of ever more samples, all of which count in the next, and write the image after each, up "
            "to "
            "--spp, --time-limit or --target-error")
        ->group(howGroup);
    addValue(parser, howGroup, "--target-error", "E",
        "With --progressive: stop when the RMS error that the samples tell is at most E, a radiance",
        [&o](const std::string& text) { o.targetError = positiveNumber("--target-error", text, 1e9); });
}

void addAblationOptions(CLI::App& parser, RenderOptions& o)
{
    addChoice(
        parser, ablationGroup, "--sampling", { "uniform", "adaptive" }, "Samples of each pixel and term", o.sampling);
    addChoice(
        parser, ablationGroup, "--filter", { "none", "fixed", "adaptive" }, "Width of each term's filter", o.filter);
    addValue(parser, ablationGroup, "--filter-width", "PX", "Width for --filter fixed, standard deviation in pixels",
        [&o](const std::string& text) {
            o.filterWidth = static_cast<float>(positiveNumber("--filter-width", text, 1000));
        });
    addChoice(parser, ablationGroup, "--falloff", { "separate", "inside", "ratio" },
        "Where a light's cosine and distance go: outside the filtered term, inside, or as a ratio", o.falloff);
    addChoice(parser, ablationGroup, "--sampler", { "sobol", "stratified" },
        "How points on lights and directions are chosen", o.sampler);
    addChoice(
        parser, ablationGroup, "--counts", { "spectrum", "variance" }, "What adaptive counts come from", o.counts);
    addChoice(parser, ablationGroup, "--light-sampling", lightSamplings,
        "How paths find area lights: points on them, reflected directions that meet one, or both. The same image in "
        "the limit",
        o.lightSampling);
    addChoice(parser, ablationGroup, "--environment-sampling", { "map", "precomputed" },
        "How directions to what is beyond the scene are chosen: each by its map, or among 4096 that a frame begins "
        "with",
        o.environmentSampling);
    addChoice(parser, ablationGroup, "--environment-widths", environmentWidths,
        "What widths of filters of light from beyond the scene follow from: what hides it and how wide that light is, "
        "the "
        "default; curvature, what hides it and the map's spectrum, as published; the same without the map's spectrum, "
        "as "
        "Durand et al.'s frequency analysis of light transport has it; or by corrected constants",
        o.environmentWidths);
}

void addShadowOptions(CLI::App& parser, RenderOptions& o)
{
    addChoice(parser, howGroup, "--shadows", shadows,
        "Direct light of an environment's map where the camera looks: sampled, the default; or by directional lights "
        "that stand for it: what they bring, all of the map's light less what their shadows take, or times the share "
        "that these leave",
        o.shadows);
    addValue(parser, howGroup, "--shadow-lights", "N[:K]",
        "With --shadows: how many lights, and to how many of them, those that bring it most, a pixel traces rays. "
        "Default: 40, all of them",
        [&o](const std::string& text) {
            const std::size_t colon = text.find(':');
            o.shadowLights =
                static_cast<int>(wholeNumber("--shadow-lights", text.substr(0, colon), 1, render::mostShadowLights));
            o.chosenLights.reset();
            if (colon != std::string::npos) {
                const int most = std::min(*o.shadowLights, render::mostChosenLights);
                o.chosenLights = static_cast<int>(wholeNumber("--shadow-lights N:K", text.substr(colon + 1), 1, most));
            }
        });
    addValue(parser, howGroup, "--shadow-scale", "SHARE",
        "With --shadows subtractive or ratio: the share of pixels that trace rays, 1, 1/4, 1/16 or 1/1024. Default: 1",
        [&o](const std::string& text) {
            o.shadowBlockSide = shadowBlockSides[choice("--shadow-scale", text, { "1", "1/4", "1/16", "1/1024" })];
        });
    addValue(parser, howGroup, "--shadow-time", "SECONDS",
        "With --shadows, in place of --shadow-lights and --shadow-scale: about how long a frame may take. Small frames "
        "are rendered before it, and what is chosen by them is told",
        [&o](const std::string& text) { o.shadowSeconds = positiveNumber("--shadow-time", text, 1e6); });
    addChoice(parser, howGroup, "--shadow-complete", wholeLights,
        "With --shadows subtractive or ratio, all of the map's light: by sums over parts of it, the default; by "
        "harmonics and means of it; what the lights bring without shadows; or by a table of normals, as if all were "
        "seen "
        "from one direction",
        o.shadowComplete);
    addValue(parser, howGroup, "--shadow-clamp", "on|off",
        "With --shadows subtractive: whether light that is below 0 becomes 0. Default: on",
        [&o](const std::string& text) {
            o.shadowClamp = choice("--shadow-clamp", text, { "on", "off" }) == 0;
        });
}

void addEffectOptions(CLI::App& parser, RenderOptions& o)
{
    for (const auto& effect : render::effects()) {
        for (const render::EffectOption& option : effect->options()) {
            addValue(parser, whatGroup, option.name, option.type, option.help,
                [&o, name = option.name, parse = option.parse](const std::string& text) {
                    o.changes.push_back(parse(text));
                    o.changeTexts.push_back(fmt::format("{} {}", name, text));
                });
        }
    }
}

std::string footer()
{
    std::string text = "Layers of an EXR besides the beauty (R G B):\n";
    for (const render::LayerInfo& layer : render::knownLayers()) {
        text += fmt::format(
            "  {:<17} {}\n", layer.name, fmt::format("{}: {}", fmt::join(layer.channels, " "), layer.meaning));
    }
    return text + render::filterList()
        + "\nExit status: 0 done, 1 failure, 2 wrong call, 130 interrupted by a signal (what was there is "
          "written).\n";
}

} // namespace

void addRenderOptions(CLI::App& parser, RenderOptions& options)
{
    parser.add_option("SCENE", options.scene, "Scene file (.toml) or mesh (.obj)")->type_name("")->required();
    addFrameOptions(parser, options);
    addIntegratorOptions(parser, options);
    addCameraOptions(parser, options);
    addEffectOptions(parser, options);
    addMethodOptions(parser, options);
    addShadowOptions(parser, options);
    addProgressiveOptions(parser, options);
    addDeviceOptions(parser, options);
    addAblationOptions(parser, options);
    addValue(parser, talkGroup, "--explain", "FILE",
        "Render nothing: print the frame's passes, what they use and its memory, and draw them into FILE (.svg)",
        [&options](const std::string& text) { options.explain = svgPath(text); });
    addValue(parser, talkGroup, "--programs", "DIR",
        "With --explain: write the programs of the frame's kernels into the folder DIR, as the device's compiler gets "
        "them",
        [&options](const std::string& text) { options.programs = text; });
    parser.add_flag("--quiet", options.quiet, "Say nothing but errors")->group(talkGroup);
    parser.add_flag("--verbose", options.verbose, "Say more: memory by buffer, the settings")->group(talkGroup);
    parser.footer(footer());
}

} // namespace wedge::app
