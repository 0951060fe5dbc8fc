#include "data/generator/light_level.h"
#include "data/generator/patterns.h"
#include "data/generator/scene_writer.h"
#include "data/generator/shapes.h"
#include "data/generator/textured.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace wedge::generator {
namespace {

constexpr double pi = std::numbers::pi;

/// A cloth that lies on the table and hangs down in front, with folds where nothing stands on it.
void cloth(ObjWriter& mesh)
{
    constexpr double edge = 0.42, rounding = 0.03; // where the table ends
    const auto point = [](double u, double v) {
        const double x = -0.62 + 1.24 * u, along = 0.95 * v - 0.4; // metres, from the back
        const double free = glm::smoothstep(0.2, 0.5, std::hypot(x, 0.8 * along));
        const double fold = std::sin(19 * x + 5 * std::sin(3 * along)) + 0.6 * std::sin(31 * x - 9 * along);
        const double lift = 0.003 + 0.012 * free * (1.6 + fold);
        if (along < edge)
            return glm::dvec3(x, lift, along);
        const double angle = std::min((along - edge) / rounding, pi / 2);
        const double drop = std::max(along - edge - rounding * pi / 2, 0.0);
        const glm::dvec3 out(0, std::cos(angle), std::sin(angle));
        return glm::dvec3(x, -rounding - drop, edge) + (rounding + lift + 0.15 * drop * (1 + 0.3 * fold)) * out;
    };
    mesh.object("cloth", "cloth");
    sheet(mesh, 140, 110, [&](double u, double v) { return point(u, 1.0 - v); }, { 4, 3 });
}

void tableAndWall(ObjWriter& mesh)
{
    mesh.object("table", "table");
    texturedBox(mesh, { 0, -0.03, -0.12 }, { 1.3, 0.0295, 0.54 }, 0.6);
    mesh.object("wall", "wall");
    rectangle(mesh, { -1.8, -0.6, -0.9 }, { 3.6, 0, 0 }, { 0, 2.0, 0 }, { 7.2, 4 });
}

void bowl(ObjWriter& mesh)
{
    mesh.object("bowl", "bowl");
    const std::vector<glm::dvec3> profile { { 0, 0.004, 0 }, { 0.06, 0.004, 0 }, { 0.065, 0.012, 0 },
        { 0.05, 0.025, 0 }, { 0.09, 0.045, 0 }, { 0.135, 0.085, 0 }, { 0.16, 0.125, 0 }, { 0.167, 0.128, 0 },
        { 0.165, 0.1315, 0 }, { 0.1605, 0.1315, 0 }, { 0.1565, 0.127, 0 }, { 0.125, 0.085, 0 }, { 0.07, 0.05, 0 },
        { 0, 0.042, 0 } };
    texturedSkin(mesh, placed(turned(profile, 4, 90), standing({ 0, 0, 0 })), { 6, 2 });
}

/// A fruit of that radius, tilted; squash: its height by its width, dent: how deep its ends are.
void fruit(ObjWriter& mesh, const char* name, const char* material, const glm::dvec3& centre, double radius,
    double squash, double dent, Random& random)
{
    std::vector<glm::dvec3> profile;
    for (int k = 0; k <= 14; ++k) {
        const double angle = pi * k / 14, pole = std::pow(std::cos(angle), 8.0);
        profile.push_back({ k % 14 == 0 ? 0.0 : std::sin(angle), -squash * std::cos(angle) * (1.0 - dent * pole), 0 });
    }
    const double lobes = random.uniform(0, 2 * pi);
    std::vector<Ring> rings = turned(profile, 3, 64);
    for (Ring& ring : rings) { // a little uneven
        for (glm::dvec3& p : ring)
            p *= 1.0 + 0.02 * std::sin(5 * std::atan2(p.x, p.z) + lobes) * std::hypot(p.x, p.z);
    }
    glm::dmat4 map = glm::translate(glm::dmat4(1.0), centre);
    map = glm::rotate(map, random.uniform(0, 2 * pi), glm::dvec3(0, 1, 0));
    map = glm::scale(glm::rotate(map, random.uniform(-0.5, 0.5), glm::dvec3(1, 0, 0)), glm::dvec3(radius));
    mesh.object(name, material);
    texturedSkin(mesh, placed(rings, map), { 2, 1 });
    mesh.object(name + std::string("_stalk"), "stalk");
    const std::vector<glm::dvec3> line { { 0, squash * (1.0 - dent) - 0.02, 0 }, { 0.03, squash + 0.1, 0.02 },
        { 0.12, squash + 0.28, 0.05 } };
    std::vector<glm::dvec3> bent;
    for (const glm::dvec3& p : curveThrough(line, 4))
        bent.push_back(glm::dvec3(map * glm::dvec4(p, 1.0)));
    tube(mesh, bent, std::vector<double>(bent.size(), 0.05 * radius), 8);
}

void fruits(ObjWriter& mesh, Random& random)
{
    struct Kind {
        const char *name, *material;
        glm::dvec3 centre;
        double radius, squash, dent;
    };
    const Kind all[] = { { "apple1", "apple", { -0.07, 0.115, 0.04 }, 0.048, 0.9, 0.25 },
        { "apple2", "apple", { 0.085, 0.125, -0.035 }, 0.046, 0.92, 0.25 },
        { "apple3", "green_apple", { 0.0, 0.175, 0.0 }, 0.047, 0.9, 0.25 },
        { "orange1", "orange", { 0.03, 0.11, 0.07 }, 0.045, 0.97, 0.05 },
        { "orange2", "orange", { -0.05, 0.12, -0.06 }, 0.046, 0.96, 0.05 },
        { "orange3", "orange", { -0.25, 0.049, 0.16 }, 0.045, 0.97, 0.05 },
        { "apple4", "apple", { 0.12, 0.048, 0.29 }, 0.045, 0.92, 0.25 },
        { "apple5", "green_apple", { -0.34, 0.052, 0.05 }, 0.045, 0.92, 0.25 },
        { "pear", "green_apple", { 0.3, 0.066, -0.1 }, 0.05, 1.2, 0.1 } };
    for (const Kind& k : all)
        fruit(mesh, k.name, k.material, k.centre, k.radius, k.squash, k.dent, random);
}

void bottle(ObjWriter& mesh, const char* name, const char* material, const glm::dvec3& foot, double scale)
{
    mesh.object(name, material);
    const std::vector<glm::dvec3> profile { { 0, 0, 0 }, { 0.034, 0, 0 }, { 0.039, 0.005, 0 }, { 0.04, 0.03, 0 },
        { 0.04, 0.1, 0 }, { 0.04, 0.165, 0 }, { 0.036, 0.185, 0 }, { 0.022, 0.21, 0 }, { 0.014, 0.235, 0 },
        { 0.0135, 0.28, 0 }, { 0.017, 0.284, 0 }, { 0.017, 0.298, 0 }, { 0.013, 0.301, 0 }, { 0, 0.301, 0 } };
    texturedSkin(mesh, placed(turned(profile, 4, 60), standing(foot, 0, scale)), { 2, 2 });
}

void grapes(ObjWriter& mesh, Random& random)
{
    mesh.object("grapes", "grape");
    std::vector<glm::dvec3> places;
    while (places.size() < 46) { // a heap of grapes that do not overlap much
        const glm::dvec3 p(random.uniform(-0.075, 0.075), 0.0, random.uniform(-0.05, 0.05));
        glm::dvec3 at(0.26 + p.x, 0.017, 0.2 + p.z);
        for (const glm::dvec3& other : places) {
            const double flat = std::hypot(at.x - other.x, at.z - other.z);
            if (flat < 0.025)
                at.y = std::max(at.y, other.y + std::sqrt(0.025 * 0.025 - flat * flat));
        }
        if (at.y < 0.075)
            places.push_back(at);
    }
    for (const glm::dvec3& p : places) {
        std::vector<glm::dvec3> profile;
        for (int k = 0; k <= 10; ++k)
            profile.push_back({ k % 10 == 0 ? 0.0 : std::sin(pi * k / 10), -1.1 * std::cos(pi * k / 10), 0 });
        texturedSkin(mesh, placed(turned(profile, 1, 18), standing(p, random.uniform(0, 360), 0.0145)), { 1, 1 });
    }
}

void leaves(ObjWriter& mesh, Random& random)
{
    mesh.object("leaves", "leaf");
    const auto cluster = [&](const glm::dvec3& at, int count, double length) {
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * pi * i / count + random.uniform(-0.3, 0.3);
            const glm::dvec3 along(std::cos(angle), random.uniform(-0.05, 0.5), std::sin(angle));
            leaf(mesh, frameAt(at, along, { 0, 1, 0 }), length * random.uniform(0.8, 1.2), 0.55 * length,
                random.uniform(0.2, 0.4), 16, 10);
        }
    };
    cluster({ 0.26, 0.075, 0.2 }, 6, 0.07);
    cluster({ -0.24, 0.094, 0.16 }, 3, 0.05);
    cluster({ 0.0, 0.217, 0.0 }, 4, 0.06);
    cluster({ -0.08, 0.012, 0.31 }, 5, 0.07);
    cluster({ 0.42, 0.02, 0.05 }, 6, 0.08);
    cluster({ -0.45, 0.02, 0.2 }, 6, 0.08);
}

