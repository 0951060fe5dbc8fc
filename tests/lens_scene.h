// A scene with all sorts of light for frames through a lens.
#pragma once

#include "tests/render_support.h"

namespace wedge::test {

/// Boxes on a floor in the plane in focus of a lens in front of it, with an occluder out of view between them and a
/// light.
inline scene::Scene wallInFocus()
{
    SceneBuilder b;
    b.scene.textures.push_back({ "", 2, 2, { 0xff8040u, 0xffffffu, 0x306090u, 0xc0c0c0u } });
    b.scene.materials[0].diffuseTexture = 0;
    b.scene.materials[0].specular = glm::vec3(0.2f);
    b.scene.materials[0].exponent = 12;
    b.scene.materials[0].emission = { 0.05f, 0, 0.1f };
    b.quad({ 0, 0, 0 }, { 3, 0, 0 }, { 0, 3, 0 });
    b.newObject();
    b.quad({ 0.2f, 0.1f, 4 }, { 0.4f, 0, 0 }, { 0, 0.4f, 0 });
    b.light({ -1, 1, 6 }, { 0, 0.5f, 0 }, { 0.5f, 0, 0 }, scene::LightProfile::Gaussian, 60);
    b.scene.pointLights.push_back({ { 1, -1, 5 }, { 8, 6, 4 } });
    b.camera({ 0, 0, 3 }, { 0, 0, 0 });
    return b.scene;
}

} // namespace wedge::test
