#include "data/generator/light_level.h"
#include "data/generator/lottery/stage.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace wedge::generator {
namespace {

/// A quad around `centre` that faces `forward`, of half sides u and v metres, turned around `forward` by `angle`.
scene::AreaLight quad(const glm::dvec3& centre, const glm::dvec3& forward, const glm::dvec2& half, double angle)
{
    const glm::dvec3 other = std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(forward, other)), b = glm::cross(forward, a);
    scene::AreaLight light;
    light.centre = glm::vec3(centre);
    light.halfU = glm::vec3(half.x * (std::cos(angle) * a + std::sin(angle) * b));
    light.halfV = glm::vec3(half.y * (std::cos(angle) * b - std::sin(angle) * a)); // cross(halfU, halfV) = forward
    return light;
}

glm::dvec3 onFloor(const Stage& stage, Random& random)
{
    return stage.lo + (stage.hi - stage.lo) * within(random, { 0.2, 0, 0.2 }, { 0.8, 0.3, 0.8 });
}

/// Above what it lights, and aimed at it.
scene::AreaLight highLight(const Stage& stage, Random& random, const glm::dvec2& half, double angle)
{
    const double reach = stage.open ? random.uniform(0.8, 2) : 0.48;
    const glm::dvec3 middle = 0.5 * (stage.lo + stage.hi), extent = stage.hi - stage.lo;
    glm::dvec3 centre = middle + extent * within(random, { -reach, 0.1, -reach }, { reach, 0.45, reach });
    if (stage.open)
        centre.y = stage.size * random.uniform(0.7, 2);
    const glm::dvec3 target = onFloor(stage, random);
    const bool lamp = !stage.open && chance(random, 0.5); // below the ceiling, facing down
    if (lamp)
        centre.y = stage.hi.y * random.uniform(0.9, 0.995);
    return quad(centre, lamp ? glm::dvec3(0, -1, 0) : glm::normalize(target - centre), half, angle);
}

/// Partly below the floor, upright near it, flush with a wall or the floor, or grazing a wall.
scene::AreaLight lowLight(const Stage& stage, Random& random, const glm::dvec2& half, double angle)
{
    const glm::dvec3 at = onFloor(stage, random);
    const double heading = random.uniform(0, 6.283185307), gap = stage.size * logarithmic(random, 0.0005, 0.03);
    const double height = half.y * random.uniform(-0.6, 1.1);
    const glm::dvec3 level(std::cos(heading), 0, std::sin(heading));
    switch (whole(random, 0, 3)) {
    case 0:
        return quad({ at.x, height, at.z }, level, half, 0.0);
    case 1:
        return quad(
            { at.x, height, at.z }, glm::normalize(level - glm::dvec3(0, random.uniform(0, 1), 0)), half, angle);
    case 2: { // just above the floor, or before the back wall
        if (chance(random, 0.5))
            return quad({ at.x, gap, at.z }, { 0, 1, 0 }, half, angle);
        return quad({ at.x, stage.hi.y * random.uniform(0.2, 0.8), stage.lo.z + gap }, { 0, 0, 1 }, half, angle);
    }
    default: // along the back wall, across its plane
        return quad({ at.x, stage.hi.y * random.uniform(0.4, 0.95), stage.lo.z + half.y * random.uniform(-0.6, 1.1) },
            { 0, -1, 0 }, half, 0.0);
    }
}

/// At which a white surface that faces it from `distance` sends out about `level`.
float radianceOf(const scene::AreaLight& light, double distance, double level)
{
    const glm::dvec3 forward = glm::normalize(glm::cross(glm::dvec3(light.halfU), glm::dvec3(light.halfV)));
    return radianceFor(light, glm::dvec3(light.centre) + distance * forward, -forward, 1.0, level);
}

} // namespace

void placeLights(LotteryScene& s, Random random)
{
    const int low = s.traits.lowLights ? (s.traits.lights + 1) / 2 : 0;
    for (int i = 0; i < s.traits.lights; ++i) {
        const double size = s.stage.size * logarithmic(random, 0.02, 0.35);
        const glm::dvec2 half(size, size * random.uniform(0.4, 1));
        const double angle = random.uniform(0, 6.283185307),
                     level = random.uniform(0.4, 1.6) / std::sqrt(s.traits.lights);
        scene::AreaLight light =
            i < low ? lowLight(s.stage, random, half, angle) : highLight(s.stage, random, half, angle);
        light.profile = chance(random, 0.4) ? scene::LightProfile::Uniform : scene::LightProfile::Gaussian;
        light.cut = static_cast<float>(random.uniform(1, 3));
        light.twoSided = chance(random, 0.1);
        light.visible = chance(random, 0.6);
        const glm::dvec3 tint = within(random, glm::dvec3(0.7), glm::dvec3(1.0));
        const double reach = 0.35 * glm::length(s.stage.hi - s.stage.lo);
        light.radiance = glm::vec3(tint) * radianceOf(light, std::max(reach, 2 * size), level);
        if (i == 0)
            s.scene.light = light;
        else
            s.scene.furtherLights.push_back(light);
    }
}

void placeEmitters(LotteryScene& s, Random random)
{
    const int count = s.traits.smallEmitters ? whole(random, 1, 4) : 0;
    for (int i = 0; i < count; ++i) {
        const double radius = s.stage.size * logarithmic(random, 0.005, 0.04), level = random.uniform(0.05, 0.4);
        glm::dvec3 at =
            s.stage.lo + (s.stage.hi - s.stage.lo) * within(random, { 0.15, 0.02, 0.15 }, { 0.85, 0.8, 0.85 });
        at.y = std::max(at.y, radius);
        scene::Material m = matt(fmt::format("emitter{}", i), glm::vec3(0.2f));
        const double far = 0.4 * s.stage.size / radius; // at this many radii a white surface sends out `level`
        m.emission = glm::vec3(within(random, { 0.8, 0.6, 0.4 }, glm::dvec3(1.0)) * (level * far * far));
        begin(s, s.scene.mesh, "emitter", m.name);
        if (chance(random, 0.5))
            sphere(s.scene.mesh, at, radius, 12, 16);
        else
            box(s.scene.mesh, at, glm::dvec3(radius, 0.7 * radius, radius), glm::dmat3(1.0));
        s.scene.materials.push_back(std::move(m));
    }
}

} // namespace wedge::generator
