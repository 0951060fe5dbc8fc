#include "data/generator/cornell.h"

#include <glm/gtc/matrix_transform.hpp>

#include "data/generator/light_level.h"
#include "data/generator/shapes.h"
#include "data/generator/skin.h"

namespace wedge::generator {
namespace {

constexpr int sides = 49; ///< of the bodies

/// A rectangle whose front is where its corners go counter-clockwise.
void wall(ObjWriter& mesh, const char* name, const char* material, const glm::dvec3 (&p)[4])
{
    mesh.object(name, material);
    std::size_t corners[4];
    for (int i = 0; i < 4; ++i)
        corners[i] = mesh.vertex(p[i]);
    mesh.quad(corners[0], corners[1], corners[2], corners[3]);
}

glm::dmat4 at(const glm::dvec3& place, double turn, double scale)
{
    const glm::dmat4 moved =
        glm::rotate(glm::translate(glm::dmat4(1.0), place), glm::radians(turn), glm::dvec3(0, 1, 0));
    return glm::scale(moved, glm::dvec3(scale));
}

/// A hollow vase, 1 high.
void vase(ObjWriter& mesh, const glm::dmat4& map)
{
    const std::vector<glm::dvec3> profile { { 0, 0, 0 }, { 0.1, 0, 0 }, { 0.19, 0.003, 0 }, { 0.205, 0.02, 0 },
        { 0.17, 0.05, 0 }, { 0.2, 0.12, 0 }, { 0.285, 0.27, 0 }, { 0.315, 0.43, 0 }, { 0.26, 0.6, 0 },
        { 0.155, 0.74, 0 }, { 0.11, 0.84, 0 }, { 0.135, 0.93, 0 }, { 0.195, 0.985, 0 }, { 0.205, 0.998, 0 },
        { 0.195, 1, 0 }, { 0.12, 0.93, 0 }, { 0.092, 0.84, 0 }, { 0.137, 0.73, 0 }, { 0.242, 0.59, 0 },
        { 0.295, 0.43, 0 }, { 0.265, 0.27, 0 }, { 0.18, 0.12, 0 }, { 0.09, 0.06, 0 }, { 0, 0.05, 0 } };
    skin(mesh, placed(turned(profile, 2, sides), map));
}

/// The spout: out along its line, over the lip, and back inside down to a bottom.
void spout(ObjWriter& mesh, const glm::dmat4& map)
{
    constexpr int around = 24;
    const std::vector<glm::dvec4> control { { 0.7, 0.42, 0, 0.25 }, { 0.98, 0.5, 0, 0.21 }, { 1.24, 0.72, 0, 0.145 },
        { 1.42, 0.98, 0, 0.105 }, { 1.66, 1.14, 0, 0.1 } };
    const std::vector<glm::dvec4> curve = curveThrough(control, 5);
    const std::vector<Frame> frames = framesOn({ curve.begin(), curve.end() }, { 0, 0, 1 });
    std::vector<Ring> rings;
    for (std::size_t k = 0; k < frames.size(); ++k)
        rings.push_back(ringAround(frames[k], around, curve[k].w));
    Frame lip = frames.back();
    lip.at += 0.012 * lip.along;
    rings.push_back(ringAround(lip, around, curve.back().w - 0.012));
    for (std::size_t k = frames.size(); k-- > frames.size() - 10;)
        rings.push_back(ringAround(frames[k], around, curve[k].w - 0.024));
    rings.push_back(ringAround(frames[frames.size() - 10], around, 0.0));
    skin(mesh, placed(rings, map));
}

/// A teapot with its lid on: the body's radius is 1, its spout points to +x.
void teapot(ObjWriter& mesh, const glm::dmat4& map)
{
    const std::vector<glm::dvec3> profile { { 0, 0, 0 }, { 0.5, 0, 0 }, { 0.6, 0.01, 0 }, { 0.61, 0.05, 0 },
        { 0.62, 0.1, 0 }, { 0.86, 0.28, 0 }, { 1, 0.6, 0 }, { 0.93, 0.92, 0 }, { 0.74, 1.14, 0 }, { 0.7, 1.2, 0 },
        { 0.67, 1.21, 0 }, { 0.655, 1.19, 0 }, { 0.63, 1.2, 0 }, { 0.45, 1.3, 0 }, { 0.2, 1.37, 0 }, { 0.09, 1.42, 0 },
        { 0.1, 1.48, 0 }, { 0.16, 1.55, 0 }, { 0.13, 1.62, 0 }, { 0, 1.65, 0 } };
    skin(mesh, placed(turned(profile, 2, sides), map));
    spout(mesh, map);
    const std::vector<glm::dvec3> grip { { -0.78, 1.02, 0 }, { -1.1, 1.1, 0 }, { -1.4, 1.02, 0 }, { -1.48, 0.78, 0 },
        { -1.3, 0.52, 0 }, { -0.86, 0.34, 0 } };
    std::vector<Ring> rings;
    for (const Frame& frame : framesOn(curveThrough(grip, 6), { 0, 0, 1 }))
        rings.push_back(ringAround(frame, 16, 0.085));
    skin(mesh, placed(rings, map));
}

} // namespace

GeneratedScene cornellBox(const std::string& name, const std::string& comment)
{
    constexpr double x = 1.12, y = 1.68, z = 1.0;
    GeneratedScene s;
    s.name = name;
    s.comment = comment;
    s.materials = { matt("white", glm::vec3(0.76f, 0.75f, 0.72f)), matt("red", glm::vec3(0.63f, 0.07f, 0.05f)),
        matt("green", glm::vec3(0.14f, 0.46f, 0.09f)) };
    wall(s.mesh, "floor", "white", { { -x, 0, z }, { x, 0, z }, { x, 0, -z }, { -x, 0, -z } });
    wall(s.mesh, "ceiling", "white", { { -x, y, -z }, { x, y, -z }, { x, y, z }, { -x, y, z } });
    wall(s.mesh, "back", "white", { { -x, 0, -z }, { x, 0, -z }, { x, y, -z }, { -x, y, -z } });
    wall(s.mesh, "left", "red", { { -x, 0, z }, { -x, 0, -z }, { -x, y, -z }, { -x, y, z } });
    wall(s.mesh, "right", "green", { { x, 0, -z }, { x, 0, z }, { x, y, z }, { x, y, -z } });
    s.background = glm::vec3(0.0f);
    s.camera.eye = { 0.0f, 0.84f, 3.6f };
    s.camera.lookAt = { 0.0f, 0.84f, 0.0f };
    s.camera.verticalFov = 37.0f;
    s.light.centre = { 0.0f, 1.65f, 0.2f };
    s.light.halfU = { 0.25f, 0.0f, 0.0f };
    s.light.halfV = { 0.0f, 0.0f, 0.25f }; // cross(halfU, halfV) looks down
    s.light.profile = scene::LightProfile::Uniform;
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0.2 }, { 0, 1, 0 }, 0.75, 0.58));
    return s;
}

