// Scenes under light from beyond.
#pragma once

#include "effects/environment/environment.h"
#include "tests/render_support.h"

namespace wedge::test {

inline const glm::vec3 sky(0.4f, 0.6f, 0.9f), reflectance(0.8f, 0.7f, 0.6f);

inline std::shared_ptr<render::EnvironmentPicture> even(glm::vec3 radiance, int width = 1, int height = 1)
{
    auto p = std::make_shared<render::EnvironmentPicture>();
    p->width = width;
    p->height = height;
    for (int i = 0; i < width * height; ++i)
        p->radiance.insert(p->radiance.end(), { radiance.x, radiance.y, radiance.z });
    return p;
}

inline void set(render::EnvironmentPicture& p, int x, int y, glm::vec3 radiance)
{
    for (int c = 0; c < 3; ++c)
        p.radiance[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) + static_cast<std::size_t>(x))
            + static_cast<std::size_t>(c)] = radiance[c];
}

/// All that the camera sees is a floor.
inline SceneBuilder openFloor()
{
    SceneBuilder b;
    b.scene.materials[0].diffuse = reflectance;
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
    b.camera({ 0, 2, 0 }, { 0, 0, 0 }, { 0, 0, -1 }, 40);
    render::setEnvironment(b.scene, even(sky));
    return b;
}

/// A dim sky with a small bright spot and a gradient, which every texel's radiance differs in.
inline std::shared_ptr<render::EnvironmentPicture> spotted()
{
    auto p = even(glm::vec3(0), 32, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            set(*p, x, y, glm::vec3(0.02f * static_cast<float>(x), 0.3f, 0.05f * static_cast<float>(16 - y)));
    set(*p, 11, 4, { 90, 80, 60 });
    set(*p, 12, 4, { 90, 80, 60 });
    return p;
}

} // namespace wedge::test
