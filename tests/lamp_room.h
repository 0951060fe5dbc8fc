// A small room for lamps, and its light over several runs.
#pragma once

#include "tests/render_path_support.h"

namespace wedge::test {

inline std::uint32_t addMaterial(SceneBuilder& b, const scene::Material& material)
{
    b.scene.materials.push_back(material);
    return static_cast<std::uint32_t>(b.scene.materials.size() - 1);
}

inline std::uint32_t addGlow(SceneBuilder& b, glm::vec3 emission)
{
    scene::Material glow;
    glow.diffuse = glm::vec3(0);
    glow.emission = emission;
    return addMaterial(b, glow);
}

/// Where a lamp may hang.
constexpr glm::vec3 lampCentre { 0.3f, 1.6f, -0.2f }, lampU { 0.25f, 0, 0 }, lampV { 0, 0, 0.3f };

/// A floor and a glossy box on it; what comes next is an object of its own.
inline SceneBuilder lampRoom()
{
    SceneBuilder b;
    scene::Material glossy;
    glossy.diffuse = { 0.4f, 0.5f, 0.3f };
    glossy.specular = glm::vec3(0.4f);
    glossy.exponent = 20;
    b.quad({ 0, 0, 0 }, { 0, 0, 2 }, { 2, 0, 0 });
    b.newObject();
    b.box({ -0.5f, 0, -0.4f }, { 0.1f, 0.6f, 0.2f }, addMaterial(b, glossy));
    b.newObject();
    b.camera({ 0.6f, 1.2f, 2.4f }, { 0, 0.4f, -0.2f });
    return b;
}

inline Moments lightOf(
    const SceneBuilder& b, const device::Device& device, const render::Settings& settings, int runs = 8)
{
    render::Renderer renderer(b.scene, device, renderOptions());
    return moments(renderer, settings, Part::Beauty, runs);
}

/// RMS noise of single runs.
inline double rmsNoise(const Moments& m, int runs = 8)
{
    double sum = 0;
    for (const double v : m.variance)
        sum += runs * v;
    return std::sqrt(sum / static_cast<double>(m.size()));
}

} // namespace wedge::test
