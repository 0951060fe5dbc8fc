#include "data/generator/lottery/stage.h"
#include "data/generator/skin.h"
#include "data/generator/textured.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace wedge::generator {
namespace {

constexpr double pi = std::numbers::pi;

/// Where a thing stands, and how large it is.
struct Place {
    glm::dvec3 foot;
    double size, degrees;
};

void crate(ObjWriter& mesh, const Place& p, Random& random)
{
    const glm::dvec3 half = 0.5 * p.size * within(random, glm::dvec3(0.3), glm::dvec3(1.0));
    const glm::dvec3 centre = p.foot + glm::dvec3(0, half.y, 0);
    if (chance(random, 0.3))
        roundedBox(mesh, centre, half, 0.2 * std::min({ half.x, half.y, half.z }), 2, p.size, turn(p.degrees));
    else
        texturedBox(mesh, centre, half, p.size, turn(p.degrees));
}

void ball(ObjWriter& mesh, const Place& p, Random& random)
{
    const double radius = 0.5 * p.size * random.uniform(0.5, 1);
    sphere(mesh, p.foot + glm::dvec3(0, radius, 0), radius, 24, 32);
}

void vessel(ObjWriter& mesh, const Place& p, Random& random)
{
    std::vector<glm::dvec3> profile { { 0, 0, 0 }, { random.uniform(0.15, 0.35), 0, 0 } };
    const int points = whole(random, 2, 5);
    for (int i = 1; i <= points; ++i)
        profile.push_back({ random.uniform(0.06, 0.4), static_cast<double>(i) / points, 0 });
    for (int i = points; i >= 1; --i) // its inside
        profile.push_back({ std::max(0.03, profile[static_cast<std::size_t>(i) + 1].x - 0.03),
            static_cast<double>(i) / points - 0.02, 0 });
    profile.push_back({ 0, 0.1, 0 });
    texturedSkin(mesh, placed(turned(profile, 4, 28), standing(p.foot, p.degrees, p.size)), { 3, 3 });
}

void curl(ObjWriter& mesh, const Place& p, Random& random)
{
    const double turns = random.uniform(0.5, 3), wide = 0.4 * p.size, thick = p.size * random.uniform(0.01, 0.08);
    std::vector<glm::dvec3> line;
    std::vector<double> radii;
    for (int i = 0; i <= 60; ++i) {
        const double t = i / 60.0, angle = 2 * pi * turns * t + p.degrees;
        line.push_back(p.foot + glm::dvec3(wide * t * std::cos(angle), p.size * t, wide * t * std::sin(angle)));
        radii.push_back(thick * (1.0 - 0.8 * t));
    }
    tube(mesh, line, radii, 10);
}

void table(ObjWriter& mesh, const Place& p, Random& random)
{
    const glm::dmat3 axes = turn(p.degrees);
    const double high = p.size * random.uniform(0.5, 1), leg = p.size * random.uniform(0.01, 0.05);
    const glm::dvec3 half = 0.5 * p.size * glm::dvec3(random.uniform(0.6, 1.2), 0.05, random.uniform(0.5, 1));
    texturedBox(mesh, p.foot + glm::dvec3(0, high, 0), half, p.size, axes);
    for (const double x : { -1.0, 1.0 })
        for (const double z : { -1.0, 1.0 })
            box(mesh, p.foot + axes * glm::dvec3(x * (half.x - leg), 0.5 * high, z * (half.z - leg)),
                { leg, 0.5 * high, leg }, axes);
}

void fence(ObjWriter& mesh, const Place& p, Random& random)
{
    const glm::dmat3 axes = turn(p.degrees);
    const int bars = whole(random, 4, 20);
    const double step = p.size / bars, bar = step * random.uniform(0.1, 0.4);
    for (int i = 0; i < bars; ++i)
        box(mesh, p.foot + axes * glm::dvec3((i + 0.5) * step - 0.5 * p.size, 0.5 * p.size, 0),
            { bar, 0.5 * p.size, bar }, axes);
    for (const double y : { 0.2, 0.9 })
        box(mesh, p.foot + glm::dvec3(0, y * p.size, 0), { 0.5 * p.size, bar, 0.5 * bar }, axes);
}

void plant(ObjWriter& mesh, const Place& p, Random& random)
{
    const int leaves = whole(random, 8, 60);
    for (int i = 0; i < leaves; ++i) {
        const double t = random.uniform(0.2, 1), angle = random.uniform(0, 2 * pi);
        const glm::dvec3 along(std::cos(angle), random.uniform(-0.3, 0.8), std::sin(angle));
        leaf(mesh, frameAt(p.foot + glm::dvec3(0, t * p.size, 0), glm::normalize(along), { 0, 1, 0 }),
            p.size * random.uniform(0.2, 0.5), p.size * random.uniform(0.04, 0.15), random.uniform(0.1, 0.6), 5, 3);
    }
    tube(mesh, { p.foot, p.foot + glm::dvec3(0.02, p.size, 0.01) }, { 0.02 * p.size, 0.01 * p.size }, 6);
}

/// Triangles of any shape around a point: what scans and broken models look like.
void shards(ObjWriter& mesh, const Place& p, Random& random)
{
    const int count = whole(random, 20, 300);
    const glm::dvec3 centre = p.foot + glm::dvec3(0, 0.5 * p.size, 0);
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 at = centre + 0.5 * p.size * random.inBall();
        const double size = p.size * random.uniform(0.02, 0.25);
        const std::size_t a = mesh.vertex(at + size * random.inBall()), b = mesh.vertex(at + size * random.inBall());
        mesh.triangle(a, b, mesh.vertex(at + size * random.inBall()));
    }
}

