#include "host/scene/validate.h"

#include <cmath>

#include <fmt/format.h>

#include "host/error.h"

namespace wedge::scene {
namespace {

std::string shown(const glm::vec3& v) { return fmt::format("[{:g}, {:g}, {:g}]", v.x, v.y, v.z); }

} // namespace

void checkCamera(const Camera& camera, const std::string& where)
{
    const glm::dvec3 forward = glm::dvec3(camera.lookAt) - glm::dvec3(camera.eye);
    const glm::dvec3 up(camera.up);
    if (!(glm::length(forward) > 0.0))
        throw Error(
            where + ": camera looks nowhere, eye and look_at are equal", shown(camera.eye), "move one of the two");
    const double sine = glm::length(glm::cross(forward, up)) / (glm::length(forward) * glm::length(up));
    if (!(sine > 1e-6)) // also when up is zero
        throw Error(where + ": camera's up is zero or along its view", shown(camera.up),
            fmt::format("choose an up across the view direction {}", shown(glm::vec3(forward))));
    if (!(camera.verticalFov > 0.0f && camera.verticalFov < 180.0f))
        throw Error(where + ": camera's field of view is out of range", fmt::format("{:g}", camera.verticalFov),
            "use more than 0 and less than 180 degrees");
}

void checkAreaLight(const AreaLight& light, const std::string& where, std::vector<std::string>& warnings)
{
    const double lengthU = glm::length(glm::dvec3(light.halfU));
    const double lengthV = glm::length(glm::dvec3(light.halfV));
    const double area = 4.0 * glm::length(glm::cross(glm::dvec3(light.halfU), glm::dvec3(light.halfV)));
    if (!(area > 1e-6 * lengthU * lengthV) || !(area > 1e-20))
        throw Error(where + ": area light has no area",
            fmt::format("half edges {} and {}", shown(light.halfU), shown(light.halfV)),
            "give two edges that are not zero and not parallel");
    if (!(light.cut > 0.0f && light.cut <= 8.0f))
        throw Error(where + ": light's cut is out of range", fmt::format("{:g}", light.cut),
            "use more than 0 and at most 8 standard deviations");
    if (area < 4.0 * lengthU * lengthV * (1.0 - 1e-4))
        warnings.push_back(where + ": light's edges are not at right angles, filter widths assume they are");
}

void checkScene(Scene& scene)
{
    if (scene.geometry.indices.empty())
        scene.warnings.push_back(fmt::format("scene {}: no mesh, only lights and background are seen", scene.path));
    if (scene.areaLights.empty() && scene.pointLights.empty() && scene.directionalLights.empty())
        scene.warnings.push_back(fmt::format("scene {}: no light, surfaces stay black", scene.path));
}

} // namespace wedge::scene
