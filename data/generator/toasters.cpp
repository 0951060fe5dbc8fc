#include "data/generator/light_level.h"
#include "data/generator/patterns.h"
#include "data/generator/scene_writer.h"
#include "data/generator/textured.h"

#include <string>

namespace wedge::generator {
namespace {

/// A toaster that stands at `foot`, 0.32 long and 0.22 high, with a slice of bread in either or both of its slots.
void toaster(
    ObjWriter& mesh, const char* name, const char* material, const glm::dvec3& foot, double degrees, int slices)
{
    const glm::dmat3 axes = turn(degrees);
    const auto at = [&](const glm::dvec3& p) { return foot + axes * p; };
    mesh.object(name, material);
    roundedBox(mesh, at({ 0, 0.12, 0 }), { 0.16, 0.1, 0.09 }, 0.045, 3, 0.25, axes);
    mesh.object(name + std::string("_fittings"), "black");
    texturedBox(mesh, at({ 0, 0.012, 0 }), { 0.13, 0.012, 0.065 }, 0.1, axes);
    for (const double z : { -0.024, 0.024 })
        texturedBox(mesh, at({ 0, 0.2202, z }), { 0.1, 0.001, 0.013 }, 0.1, axes);
    texturedBox(mesh, at({ 0.175, 0.15, 0 }), { 0.018, 0.008, 0.025 }, 0.1, axes);
    const glm::dmat4 knob = standing(at({ 0.159, 0.07, 0.03 }), degrees)
        * glm::dmat4(0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1); // its axis along the toaster
    texturedSkin(mesh,
        placed(
            turned({ { 0, 0, 0 }, { 0.018, 0, 0 }, { 0.016, 0.015, 0 }, { 0.012, 0.018, 0 }, { 0, 0.018, 0 } }, 1, 12),
            knob),
        { 1, 1 });
    mesh.object(name + std::string("_bread"), "bread");
    for (int i = 0; i < slices; ++i)
        roundedBox(
            mesh, at({ 0.004 - 0.01 * i, 0.225, -0.024 + 0.048 * i }), { 0.062, 0.055, 0.009 }, 0.0085, 1, 0.12, axes);
}

} // namespace

GeneratedScene makeToasters()
{
    GeneratedScene s;
    s.name = "toasters";
    s.comment = "Toasters on a tiled counter before a patterned wall; the middle one is in focus";
    const auto metal = [&](const char* name, const glm::dvec3& colour, unsigned seed) {
        s.materials.push_back(textured(s, name, brushed(colour, seed), glm::vec3(0.6f), 0.35f, 45.0f));
    };
    metal("steel", { 0.75, 0.76, 0.8 }, 51);
    metal("red", { 0.75, 0.1, 0.06 }, 52);
    metal("teal", { 0.1, 0.5, 0.5 }, 53);
    s.materials.push_back(glossy("black", glm::vec3(0.03f), 0.15f, 30.0f));
    s.materials.push_back(
        textured(s, "bread", speckled({ 0.75, 0.5, 0.25 }, { 0.35, 0.18, 0.06 }, 32, 54), glm::vec3(0.9f)));
    s.materials.push_back(textured(
        s, "counter", tiles({ 0.75, 0.72, 0.66 }, { 0.15, 0.15, 0.16 }, 10, 55), glm::vec3(0.8f), 0.15f, 60.0f));
    s.materials.push_back(textured(
        s, "wall", wallpaper({ 0.75, 0.72, 0.55 }, { 0.1, 0.3, 0.5 }, { 0.7, 0.35, 0.05 }, 10), glm::vec3(0.9f)));
    s.mesh.object("counter", "counter");
    rectangle(s.mesh, { -1.6, 0, 0.9 }, { 3.2, 0, 0 }, { 0, 0, -1.8 }, { 6, 3.375 });
    s.mesh.object("wall", "wall");
    rectangle(s.mesh, { -1.6, 0, -0.9 }, { 3.2, 0, 0 }, { 0, 1.6, 0 }, { 3, 1.5 });
    toaster(s.mesh, "near", "red", { -0.3, 0, 0.36 }, -28, 1);
    toaster(s.mesh, "middle", "steel", { 0.06, 0, 0.0 }, 20, 2);
    toaster(s.mesh, "far", "teal", { 0.42, 0, -0.5 }, -15, 1);
    s.camera.eye = { 0.05f, 0.5f, 1.15f };
    s.camera.lookAt = { 0.0f, 0.13f, 0.0f };
    s.camera.verticalFov = 40.0f;
    s.camera.focusDistance = 1.2f;
    s.camera.apertureRadius = 0.045f;
    s.light = gaussianLight({ -1.0f, 1.7f, 1.0f }, { 0.0f, 0.1f, 0.0f }, 0.3f);
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0 }, { 0, 1, 0 }, 0.5, 0.6));
    s.background = glm::vec3(0.1f);
    s.bounces = 1;
    return s;
}

} // namespace wedge::generator
