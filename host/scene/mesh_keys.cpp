#include "host/scene/mesh_keys.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "host/scene/keyframes.h"
#include "host/scene/transform.h"

namespace wedge::scene {
namespace {

/// The mesh would be squeezed flat on its way where a factor is 0 or changes its sign.
void checkScale(TableReader& key, const glm::dvec3& scale, const glm::dvec3& before)
{
    for (int axis = 0; axis < 3; ++axis) {
        if (!(scale[axis] * before[axis] > 0.0))
            key.fail("scale", "squeezes the mesh flat, at this key or on the way to it",
                fmt::format("factors {:g} and {:g}", before[axis], scale[axis]),
                "use factors other than 0, of the same sign in all keys");
    }
}

} // namespace

MeshKeys::MeshKeys(TableReader& mesh)
{
    for (TableReader& key : mesh.tables("key")) {
        Pose pose;
        const double time = readKeyTime(key, times_);
        if (key.has("translate"))
            pose.translation = readVector(key, "translate");
        if (key.has("rotate"))
            pose.rotation = readRotation(key, "rotate");
        if (key.has("scale"))
            pose.scale = readScale(key, "scale");
        key.finish();
        checkScale(key, pose.scale.single, poses_.empty() ? pose.scale.single : poses_.back().scale.single);
        times_.push_back(time);
        poses_.push_back(pose);
    }
}

Transform MeshKeys::at(double time) const
{
    if (times_.empty())
        return {};
    const KeySpan span = spanAt(times_, time);
    const Pose &a = poses_[span.from], &b = poses_[span.to];
    const double weight = a == b ? 0.0 : span.weight; // rounding must not make rest a motion
    const glm::dmat4 turn = glm::mat4_cast(glm::slerp(a.rotation, b.rotation, weight));
    const auto placed = [&](glm::dvec3 FileVector::*kind) {
        const glm::dmat4 moved =
            glm::translate(glm::dmat4(1.0), glm::mix(a.translation.*kind, b.translation.*kind, weight));
        return glm::scale(moved * turn, glm::mix(a.scale.*kind, b.scale.*kind, weight));
    };
    return { placed(&FileVector::exact), placed(&FileVector::single) };
}

} // namespace wedge::scene
