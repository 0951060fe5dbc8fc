#include "host/scene/validate.h"

#include "host/scene/rounding.h"
#include "host/scene/sections.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host/error.h"

namespace wedge::scene {
namespace {

// The renderer divides by lengths of cross(halfU, halfV), a quarter of the area, and of look_at - eye. Their squares
// must neither overflow nor lose bits in single precision, whose normal numbers go from 1.2e-38 to 3.4e38.
constexpr double leastArea = 1e-18, mostArea = 1e19; // m^2
constexpr double leastViewLength = 1e-18; // m
constexpr double leastRelativeView = 1e-6; // of the largest coordinate: the direction keeps a digit or more
constexpr double mostPower = 1e30; // W/sr, with room for a division by small squared distances

std::string shown(const glm::vec3& v) { return fmt::format("[{:g}, {:g}, {:g}]", v.x, v.y, v.z); }

/// The first names, and how many more there are.
std::string listed(const std::vector<std::string>& names)
{
    constexpr std::size_t most = 3;
    std::string out;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
        out += (i == 0 ? "" : ", ") + names[i];
    return names.size() > most ? fmt::format("{} and {} more", out, names.size() - most) : out;
}

/// Light of lights without extent does not pass glass: no path meets them.
void warnOfHiddenLights(const Scene& scene, Warnings& warnings)
{
    std::vector<bool> used(scene.materials.size(), false);
    for (const std::uint32_t id : scene.geometry.materialIds)
        used[id] = true;
    std::vector<std::string> materials, lights;
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (used[i] && scene.materials[i].specularModel == SpecularModel::Glass)
            materials.push_back(fmt::format("'{}'", scene.materials[i].name));
    for (const PointLight& light : scene.pointLights)
        lights.push_back("the point light at " + shown(light.position));
    for (const DirectionalLight& light : scene.directionalLights)
        lights.push_back("the directional light along " + shown(light.direction));
    if (!materials.empty() && !lights.empty())
        warnings.add("lights behind glass",
            fmt::format("scene {}: light of {} does not pass glass, of material {}: behind it they light nothing; "
                        "an area light or a mesh that emits does",
                scene.path, listed(lights), listed(materials)));
}

} // namespace

void checkCamera(const Camera& camera, const std::string& where)
{
    const glm::dvec3 forward = glm::dvec3(camera.lookAt) - glm::dvec3(camera.eye);
    const glm::dvec3 up(camera.up);
    if (!(glm::length(forward) > 0.0))
        throw Error(where + ": camera looks nowhere, eye and look_at are equal in single precision", shown(camera.eye),
            "move one of the two");
    double largest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        largest =
            std::max({ largest, std::abs(double { camera.eye[axis] }), std::abs(double { camera.lookAt[axis] }) });
    const double leastView = std::max(leastViewLength, leastRelativeView * largest);
    if (!(glm::length(forward) >= leastView))
        throw Error(where + ": camera's eye and look_at are too near each other",
            fmt::format("{:g} m apart", glm::length(forward)),
            fmt::format("move them {:g} m apart or more, or the scene to the origin", leastView));
    const double sine = glm::length(glm::cross(forward, up)) / (glm::length(forward) * glm::length(up));
    if (!(sine > 1e-6)) // also when up is zero
        throw Error(where + ": camera's up is zero or along its view", shown(camera.up),
            fmt::format("choose an up across the view direction {}", shown(glm::vec3(forward))));
    if (!(camera.verticalFov >= 0.001f && camera.verticalFov < 180.0f))
        throw Error(where + ": camera's field of view is out of range", fmt::format("{:g}", camera.verticalFov),
            "use at least 0.001 and less than 180 degrees");
}

void checkAreaLight(const AreaLight& light, const std::string& where, Warnings& warnings)
{
    const double lengthU = glm::length(glm::dvec3(light.halfU));
    const double lengthV = glm::length(glm::dvec3(light.halfV));
    const double area = 4.0 * glm::length(glm::cross(glm::dvec3(light.halfU), glm::dvec3(light.halfV)));
    if (!(area > 1e-6 * lengthU * lengthV) || !(area >= leastArea))
        throw Error(where + ": area light has next to no area",
            fmt::format("half edges {} and {}", shown(light.halfU), shown(light.halfV)),
            "give two edges that are not zero and not parallel");
    if (!(area <= mostArea))
        throw Error(where + ": area light is too large", fmt::format("{:g} m^2", area),
            fmt::format("use at most {:g} m^2, scale the scene down", mostArea));
    const double brightest = std::max({ light.radiance.x, light.radiance.y, light.radiance.z });
    if (!(brightest * area <= mostPower))
        throw Error(where + ": area light is too strong", fmt::format("radiance {:g} on {:g} m^2", brightest, area),
            fmt::format("keep their product at {:g} or less", mostPower));
    if (!(light.cut > 0.0f && light.cut <= 8.0f))
        throw Error(where + ": light's cut is out of range", fmt::format("{:g}", light.cut),
            "use more than 0 and at most 8 standard deviations");
    if (area < 4.0 * lengthU * lengthV * (1.0 - 1e-4))
        warnings.add("lights' edges", where + ": light's edges are not at right angles, filter widths assume they are");
}

void checkBareMesh(const Bounds& bounds, const std::string& where)
{
    const double radius = 0.5 * glm::length(glm::dvec3(bounds.hi) - glm::dvec3(bounds.lo));
    if (!bounds.empty() && !(radius <= maxBareRadius))
        throw Error(where + ": mesh is too large for a light of its own", fmt::format("{:g} m", 2.0 * radius),
            "scale it down, or write a scene file");
}

void checkScene(const Scene& scene, Warnings& warnings)
{
    assert(scene.geometry.positionsAtClose.size() == scene.geometry.normalsAtClose.size());
    assert(!geometryMoves(scene) || scene.geometry.positionsAtClose.size() == scene.geometry.positions.size());
    if (scene.geometry.indices.empty())
        warnings.add(
            "meshes", fmt::format("scene {}: no mesh, only lights and what is behind all are seen", scene.path));
    const bool emits = std::ranges::any_of(
        scene.geometry.materialIds, [&](std::uint32_t id) { return scene.materials[id].emission != glm::vec3(0.0f); });
    const bool lit = std::ranges::any_of(
        sections(), [&](const Section& section) { return section.lights && scene.extensions.contains(section.key); });
    if (scene.settings.integrator != "ao" && scene.areaLights.empty() && scene.pointLights.empty()
        && scene.directionalLights.empty() && !emits && !lit)
        warnings.add(
            "lights", fmt::format("scene {}: no light, surfaces stay black but with --integrator ao", scene.path));
    warnOfHiddenLights(scene, warnings);
    warnOfRounding(scene, warnings);
}

} // namespace wedge::scene
