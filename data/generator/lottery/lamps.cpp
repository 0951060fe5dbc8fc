#include "data/generator/lottery/stage.h"
#include "data/generator/textured.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace wedge::generator {
namespace {

constexpr double pi = 3.14159265358979324;

/// Emission of `count` lamps, each of which shows `area` m^2 to a white surface far away that sends out `level`.
scene::Material glowing(const LotteryScene& s, Random& random, const std::string& name, int count, double area)
{
    const double level = random.uniform(0.3, 1.5) / (s.traits.quads ? 2.0 : 1.0);
    const double distance = 0.35 * glm::length(s.stage.hi - s.stage.lo);
    scene::Material m = matt(name, glm::vec3(0.1f));
    m.emission = glm::vec3(
        within(random, { 0.8, 0.6, 0.4 }, glm::dvec3(1.0)) * (level * pi * distance * distance / (area * count)));
    return m;
}

/// Under the ceiling, or above the ground and what stands on it.
glm::dvec3 overhead(const LotteryScene& s, Random& random)
{
    const glm::dvec3 part = within(random, { 0.15, 0.6, 0.15 }, { 0.85, 0.95, 0.85 });
    return s.stage.lo + (s.stage.hi - s.stage.lo) * part;
}

/// One of a radius of about `size`. Returns the area that it shows from the side that shows most of it.
double largeLamp(ObjWriter& mesh, Random& random, const glm::dvec3& at, double size)
{
    const double tilt = chance(random, 0.5) ? 0.0 : random.uniform(0.1, 1.5), heading = random.uniform(0, 2 * pi);
    const glm::dvec3 down(std::sin(tilt) * std::cos(heading), -std::cos(tilt), std::sin(tilt) * std::sin(heading));
    const glm::dvec3 u = glm::normalize(glm::cross(down, glm::dvec3(std::sin(heading), 0, -std::cos(heading))));
    const glm::dvec3 v = glm::cross(down, u);
    const double across = size * random.uniform(0.4, 1);
    switch (whole(random, 0, 5)) {
    case 0: // a panel
        rectangle(mesh, at - size * u - across * v, 2 * size * u, 2 * across * v);
        return 4 * size * across;
    case 1: { // a bent one of many triangles
        const double bend = random.uniform(0, 0.5) * size;
        sheet(mesh, 10, 4, [=](double x, double y) {
            return at + (2 * x - 1) * size * u + (2 * y - 1) * across * v + bend * (2 * x - 1) * (2 * x - 1) * down;
        });
        return 4 * size * across;
    }
    case 2: // a disc
        sheet(mesh, 24, 2,
            [=](double x, double y) { return at + y * size * (std::cos(2 * pi * x) * u + std::sin(2 * pi * x) * v); });
        return pi * size * size;
    case 3:
        sphere(mesh, at, 0.5 * size, 12, 16);
        return 0.25 * pi * size * size;
    case 4: { // a fluorescent tube
        const double radius = 0.06 * size;
        tube(mesh, { at - size * u, at + size * u }, { radius, radius }, 12);
        return 4 * size * radius;
    }
    default:
        box(mesh, at, { 0.5 * size, 0.15 * size, 0.5 * across }, glm::dmat3(u, glm::cross(v, u), v));
        return size * across;
    }
}

void largeLamps(LotteryScene& s, Random& random)
{
    const int count = whole(random, 1, 4);
    for (int i = 0; i < count; ++i) {
        const std::string name = fmt::format("lamp{}", i);
        begin(s, s.scene.mesh, "lamp", name);
        const glm::dvec3 at = overhead(s, random);
        const double area = largeLamp(s.scene.mesh, random, at, s.stage.size * logarithmic(random, 0.05, 0.25));
        s.scene.materials.push_back(glowing(s, random, name, count, area));
    }
}

/// Hundreds of bulbs: along a hanging line, in a flat field, or anywhere.
void smallLamps(LotteryScene& s, Random& random)
{
    const int count = whole(random, 100, 400), order = whole(random, 0, 2);
    const double radius = s.stage.size * logarithmic(random, 0.002, 0.01);
    const glm::dvec3 from = overhead(s, random), to = overhead(s, random), extent = s.stage.hi - s.stage.lo;
    s.scene.materials.push_back(glowing(s, random, "bulbs", count, pi * radius * radius));
    for (int i = 0; i < count; ++i) {
        const double along = (i + 0.5) / count;
        glm::dvec3 at = glm::mix(from, to, along)
            - glm::dvec3(0, s.stage.size * 0.2 * 4 * along * (1 - along), 0) // which hangs through
            + radius * 2.0 * random.inBall();
        if (order == 1)
            at = from + 0.35 * extent * within(random, { -1, 0, -1 }, { 1, 0.02, 1 });
        else if (order == 2)
            at = s.stage.lo + extent * within(random, { 0.05, 0.02, 0.05 }, { 0.95, 0.95, 0.95 });
        begin(s, s.scene.mesh, "bulb", "bulbs");
        sphere(s.scene.mesh, glm::clamp(at, s.stage.lo + radius, s.stage.hi - radius), radius, 4, 6);
    }
}

/// A screen or a window.
void texturedLamp(LotteryScene& s, Random& random)
{
    const double half = s.stage.size * logarithmic(random, 0.08, 0.3), high = half * random.uniform(0.4, 1);
    const double heading = random.uniform(0, 2 * pi);
    const glm::dvec3 u(std::cos(heading), 0, std::sin(heading)), up(0, 1, 0);
    const glm::dvec3 part = within(random, { 0.2, 0.3, 0.2 }, { 0.8, 0.8, 0.8 });
    const glm::dvec3 at = s.stage.lo + (s.stage.hi - s.stage.lo) * part;
    scene::Material m = glowing(s, random, "screen", 1, 0.4 * 4 * half * high); // the texture is darker than white
    m.emissionTexture = static_cast<int>(s.scene.textures.size());
    s.scene.textures.push_back({ "screen", pattern(random) });
    begin(s, s.scene.mesh, "screen", m.name);
    const int cells = chance(random, 0.5) ? 1 : 8;
    sheet(s.scene.mesh, cells, cells,
        [=](double x, double y) { return at + (2 * x - 1) * half * u + (2 * y - 1) * high * up; });
    s.scene.materials.push_back(std::move(m));
}

} // namespace

void placeLamps(LotteryScene& s, Random random)
{
    random.uniform(0, 1); // traits drew the first three
    random.uniform(0, 1);
    random.uniform(0, 1);
    switch (s.traits.lamps) {
    case Lamps::None:
        return;
    case Lamps::Large:
        return largeLamps(s, random);
    case Lamps::Small:
        return smallLamps(s, random);
    case Lamps::Textured:
        return texturedLamp(s, random);
    }
}

} // namespace wedge::generator
