#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace wedge::generator {

/// What a seed of the lottery decides before anything is built. The first five are the hard cases.
struct LotteryTraits {
    bool lowLights = false; ///< lights cut by the horizon of what they light, or touching it
    bool sharp = false; ///< highlights of exponents from 200 to 2000
    bool open = false; ///< open ground in place of a closed room
    bool smallEmitters = false; ///< small meshes that emit
    bool oneGroup = false; ///< all meshes are one object
    bool textures = false, antialias = false, lens = false, motion = false;
    int bounces = 0; ///< 0 or 1
    int lights = 1; ///< 1 to 16
    int things = 1; ///< besides the ground or the room
};

/// The same for a seed, always.
LotteryTraits lotteryTraits(std::uint32_t seed);

/// Names of the hard cases that are among them.
std::vector<std::string> hardCases(const LotteryTraits& traits);

} // namespace wedge::generator
