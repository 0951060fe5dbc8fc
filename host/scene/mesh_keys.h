#pragma once

#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "host/scene/toml_reader.h"
#include "host/scene/transform.h"

namespace wedge::scene {

/// How the keyframes of a mesh or a light, [[mesh.key]], place it over time: scaled, then turned, then moved.
class MeshKeys {
public:
    /// Reads them from a [[mesh]] or [[light]]. Throws Error for times out of order and for a scale that passes through
    /// 0.
    explicit MeshKeys(TableReader& mesh);

    /// Between two keys translation and scale are linear, and the rotation goes the shorter way at an even speed
    /// (slerp). Identity without keys.
    Transform at(double time) const;

private:
    struct Pose {
        FileVector translation, scale { glm::dvec3(1.0), glm::dvec3(1.0) };
        glm::dquat rotation { 1.0, 0.0, 0.0, 0.0 };
        bool operator==(const Pose&) const = default;
    };

    std::vector<double> times_;
    std::vector<Pose> poses_;
};

} // namespace wedge::scene
