#pragma once

#include "data/generator/lottery/traits.h"
#include "data/generator/scene_writer.h"

namespace wedge::generator {

/// A scene that nobody designed: a room or open ground with things in it, under 1 to 16 area lights, lamps or a sky, as
/// the traits of the seed and the version say. Its name is "lottery_", of version 2 "lottery2_" and so on, and the
/// seed. Materials whose names begin with "phong" are meant to have Phong's lobe, which MTL files cannot say.
GeneratedScene makeLottery(std::uint32_t seed, int version = 1);

} // namespace wedge::generator
