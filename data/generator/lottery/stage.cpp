#include "data/generator/lottery/stage.h"
#include "data/generator/textured.h"

#include <algorithm>
#include <cmath>

namespace wedge::generator {
namespace {

void room(LotteryScene& s, Random& random)
{
    const glm::dvec3 half(random.uniform(1, 5), random.uniform(1.1, 2), random.uniform(1, 5));
    s.stage = { { -half.x, 0, -half.z }, { half.x, 2 * half.y, half.z }, 2 * std::min({ half.x, half.y, half.z }),
        false };
    const glm::dvec3 lo = s.stage.lo, hi = s.stage.hi, x(hi.x - lo.x, 0, 0), y(0, hi.y, 0), z(0, 0, hi.z - lo.z);
    const auto wall = [&](const char* name, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v) {
        begin(s, s.scene.mesh, name, oneOf(random, s.surfaces));
        rectangle(s.scene.mesh, corner, u, v, { glm::length(u), glm::length(v) });
    };
    wall("floor", { lo.x, 0, hi.z }, x, -z);
    wall("ceiling", { lo.x, hi.y, lo.z }, x, z);
    wall("back", lo, x, y);
    wall("front", { hi.x, 0, hi.z }, -x, y);
    wall("left", { lo.x, 0, hi.z }, -z, y);
    wall("right", { hi.x, 0, lo.z }, z, y);
}

void ground(LotteryScene& s, Random& random)
{
    const double half = random.uniform(1.5, 6), far = half * random.uniform(2, 8);
    s.stage = { { -half, 0, -half }, { half, half, half }, half, true };
    begin(s, s.scene.mesh, "ground", oneOf(random, s.surfaces));
    if (chance(random, 0.5)) {
        rectangle(s.scene.mesh, { -far, 0, far }, { 2 * far, 0, 0 }, { 0, 0, -2 * far }, glm::dvec2(2 * far));
    } else {
        const double bump = random.uniform(0.01, 0.04) * half, wave = random.uniform(2, 6) / half;
        heightField(s.scene.mesh, far, 48,
            [=](double x, double z) { return bump * (std::sin(wave * x) * std::cos(0.8 * wave * z) - 1.0); });
    }
    const int walls = whole(random, 0, 2);
    for (int i = 0; i < walls; ++i) { // free-standing, behind
        const double high = random.uniform(0.4, 1.2) * half, at = -half * random.uniform(0.7, 1.3);
        begin(s, s.scene.mesh, "wall", oneOf(random, s.surfaces));
        if (i == 0)
            rectangle(s.scene.mesh, { -1.3 * half, -0.1, at }, { 2.6 * half, 0, 0 }, { 0, high, 0 }, { 4, 2 });
        else
            rectangle(s.scene.mesh, { at, -0.1, 1.3 * half }, { 0, 0, -2.6 * half }, { 0, high, 0 }, { 4, 2 });
    }
    s.scene.background = glm::vec3(static_cast<float>(random.uniform(0, 0.6)));
}

} // namespace

void makeStage(LotteryScene& s, Random random)
{
    if (s.traits.open)
        ground(s, random);
    else
        room(s, random);
}

void placeCamera(LotteryScene& s, Random random)
{
    const Stage& stage = s.stage;
    const glm::dvec3 middle(0.5 * (stage.lo + stage.hi)), extent = stage.hi - stage.lo;
    const bool nearWall = chance(random, 0.3);
    const double edge = nearWall ? 0.49 : random.uniform(0.25, 0.45);
    // On open ground from where its walls are not.
    const double angle = stage.open ? random.uniform(-0.5, 2.1) : random.uniform(0, 6.283185307);
    const double height = random.uniform(0.2, 0.85) * stage.hi.y;
    // On the rim of a square, so that something of the stage is before the camera.
    const glm::dvec2 round(std::cos(angle), std::sin(angle));
    const glm::dvec2 rim = round / std::max(std::abs(round.x), std::abs(round.y));
    const double away = stage.open ? random.uniform(0.9, 1.6) : 1.0;
    const glm::dvec3 eye(middle.x + away * edge * extent.x * rim.x, height, middle.z + away * edge * extent.z * rim.y);
    const glm::dvec3 target =
        middle + extent * within(random, { -0.2, -0.5, -0.2 }, { 0.2, stage.open ? -0.3 : -0.1, 0.2 });
    s.scene.camera.eye = glm::vec3(eye);
    s.scene.camera.lookAt = glm::vec3(target);
    s.scene.camera.verticalFov = static_cast<float>(random.uniform(35, 75));
    const double focus = glm::distance(eye, target) * random.uniform(0.6, 1.2), aperture = random.uniform(0.005, 0.03);
    if (s.traits.lens) {
        s.scene.camera.focusDistance = static_cast<float>(focus);
        s.scene.camera.apertureRadius = static_cast<float>(aperture * focus);
    }
}

} // namespace wedge::generator