void addMaterials(GeneratedScene& s)
{
    const auto add = [&](const char* name, image::RgbImage image, float tint, float specular = 0.0f,
                         float exponent = 1.0f) {
        s.materials.push_back(textured(s, name, std::move(image), glm::vec3(tint), specular, exponent));
    };
    add("cloth", checkedCloth({ 0.85, 0.82, 0.75 }, { 0.55, 0.08, 0.08 }, 10), 0.9f);
    add("table", wood({ 0.5, 0.3, 0.15 }, { 0.22, 0.1, 0.04 }, 5, 61), 0.8f, 0.1f, 30.0f);
    add("wall", wallpaper({ 0.45, 0.52, 0.45 }, { 0.75, 0.7, 0.5 }, { 0.25, 0.12, 0.1 }, 8), 0.9f);
    add("bowl", wallpaper({ 0.85, 0.84, 0.8 }, { 0.08, 0.16, 0.5 }, { 0.1, 0.3, 0.6 }, 4), 0.65f, 0.25f, 60.0f);
    add("apple", speckled({ 0.7, 0.1, 0.06 }, { 0.85, 0.65, 0.25 }, 64, 62), 0.75f, 0.2f, 40.0f);
    add("green_apple", speckled({ 0.45, 0.6, 0.12 }, { 0.8, 0.8, 0.45 }, 56, 63), 0.75f, 0.2f, 40.0f);
    add("orange", speckled({ 0.9, 0.42, 0.05 }, { 0.65, 0.25, 0.02 }, 96, 64), 0.75f, 0.15f, 20.0f);
    add("grape", speckled({ 0.3, 0.08, 0.3 }, { 0.5, 0.3, 0.55 }, 24, 65), 0.7f, 0.25f, 50.0f);
    add("leaf", veined({ 0.16, 0.4, 0.1 }, { 0.5, 0.65, 0.3 }), 0.85f, 0.1f, 20.0f);
    add("green_bottle", wallpaper({ 0.06, 0.3, 0.14 }, { 0.8, 0.75, 0.5 }, { 0.1, 0.4, 0.2 }, 6), 0.6f, 0.35f, 80.0f);
    add("brown_bottle", bricks({ 0.45, 0.2, 0.06 }, { 0.75, 0.6, 0.35 }, 16, 66), 0.6f, 0.35f, 80.0f);
    s.materials.push_back(matt("stalk", glm::vec3(0.2f, 0.12f, 0.06f)));
}

} // namespace

