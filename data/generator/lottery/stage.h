#pragma once

#include <string>
#include <vector>

#include "data/generator/lottery/draw.h"
#include "data/generator/lottery/traits.h"
#include "data/generator/scene_writer.h"

namespace wedge::generator {

/// Where things stand: a room with its floor at y = 0, or ground.
struct Stage {
    glm::dvec3 lo, hi; ///< of the room; of open ground, where things and lights are
    double size; ///< metres: what lengths of things and lights go with
    bool open;
};

/// A scene in the making.
struct LotteryScene {
    GeneratedScene scene;
    LotteryTraits traits;
    Stage stage;
    std::vector<std::string> surfaces; ///< materials of walls and grounds
    std::vector<std::string> materials; ///< of things
    int objects = 0;
};

/// What follows has that material, and unless all is one group, is an object of its own.
void begin(LotteryScene& s, ObjWriter& mesh, const std::string& name, const std::string& material);

/// One of the list.
const std::string& oneOf(Random& random, const std::vector<std::string>& list);

void makeMaterials(LotteryScene& s, Random random);
void makeStage(LotteryScene& s, Random random);
/// Before things, which keep away from it.
void placeCamera(LotteryScene& s, Random random);
void placeThings(LotteryScene& s, Random random, Random motion);
void placeLights(LotteryScene& s, Random random);
void placeEmitters(LotteryScene& s, Random random);
void placeLamps(LotteryScene& s, Random random);
/// What lights it from all around, in the place of the background.
void makeSky(LotteryScene& s, Random random);

/// A texture of colours, any of six kinds.
image::RgbImage pattern(Random& random);

} // namespace wedge::generator
