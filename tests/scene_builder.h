// Scenes that are put together in code.
#pragma once

#include "host/scene/scene.h"

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace wedge::test {

/// A scene put together in code. Objects are numbered from 1, in the order of newObject().
class SceneBuilder {
public:
    SceneBuilder()
    {
        scene.materials.emplace_back();
        scene.materials[0].diffuse = { 0.8f, 0.7f, 0.6f };
    }

    void newObject() { scene.geometry.objectNames.emplace_back("object"); }

    void triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, std::uint32_t material = 0)
    {
        for (const glm::vec3& v : { a, b, c })
            vertex(v, glm::vec3(0), 0, 0);
        close(material);
    }

    /// A parallelogram with its normal along cross(halfU, halfV), texture coordinates 0 to 1 along both.
    void quad(glm::vec3 centre, glm::vec3 halfU, glm::vec3 halfV, std::uint32_t material = 0)
    {
        const float corners[6][2] = { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, -1 }, { 1, 1 }, { -1, 1 } };
        for (int i = 0; i < 6; ++i) {
            const float u = corners[i][0], v = corners[i][1];
            vertex(centre + u * halfU + v * halfV, glm::vec3(0), 0.5f + 0.5f * u, 0.5f + 0.5f * v);
            if (i % 3 == 2)
                close(material);
        }
    }

    void box(glm::vec3 lo, glm::vec3 hi, std::uint32_t material = 0)
    {
        const glm::vec3 c = 0.5f * (lo + hi), h = 0.5f * (hi - lo);
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : { -1.0f, 1.0f }) {
                glm::vec3 out(0), u(0), v(0);
                out[axis] = side * h[axis];
                u[(axis + 1) % 3] = side * h[(axis + 1) % 3];
                v[(axis + 2) % 3] = h[(axis + 2) % 3];
                quad(c + out, u, v, material);
            }
    }

    /// A sphere with smooth normals.
    void sphere(glm::vec3 centre, float radius, int rings = 12, std::uint32_t material = 0)
    {
        const auto at = [](int ring, int sector, int rs) {
            const double theta = 3.14159265358979 * ring / rs, phi = 3.14159265358979 * sector / rs;
            return glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
        };
        for (int ring = 0; ring < rings; ++ring)
            for (int sector = 0; sector < 2 * rings; ++sector) {
                const glm::vec3 a = at(ring, sector, rings), b = at(ring, sector + 1, rings);
                const glm::vec3 c = at(ring + 1, sector + 1, rings), d = at(ring + 1, sector, rings);
                for (const glm::vec3& n : { a, b, c, a, c, d }) {
                    vertex(centre + radius * n, n, 0, 0);
                    if (vertices() % 3 == 0)
                        close(material);
                }
            }
    }

    scene::AreaLight& light(
        glm::vec3 centre, glm::vec3 halfU, glm::vec3 halfV, scene::LightProfile profile, float radiance)
    {
        scene::AreaLight light;
        light.centre = centre;
        light.halfU = halfU;
        light.halfV = halfV;
        light.profile = profile;
        light.radiance = glm::vec3(radiance);
        light.visible = false;
        scene.areaLights.push_back(light);
        return scene.areaLights.back();
    }

    void camera(glm::vec3 eye, glm::vec3 lookAt, glm::vec3 up = { 0, 1, 0 }, float fov = 45)
    {
        scene.camera = { .eye = eye, .lookAt = lookAt, .up = up, .verticalFov = fov };
    }

    scene::Scene scene;

private:
    std::size_t vertices() const { return scene.geometry.positions.size() / 3; }

    void vertex(glm::vec3 p, glm::vec3 n, float u, float v)
    {
        scene::Geometry& g = scene.geometry;
        g.positions.insert(g.positions.end(), { p.x, p.y, p.z });
        g.normals.insert(g.normals.end(), { n.x, n.y, n.z });
        g.texcoords.insert(g.texcoords.end(), { u, v });
        g.indices.push_back(static_cast<std::uint32_t>(vertices() - 1));
    }

    /// Makes the last three vertices a triangle.
    void close(std::uint32_t material)
    {
        if (scene.geometry.objectNames.empty())
            newObject();
        scene.geometry.materialIds.push_back(material);
        scene.geometry.objectIds.push_back(static_cast<std::uint32_t>(scene.geometry.objectNames.size()));
    }
};

/// A floor with a box, a slanted plate, a sphere and a row of slats, under two area lights of different kinds and
/// colours.
inline scene::Scene smallScene()
{
    SceneBuilder b;
    b.newObject();
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
    b.newObject();
    b.box({ -1.2f, 0, -0.4f }, { -0.7f, 0.9f, 0.1f });
    b.newObject();
    b.quad({ 0.7f, 0.9f, 0 }, { 0.1f, 0.05f, 0.5f }, { 0.5f, -0.1f, 0 });
    b.newObject();
    b.sphere({ 0, 0.35f, 0.7f }, 0.35f);
    b.newObject();
    for (int i = 0; i < 4; ++i)
        b.box({ -0.6f + 0.3f * static_cast<float>(i), 0.6f, -1.2f },
            { -0.45f + 0.3f * static_cast<float>(i), 0.65f, 0.3f });
    b.light({ 0.2f, 3, 0.3f }, { 0.5f, 0, 0 }, { 0, 0, 0.5f }, scene::LightProfile::Gaussian, 20).radiance = { 20, 18,
        15 };
    b.light({ -2, 2.5f, 1 }, { 0, 0, 0.3f }, { 0.2f, -0.2f, 0 }, scene::LightProfile::Uniform, 15).twoSided = true;
    b.camera({ 0, 2.0f, 2.8f }, { 0, 0.3f, 0 });
    b.scene.background = { 0.1f, 0.2f, 0.3f };
    return b.scene;
}

/// The same with a lobe of that exponent on everything.
inline scene::Scene glossyScene(float exponent = 20)
{
    scene::Scene out = smallScene();
    out.materials[0].specular = glm::vec3(0.3f);
    out.materials[0].exponent = exponent;
    return out;
}

/// The same with gloss, a texture and lights of every sort.
inline scene::Scene richScene()
{
    scene::Scene scene = smallScene();
    scene.materials[0].specular = { 0.1f, 0.2f, 0.1f };
    scene.materials[0].exponent = 15;
    scene.textures.push_back({ "", 2, 2, { 0xff8040u, 0xffffffu, 0x306090u, 0xc0c0c0u } });
    scene.materials[0].diffuseTexture = 0;
    scene.pointLights.push_back({ { 1, 3, 2 }, { 2, 2, 2 } });
    scene.directionalLights.push_back({ { 0.2f, -1, 0.1f }, { 0.5f, 0.5f, 0.4f } });
    return scene;
}

} // namespace wedge::test
