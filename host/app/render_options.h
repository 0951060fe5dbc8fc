#pragma once

#include "host/app/frame_names.h"
#include "host/image/image.h"
#include "host/image/view.h"
#include "host/render/effect.h"
#include "host/render/hierarchy.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace wedge::app {

/// What `wedge render` was called with; empty where an option was not given.
struct RenderOptions {
    std::string scene;
    std::vector<std::string> outputs;
    std::optional<std::string> method; ///< one of methods
    bool asPublished = false;
    std::optional<render::Maaf> maaf;
    std::optional<int> components;
    std::optional<render::Integrator> integrator;
    std::optional<int> bounces;
    std::optional<int> maxSurfaces;
    std::optional<float> ambientDistance; ///< metres
    std::optional<bool> antialias;
    std::optional<render::PixelFilter> pixelFilter;
    std::optional<float> aperture, focus; ///< metres
    std::optional<int> spp, maxSpp;
    std::optional<float> mu;
    std::optional<std::pair<int, int>> size;
    std::optional<image::Window> crop;
    std::optional<std::uint32_t> seed;
    std::string layers;
    std::vector<std::string> devices;
    std::string reference, report;
    std::string explain; ///< file of the drawing
    std::string programs; ///< folder for the programs of a frame that is explained
    double timeLimitSeconds = 0; ///< 0: none
    bool progressive = false;
    std::optional<double> targetError; ///< radiance
    std::uint64_t memoryLimitBytes = 0; ///< 0: the device's
    scene::LoadOptions load;
    std::string kernelDir;
    std::optional<render::Traversal> traversal;
    std::optional<bvh::Mode> bvh;
    bool fastMath = false;
    bool checkLaunches = false;
    bool quiet = false, verbose = false;
    float exposureStops = 0; ///< of PNGs
    std::optional<image::View> view; ///< of PNGs
    std::vector<render::SceneChange> changes; ///< by options of effects
    std::vector<std::string> changeTexts; ///< the same as they were given
    std::optional<FrameRange> frames; ///< of a sequence
    std::optional<double> fps; ///< frames in one unit of the keys' time
    std::vector<render::ChosenFilter> filters; ///< after the scene's
    bool noFilters = false; ///< without the scene's
    bool noStyle = false; ///< lights' shadows as they are
    std::optional<render::Temporal> temporal; ///< likewise

    // Ablations.
    std::optional<render::Sampling> sampling;
    std::optional<render::Filtering> filter;
    std::optional<float> filterWidth; ///< pixels
    std::optional<render::Shading> falloff;
    std::optional<render::Sampler> sampler;
    std::optional<render::Counts> counts;
    std::optional<render::LightSampling> lightSampling;
    std::optional<render::EnvironmentSampling> environmentSampling;
    std::optional<render::EnvironmentWidths> environmentWidths;
    std::optional<render::Shadows> shadows;
    std::optional<int> shadowLights; ///< how many
    std::optional<int> chosenLights; ///< of these, how many a pixel traces rays to
    std::optional<int> shadowBlockSide; ///< pixels along a side of those of which one traces rays
    std::optional<double> shadowSeconds; ///< that a frame may take: how many lights and pixels follow
    std::optional<render::WholeLight> shadowComplete;
    std::optional<bool> shadowClamp;
};

/// Adds the options to the subcommand's parser; parsing fills `options`, which must outlive it.
void addRenderOptions(CLI::App& parser, RenderOptions& options);

} // namespace wedge::app
