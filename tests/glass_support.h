// Materials of mirrors and glass, and skies, for tests.
#pragma once

#include "effects/environment/environment.h"
#include "host/render/environment_table.h"
#include "tests/lamp_room.h"

namespace wedge::test {

inline scene::Material mirror(glm::vec3 colour = glm::vec3(1))
{
    scene::Material m;
    m.specularModel = scene::SpecularModel::Mirror;
    m.diffuse = glm::vec3(0);
    m.specular = colour;
    return m;
}

inline scene::Material glass(float index = 1.5f, glm::vec3 reflects = glm::vec3(1), glm::vec3 transmits = glm::vec3(1))
{
    scene::Material m = mirror(reflects);
    m.specularModel = scene::SpecularModel::Glass;
    m.transmission = transmits;
    m.index = index;
    return m;
}

/// Rows of one radiance each, from above.
inline void addSky(scene::Scene& scene, const std::vector<glm::vec3>& rows)
{
    auto p = std::make_shared<render::EnvironmentPicture>();
    p->width = 1;
    p->height = static_cast<int>(rows.size());
    for (const glm::vec3& row : rows)
        p->radiance.insert(p->radiance.end(), { row.x, row.y, row.z });
    render::setEnvironment(scene, p);
}

/// A sky of one radiance.
constexpr glm::vec3 even(0.4f, 0.6f, 0.9f);

} // namespace wedge::test
