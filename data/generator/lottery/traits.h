#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace wedge::generator {

/// Meshes that light a scene of version 2, beside its area lights or in their place.
enum class Lamps { None, Large, Small, Textured };

/// What lights a scene of version 3 from all around.
enum class Sky {
    None,
    Even, ///< the same radiance everywhere
    Clear, ///< brighter at the horizon, above dark ground
    Clouds, ///< patches, soft and less so
    Sun, ///< clear, with a sun of a degree or less
    Lamps, ///< dark, with 4 to 30 bright patches
};

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
    Lamps lamps = Lamps::None;
    bool quads = true; ///< false: lamps, or the sky, alone
    Sky sky = Sky::None;
};

/// Of a seed and a version, 1 to 3, always the same. Version 2 is version 1 with lamps in a quarter of its scenes or
/// more, version 3 version 1 on open ground with a sky, three quarters of it without area lights.
LotteryTraits lotteryTraits(std::uint32_t seed, int version = 1);

/// Names of the hard cases that are among them, and of the kinds of lamps and sky.
std::vector<std::string> hardCases(const LotteryTraits& traits);

} // namespace wedge::generator
