#include "data/generator/light_level.h"
#include "data/generator/patterns.h"
#include "data/generator/scene_writer.h"
#include "data/generator/textured.h"

#include <cmath>
#include <numbers>

#include "data/generator/shapes.h"

namespace wedge::generator {
namespace {

constexpr double x = 1.12, y = 1.68, z = 1.0; // half width, height and half depth of the box, m

void walls(ObjWriter& mesh)
{
    const auto wall = [&](const char* name, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v,
                          const glm::dvec2& repeats) {
        mesh.object(name, name);
        rectangle(mesh, corner, u, v, repeats);
    };
    wall("floor", { -x, 0, z }, { 2 * x, 0, 0 }, { 0, 0, -2 * z }, { 2, 2 });
    wall("ceiling", { -x, y, -z }, { 2 * x, 0, 0 }, { 0, 0, 2 * z }, { 1, 1 });
    wall("back", { -x, 0, -z }, { 2 * x, 0, 0 }, { 0, y, 0 }, { 2, 1.5 });
    wall("left", { -x, 0, z }, { 0, 0, -2 * z }, { 0, y, 0 }, { 1.5, 1.25 });
    wall("right", { x, 0, -z }, { 0, 0, 2 * z }, { 0, y, 0 }, { 2, 1.5 });
}

/// A vase around the origin, 0.5 high: its middle is where it turns.
void vase(ObjWriter& mesh)
{
    const std::vector<glm::dvec3> profile { { 0, -0.25, 0 }, { 0.07, -0.25, 0 }, { 0.085, -0.24, 0 },
        { 0.075, -0.215, 0 }, { 0.13, -0.12, 0 }, { 0.155, -0.02, 0 }, { 0.125, 0.08, 0 }, { 0.065, 0.15, 0 },
        { 0.055, 0.19, 0 }, { 0.095, 0.245, 0 }, { 0.09, 0.25, 0 }, { 0.05, 0.2, 0 }, { 0.05, 0.15, 0 },
        { 0.11, 0.08, 0 }, { 0.1, -0.05, 0 }, { 0, -0.1, 0 } };
    mesh.object("vase", "vase");
    texturedSkin(mesh, turned(profile, 3, 40), { 3, 3 });
}

MovingPart flyingVase()
{
    MovingPart part;
    part.name = "vase";
    vase(part.mesh);
    const glm::vec3 from(-0.52f, 0.95f, -0.6f);
    part.keys = { { 0.0, { 0, 0, 1, 14 }, from }, { 1.0, { 0, 0, 1, -2 }, from + glm::vec3(0.13f, 0.06f, 0.0f) } };
    return part;
}

/// A board just above the floor that glides to the right.
MovingPart glidingBoard()
{
    MovingPart part;
    part.name = "board";
    part.mesh.object("board", "board");
    texturedBox(part.mesh, { 0, 0, 0 }, { 0.42, 0.015, 0.3 }, 0.3);
    const glm::vec3 from(-0.22f, 0.22f, 0.3f);
    part.keys = { { 0.0, { 0, 1, 0, 12 }, from }, { 1.0, { 0, 1, 0, 12 }, from + glm::vec3(0.14f, 0.0f, 0.0f) } };
    return part;
}

/// A flag at a pole, at a phase of its wave; it is fixed at the pole, where u is 0.
ObjWriter flag(double phase)
{
    ObjWriter mesh;
    mesh.object("flag", "flag");
    const auto point = [=](double u, double v) {
        const double wave = std::sin(2.0 * std::numbers::pi * (1.2 * u + 0.15 * v) - phase);
        return glm::dvec3(0.9 - 0.56 * u, 0.95 + 0.4 * v - 0.06 * u * u + 0.06 * u * wave, -0.35 + 0.09 * u * wave);
    };
    sheet(mesh, 48, 24, point, { -1.5, 1 });
    return mesh;
}

MovingPart wavingFlag()
{
    MovingPart part;
    part.name = "flag";
    part.shapes = { { 0.0, flag(0.0) }, { 1.0, flag(1.4) } };
    return part;
}

void addMaterials(GeneratedScene& s)
{
    const auto add = [&](const char* name, image::RgbImage image, float tint, float specular, float exponent) {
        s.materials.push_back(textured(s, name, std::move(image), glm::vec3(tint), specular, exponent));
    };
    add("floor", tiles({ 0.8, 0.74, 0.62 }, { 0.12, 0.1, 0.08 }, 8, 21), 0.85f, 0.1f, 30.0f);
    add("back", wallpaper({ 0.7, 0.68, 0.6 }, { 0.12, 0.2, 0.42 }, { 0.6, 0.3, 0.1 }, 12), 0.9f, 0.0f, 1.0f);
    add("left", bricks({ 0.6, 0.13, 0.07 }, { 0.6, 0.56, 0.5 }, 16, 22), 0.9f, 0.0f, 1.0f);
    add("right", checkedCloth({ 0.5, 0.7, 0.35 }, { 0.08, 0.3, 0.06 }, 20), 0.9f, 0.0f, 1.0f);
    add("board", checkedCloth({ 0.9, 0.85, 0.7 }, { 0.7, 0.1, 0.05 }, 8), 0.9f, 0.0f, 1.0f);
    add("vase", wallpaper({ 0.85, 0.83, 0.78 }, { 0.06, 0.12, 0.45 }, { 0.1, 0.2, 0.6 }, 5), 0.65f, 0.3f, 30.0f);
    add("flag", wallpaper({ 0.75, 0.6, 0.1 }, { 0.6, 0.05, 0.05 }, { 0.05, 0.1, 0.4 }, 6), 0.9f, 0.0f, 1.0f);
    add("ball", speckled({ 0.45, 0.65, 0.8 }, { 0.9, 0.9, 0.85 }, 48, 23), 0.7f, 0.25f, 40.0f);
    s.materials.push_back(matt("ceiling", glm::vec3(0.76f, 0.75f, 0.72f)));
    s.materials.push_back(glossy("pole", glm::vec3(0.4f, 0.38f, 0.35f), 0.4f, 40.0f));
}

} // namespace

GeneratedScene makeMovingCornell()
{
    GeneratedScene s;
    s.name = "moving_cornell";
    s.comment = "A Cornell box with a gliding board under a ball at rest, a flying vase and a waving flag";
    addMaterials(s);
    walls(s.mesh);
    s.mesh.object("ball", "ball");
    const glm::dmat4 place = standing({ -0.1, 0.63, 0.3 });
    const std::vector<glm::dvec3> arc { { 0, -0.17, 0 }, { 0.065, -0.157, 0 }, { 0.12, -0.12, 0 }, { 0.157, -0.065, 0 },
        { 0.17, 0, 0 }, { 0.157, 0.065, 0 }, { 0.12, 0.12, 0 }, { 0.065, 0.157, 0 }, { 0, 0.17, 0 } };
    texturedSkin(s.mesh, placed(turned(arc, 4, 56), place), { 2, 1 });
    s.mesh.object("pole", "pole");
    tube(s.mesh, { { 0.91, 0, -0.35 }, { 0.91, 0.7, -0.35 }, { 0.91, 1.42, -0.35 } }, { 0.014, 0.014, 0.01 }, 16);
    s.parts = { flyingVase(), glidingBoard(), wavingFlag() };
    s.shutterClose = 1.0;
    s.camera.eye = { 0.0f, 0.84f, 3.6f };
    s.camera.lookAt = { 0.0f, 0.84f, 0.0f };
    s.camera.verticalFov = 37.0f;
    s.light.centre = { 0.0f, 1.65f, 0.25f };
    s.light.halfU = { 0.2f, 0.0f, 0.0f };
    s.light.halfV = { 0.0f, 0.0f, 0.2f }; // cross(halfU, halfV) looks down
    s.light.profile = scene::LightProfile::Uniform;
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0.2 }, { 0, 1, 0 }, 0.5, 0.85));
    s.background = glm::vec3(0.0f);
    s.bounces = 1;
    return s;
}

GeneratedScene makeMovingLens()
{
    GeneratedScene s = makeMovingCornell();
    s.name = "moving_lens";
    s.comment += ", through a lens that is in focus on the ball";
    s.camera.focusDistance = 3.3f;
    s.camera.apertureRadius = 0.18f;
    return s;
}

} // namespace wedge::generator