GeneratedScene makeCornellGlossy()
{
    GeneratedScene s = cornellBox("cornell_glossy", "A Cornell box with a glossy vase and two glossy teapots");
    s.materials.push_back(matt("block", glm::vec3(0.72f, 0.68f, 0.6f)));
    s.materials.push_back(glossy("blue_glaze", glm::vec3(0.13f, 0.24f, 0.45f), 0.4f, 12.0f));
    s.materials.push_back(glossy("amber_glaze", glm::vec3(0.5f, 0.26f, 0.08f), 0.38f, 12.0f));
    s.materials.push_back(glossy("pale_glaze", glm::vec3(0.45f, 0.45f, 0.42f), 0.42f, 12.0f));
    s.mesh.object("block", "block"); // it goes into the floor, so that no faces coincide
    box(s.mesh, { -0.46, 0.2, -0.35 }, { 0.34, 0.21, 0.28 },
        glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(18.0), glm::dvec3(0, 1, 0))));
    s.mesh.object("vase", "blue_glaze");
    vase(s.mesh, at({ 0.55, -0.001, -0.42 }, 0, 0.88));
    s.mesh.object("teapot1", "amber_glaze");
    teapot(s.mesh, at({ -0.46, 0.409, -0.35 }, 25, 0.23));
    s.mesh.object("teapot2", "pale_glaze");
    teapot(s.mesh, at({ 0.2, -0.001, 0.32 }, 205, 0.24));
    return s;
}

} // namespace wedge::generator
