// What tests share of the kernels that light by lights which stand for an environment's map.
#pragma once

#include "effects/shadow_lights/map_lights.h"
#include "kernels/shared/bsdf.h"
#include "kernels/shared/shadow_lights.h"
#include "tests/environment_support.h"
#include "tests/pass_bench.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace wedge::test::shadows {

inline constexpr int width = 45, height = 31;
inline constexpr std::uint32_t count = 14;

/// A small scene, lit by a spotted map alone, with that lobe.
inline scene::Scene under(scene::SpecularModel model, float exponent)
{
    scene::Scene scene = smallScene();
    scene.areaLights.clear();
    scene.materials[0].specular = { 0.1f, 0.2f, 0.3f };
    scene.materials[0].specularModel = model;
    scene.materials[0].exponent = exponent;
    scene.materials[0].roughness = 0.4f;
    render::setEnvironment(scene, spotted());
    return scene;
}

/// Of `count` lights.
inline render::Settings settings(render::Shadows shadows, render::WholeLight whole = render::WholeLight::Prefiltered)
{
    render::Settings s = sized(render::monteCarlo(4), width, height);
    s.environment.shadows = { shadows, static_cast<int>(count), whole, true, 0, 1 };
    return s;
}

/// As kernels have them.
inline std::vector<float> listOf(const std::vector<render::MapLight>& lights)
{
    std::vector<float> out;
    for (const render::MapLight& light : lights)
        for (const glm::vec3& v : { light.towards, light.irradiance })
            out.insert(out.end(), { v.x, v.y, v.z });
    return out;
}

/// Lobes in closed form, 1/sr, of reflection laws as docs/materials.md has them; GGX by the shared maths.
inline double lobe(shared::Gloss gloss, glm::dvec3 n, glm::dvec3 v, glm::dvec3 l)
{
    const double m = gloss.exponent, pi = std::numbers::pi;
    if (gloss.kind == WEDGE_PHONG) {
        const double c = 2 * glm::dot(n, v) * glm::dot(n, l) - glm::dot(v, l);
        return (m + 2) / (2 * pi) * std::pow(std::max(c, 0.0), m);
    }
    const double c = glm::dot(n, glm::normalize(v + l));
    return (m + 2) * (m + 4) / (8 * pi * (std::exp2(-0.5 * m) + m)) * std::pow(std::max(c, 0.0), m);
}

/// As wide at least as the lights are apart.
inline shared::Gloss widened(shared::Gloss gloss)
{
    const float spacing = static_cast<float>(count / (4 * std::numbers::pi));
    gloss.exponent = std::min(gloss.exponent, gloss.kind == WEDGE_PHONG ? spacing : 4 * spacing);
    return gloss;
}

/// A pass after its primary rays, with the lights of the scene's map.
struct Traced {
    Traced(
        DeclaredFrame& frame, const std::vector<render::MapLight>& lights, const std::string& kernel = "shadowLights")
        : primary(frame, "primary")
        , pass(frame, kernel)
    {
        primary.run();
        for (const char* name : { "position", "normal", "origin", "diffuse", "specular" })
            if (pass.has(name))
                pass.plane(name, primary.read<float>(name));
        for (const char* name : { "geometric", "objectId", "gloss" })
            pass.plane(name, primary.read<std::uint32_t>(name));
        pass.plane("lights", listOf(lights));
    }
    void upTo(std::uint32_t last)
    {
        pass.value("lastSample", last);
        pass.run();
    }
    void all()
    {
        pass.value("count", count);
        pass.run();
    }
    PassBench primary, pass;
};

} // namespace wedge::test::shadows
