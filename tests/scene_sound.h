#pragma once

#include <doctest/doctest.h>

#include "scene_support.h"

namespace scene_test {

/// What every scene that is to be rendered must hold.
inline void checkSound(const wedge::scene::Scene& s)
{
    const auto& g = s.geometry;
    const std::size_t triangles = g.indices.size() / 3, vertices = g.positions.size() / 3;
    CHECK(g.normals.size() == 3 * vertices);
    CHECK(g.texcoords.size() == 2 * vertices);
    REQUIRE(g.materialIds.size() == triangles);
    REQUIRE(g.objectIds.size() == triangles);
    std::size_t wrong = 0, degenerate = 0, turned = 0;
    for (std::size_t t = 0; t < triangles; ++t) {
        wrong += g.materialIds[t] >= s.materials.size() || g.objectIds[t] < 1 || g.objectIds[t] > g.objectNames.size();
        const glm::vec3 a = corner(g, t, 0);
        const glm::vec3 normal = glm::cross(corner(g, t, 1) - a, corner(g, t, 2) - a);
        degenerate += !(glm::length(normal) > 0.0f);
        for (std::size_t i = 0; i < 3; ++i) {
            wrong += g.indices[3 * t + i] >= vertices;
            turned += glm::dot(normal, vectorAt(g.normals, g.indices[3 * t + i])) < 0.0f;
        }
    }
    CHECK(wrong == 0);
    CHECK(degenerate == 0);
    CHECK(turned == 0); // no shading normal points to the other side
    for (const auto& light : s.areaLights) {
        const glm::vec3 facing = glm::cross(light.halfU, light.halfV);
        CHECK(glm::dot(facing, s.camera.lookAt - light.centre) > 0.0f); // shines on what the camera looks at
    }
}

} // namespace scene_test
