#pragma once

#include <string>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "host/scene/toml_reader.h"

namespace wedge::scene {

/// The rotation [x, y, z, degrees] under `key`, which is there: about that axis, counter-clockwise seen from its tip.
glm::dquat readRotation(TableReader& table, const std::string& key);

/// The factors under `key`, which is there: one number or three. They may be 0.
glm::dvec3 readScale(TableReader& table, const std::string& key);

/// The transform under `key`: one step or a list of steps, the first applied first. A step is a table of one of
/// translate = [x, y, z], rotate = [x, y, z, degrees] (about that axis, counter-clockwise seen from its tip),
/// scale = s or [x, y, z], matrix = 16 numbers row by row (or 4 rows). Identity when the key is absent.
/// Throws Error for one that cannot be undone (a scale of 0) or is projective.
glm::dmat4 readTransform(TableReader& table, const std::string& key);

} // namespace wedge::scene
