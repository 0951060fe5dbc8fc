#pragma once

#include "benchmarks/common/measure_plan.h"
#include "benchmarks/common/squared_error.h"
#include "data/generator/lottery/traits.h"
#include "host/device/device.h"
#include "host/scene/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// What is rendered of each scene.
struct LotteryPlan {
    int width = 128, height = 96;
    std::vector<int> budgets { 16, 28, 64, 256, 512 }; ///< samples a pixel, ascending
    int compared = 28; ///< the one of them that methods are compared at
    int pooledUpTo = 64, seeds = 4; ///< images of so many samples or fewer are rendered with so many seeds
    int referenceSpp = 4096;
    std::vector<double> imageBlurs { 0.4, 0.6, 0.85, 1.2, 1.7, 2.4 }; ///< pixels: Gaussians over a plain image
    std::vector<float> termBlurs { 0.75f, 1.5f, 3.0f }; ///< pixels: of each term, with the tests of normals and objects
    std::string referenceFolder, imageFolder; ///< imageFolder: "" for no pictures
    int version = 1; ///< of the generator: 1 to 3
};

/// One method at one budget.
struct LotteryPoint {
    int spp = 0;
    SquaredError error;
    double deviceMilliseconds = 0, wallMilliseconds = 0; ///< medians over the seeds
};

/// All that is measured of a seed.
struct LotteryResult {
    std::uint32_t seed = 0;
    generator::LotteryTraits traits;
    std::size_t triangles = 0;
    double seconds = 0; ///< that the measurement took
    double referenceNoise = 0; ///< RMS
    std::vector<LotteryPoint> plain, filtered; ///< a budget each
    SquaredError fixedBlur; ///< of the best fixed blur at LotteryPlan::compared
    std::string fixedBlurName;
};

/// The scene of a seed and a version, whose files go to the folder. Throws Error.
scene::Scene lotteryScene(std::uint32_t seed, int version, const std::string& folder);

/// Where scene files are kept unless another folder is named.
std::string lotterySceneFolder();

/// Renders and measures. Throws Error.
LotteryResult measureSeed(std::uint32_t seed, const device::Device& device, const LotteryPlan& plan);

} // namespace wedge::benchmark
