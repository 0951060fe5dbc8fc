// Frames whose environment is lights: what their tests share.
#pragma once

#include "tests/environment_support.h"

#include <memory>

namespace wedge::test::shadows {

inline constexpr int width = 40, height = 30;
using render::Shadows;
using render::WholeLight;

/// As filters have no say in this light, by default without any.
inline render::Settings with(Shadows shadows, int lights = 30, WholeLight whole = WholeLight::Map, bool clamp = true)
{
    render::Settings s = sized(render::monteCarlo(1), width, height);
    s.environment.shadows = { shadows, lights, whole, clamp, 0, 1 };
    return s;
}

/// Things on a floor, without lamps.
inline scene::Scene things(const std::shared_ptr<render::EnvironmentPicture>& map, float specular = 0,
    float exponent = 40, scene::SpecularModel model = scene::SpecularModel::Phong)
{
    scene::Scene scene = smallScene();
    scene.areaLights.clear();
    scene.background = glm::vec3(0);
    scene.materials[0].specular = glm::vec3(specular);
    scene.materials[0].exponent = exponent;
    scene.materials[0].roughness = 0.4f;
    scene.materials[0].specularModel = model;
    render::setEnvironment(scene, map);
    return scene;
}

/// A floor that glosses under nothing.
inline scene::Scene openGloss(
    const std::shared_ptr<render::EnvironmentPicture>& map, scene::SpecularModel model, float exponent)
{
    SceneBuilder b = openFloor();
    b.scene.materials[0].diffuse = glm::vec3(0.4f);
    b.scene.materials[0].specular = glm::vec3(0.3f);
    b.scene.materials[0].exponent = exponent;
    b.scene.materials[0].roughness = 0.5f;
    b.scene.materials[0].specularModel = model;
    b.camera({ 0, 1.5f, 3 }, { 0, 0, 0 });
    render::setEnvironment(b.scene, map);
    return b.scene;
}

} // namespace wedge::test::shadows