/// A lump with bumps, smooth where the mesh is.
void rock(ObjWriter& mesh, const Place& p, Random& random)
{
    const glm::dvec3 wave = within(random, glm::dvec3(2), glm::dvec3(7)),
                     phase = within(random, glm::dvec3(0), glm::dvec3(2 * pi));
    const double bump = random.uniform(0.03, 0.25);
    const auto point = [&](double u, double v) {
        const double theta = pi * (1.0 - v), phi = 2 * pi * u;
        const glm::dvec3 out(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
        const double r = 1.0
            + bump * std::sin(wave.x * out.x + phase.x) * std::sin(wave.y * out.y + phase.y)
                * std::sin(wave.z * out.z + phase.z);
        return p.foot + 0.5 * p.size * (r * out + glm::dvec3(0, 0.9, 0));
    };
    sheet(mesh, 36, 24, point, { 3, 2 });
}

/// A board that leans.
void board(ObjWriter& mesh, const Place& p, Random& random)
{
    const double lean = random.uniform(-0.6, 0.6);
    const glm::dmat3 axes =
        turn(p.degrees) * glm::dmat3(1, 0, 0, 0, std::cos(lean), std::sin(lean), 0, -std::sin(lean), std::cos(lean));
    const double high = 0.5 * p.size * random.uniform(0.5, 1);
    texturedBox(mesh, p.foot + glm::dvec3(0, high, 0), { 0.5 * p.size, high, 0.01 * p.size }, p.size, axes);
}

using Maker = void (*)(ObjWriter&, const Place&, Random&);
constexpr Maker makers[] = { crate, ball, vessel, curl, table, fence, plant, shards, rock, board };

/// On the ground, in the air, or half sunk; away from the camera.
Place placeFor(const LotteryScene& s, Random& random)
{
    const glm::dvec3 eye(s.scene.camera.eye), extent = s.stage.hi - s.stage.lo;
    Place p {};
    for (int tries = 0; tries < 20; ++tries) {
        p.size = s.stage.size * logarithmic(random, 0.12, 0.6);
        p.degrees = random.uniform(0, 360);
        p.foot = s.stage.lo + extent * within(random, { 0.1, 0, 0.1 }, { 0.9, 1, 0.9 });
        const double where = random.uniform(0, 1);
        p.foot.y = where < 0.8 ? 0.0 : where < 0.9 ? -0.3 * p.size : std::min(p.foot.y, 0.6 * s.stage.hi.y);
        if (glm::distance(p.foot + glm::dvec3(0, 0.5 * p.size, 0), eye) > p.size + 0.1 * s.stage.size)
            break;
        p.size = 0.0; // in the way
    }
    return p;
}

} // namespace

void placeThings(LotteryScene& s, Random random, Random motion)
{
    const int moving = s.traits.motion ? whole(motion, 1, 2) : 0;
    for (int i = 0; i < s.traits.things; ++i) {
        const Place place = placeFor(s, random);
        const Maker make = makers[static_cast<std::size_t>(whole(random, 0, static_cast<int>(std::size(makers)) - 1))];
        const std::string& material = oneOf(random, s.materials);
        if (place.size <= 0.0)
            continue;
        if (i >= moving) {
            begin(s, s.scene.mesh, "thing", material);
            make(s.scene.mesh, place, random);
            continue;
        }
        MovingPart part;
        part.name = fmt::format("moving{}", i);
        begin(s, part.mesh, "moving", material);
        make(part.mesh, { { 0, 0, 0 }, place.size, place.degrees }, random);
        const glm::dvec3 way = place.size * motion.uniform(0.05, 0.5) * direction(motion);
        const auto turned = static_cast<float>(motion.uniform(-15, 15));
        part.keys = { { 0.0, { 0, 1, 0, 0 }, glm::vec3(place.foot) },
            { 1.0, { 0, 1, 0, turned }, glm::vec3(place.foot + way) } };
        s.scene.parts.push_back(std::move(part));
        s.scene.shutterClose = 1.0;
    }
}

} // namespace wedge::generator