GeneratedScene makeStillLife()
{
    GeneratedScene s;
    s.name = "still_life";
    s.comment = "Fruit, bottles and a cloth on a table before a papered wall that is out of focus";
    addMaterials(s);
    Random random(128);
    tableAndWall(s.mesh);
    cloth(s.mesh);
    bowl(s.mesh);
    fruits(s.mesh, random);
    bottle(s.mesh, "bottle1", "green_bottle", { -0.2, 0, -0.16 }, 1.15);
    bottle(s.mesh, "bottle2", "brown_bottle", { -0.32, 0, -0.24 }, 0.95);
    bottle(s.mesh, "bottle3", "green_bottle", { 0.2, 0, -0.3 }, 1.3);
    grapes(s.mesh, random);
    leaves(s.mesh, random);
    s.camera.eye = { 0.06f, 0.4f, 1.0f };
    s.camera.lookAt = { 0.0f, 0.1f, 0.0f };
    s.camera.verticalFov = 36.0f;
    s.camera.focusDistance = 1.0f;
    s.camera.apertureRadius = 0.04f;
    s.light = gaussianLight({ 0.9f, 1.3f, 0.7f }, { 0.0f, 0.1f, 0.0f }, 0.28f);
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0 }, { 0, 1, 0 }, 0.5, 0.6));
    s.background = glm::vec3(0.1f);
    s.bounces = 1;
    return s;
}

} // namespace wedge::generator
