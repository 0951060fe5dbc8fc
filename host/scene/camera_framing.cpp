#include "host/scene/camera_framing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wedge::scene {
namespace {

glm::vec3 centreOf(const Bounds& bounds) { return 0.5f * bounds.lo + 0.5f * bounds.hi; }

/// Half the box's diagonal, but never so small that points around the box are not told apart from its centre.
float radiusOf(const Bounds& bounds)
{
    float farthest = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
        farthest = std::max({ farthest, std::abs(bounds.lo[axis]), std::abs(bounds.hi[axis]) });
    return std::max({ 0.5f * glm::length(bounds.hi - bounds.lo), 1e-6f, 1e-6f * farthest });
}

void addFloor(Scene& scene, const Bounds& bounds)
{
    Geometry& g = scene.geometry;
    const glm::vec3 c = centreOf(bounds);
    const float half = 4.0f * radiusOf(bounds);
    // A little below, so that a flat underside does not lie in the floor.
    const float y = bounds.lo.y - 1e-3f * radiusOf(bounds);
    const auto first = static_cast<std::uint32_t>(g.positions.size() / 3);
    const glm::vec2 corners[] = { { -1, 1 }, { 1, 1 }, { 1, -1 }, { -1, -1 } };
    for (const glm::vec2 corner : corners) {
        g.positions.insert(g.positions.end(), { c.x + half * corner.x, y, c.z + half * corner.y });
        g.normals.insert(g.normals.end(), { 0.0f, 1.0f, 0.0f });
        g.texcoords.insert(g.texcoords.end(), { 0.5f + 0.5f * corner.x, 0.5f - 0.5f * corner.y });
    }
    for (const std::uint32_t offset : { 0u, 1u, 2u, 0u, 2u, 3u })
        g.indices.push_back(first + offset);
    Material floor;
    floor.name = "floor";
    floor.diffuse = glm::vec3(0.6f);
    scene.materials.push_back(floor);
    g.objectNames.push_back("floor");
    for (int triangle = 0; triangle < 2; ++triangle) {
        g.materialIds.push_back(static_cast<std::uint32_t>(scene.materials.size() - 1));
        g.objectIds.push_back(static_cast<std::uint32_t>(g.objectNames.size()));
    }
}

AreaLight lightAbove(const Bounds& bounds)
{
    const float radius = radiusOf(bounds);
    const glm::vec3 towardsLight = glm::normalize(glm::vec3(-0.5f, 1.0f, 0.5f));
    const float distance = 4.0f * radius;
    const float half = 0.8f * radius;
    AreaLight light;
    light.name = "above";
    light.centre = centreOf(bounds) + distance * towardsLight;
    light.halfU = half * glm::normalize(glm::cross(glm::vec3(0.0f, 1.0f, 0.0f), towardsLight));
    light.halfV = half * glm::normalize(glm::cross(light.halfU, towardsLight)); // emits along -towardsLight
    // A surface of albedo 0.6 in the centre that faces the light sends out about 0.7. The Gaussian's integral over
    // the quad is 2 pi sigma^2 erf(cut / sqrt 2)^2 with sigma = half / cut.
    const float sigma = half / light.cut;
    const float mass = static_cast<float>(std::pow(std::erf(double { light.cut } / std::numbers::sqrt2), 2.0));
    const float integral = 2.0f * std::numbers::pi_v<float> * sigma * sigma * mass;
    const float irradiance = 0.7f / 0.6f * std::numbers::pi_v<float>;
    light.radiance = glm::vec3(irradiance * distance * distance / integral);
    return light;
}

} // namespace

Camera frameBounds(const Bounds& bounds, double aspect)
{
    Camera camera;
    if (bounds.empty())
        return camera;
    camera.lookAt = centreOf(bounds);
    const double halfVertical = glm::radians(double { camera.verticalFov }) / 2.0;
    const double halfHorizontal = std::atan(std::tan(halfVertical) * aspect);
    const double distance = double { radiusOf(bounds) } / std::sin(std::min(halfVertical, halfHorizontal));
    camera.eye = camera.lookAt + static_cast<float>(distance) * glm::normalize(glm::vec3(0.4f, 0.45f, 1.0f));
    return camera;
}

void furnish(Scene& scene)
{
    const Bounds bounds = sceneBounds(scene);
    scene.camera = frameBounds(bounds, double { 640 } / 480);
    scene.areaLights.push_back(lightAbove(bounds));
    scene.background = glm::vec3(0.35f, 0.42f, 0.5f);
    addFloor(scene, bounds);
}

} // namespace wedge::scene
