#pragma once

#include <string>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "host/scene/toml_reader.h"

namespace wedge::scene {

/// A transform by the numbers as the file has them, and by these in single precision, which is as good wherever
/// nothing large cancels.
struct Transform {
    glm::dmat4 exact { 1.0 }, single { 1.0 };

    Transform operator*(const Transform& first) const { return { exact * first.exact, single * first.single }; }
    bool operator==(const Transform&) const = default;

    /// The one to place points with. isSingle: these are of single precision.
    const glm::dmat4& chosen(bool isSingle) const;
};

/// Whether a point in single precision stands for the exact one as well as single precision can.
bool isPrecise(const glm::dvec3& single, const glm::dvec3& exact);

/// The rotation [x, y, z, degrees] under `key`, which is there: about that axis, counter-clockwise seen from its tip.
glm::dquat readRotation(TableReader& table, const std::string& key);

/// A vector of a scene file, and its numbers in single precision.
struct FileVector {
    glm::dvec3 exact { 0.0 }, single { 0.0 };
    bool operator==(const FileVector&) const = default;
};

/// The vector under `key`, which is there.
FileVector readVector(TableReader& table, const std::string& key);

/// The factors under `key`, which is there: one number, which counts as it is, or three. They may be 0.
FileVector readScale(TableReader& table, const std::string& key);

/// The transform under `key`: one step or a list of steps, the first applied first. A step is a table of one of
/// translate = [x, y, z], rotate = [x, y, z, degrees] (about that axis, counter-clockwise seen from its tip),
/// scale = s or [x, y, z], matrix = 16 numbers row by row (or 4 rows). Identity when the key is absent.
/// Throws Error for one that cannot be undone (a scale of 0) or is projective.
Transform readTransform(TableReader& table, const std::string& key);

} // namespace wedge::scene
