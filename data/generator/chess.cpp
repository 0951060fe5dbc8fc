#include "data/generator/light_level.h"
#include "data/generator/patterns.h"
#include "data/generator/scene_writer.h"
#include "data/generator/textured.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace wedge::generator {
namespace {

constexpr double square = 0.055; // m
constexpr double unit = 0.021; // m: profiles have feet of a radius of about 1
constexpr int sides = 18;
using Profile = std::vector<glm::dvec3>;

/// The foot that all pieces share, up to where their bodies begin, and then the rest.
Profile withFoot(const Profile& rest)
{
    Profile all { { 0, 0, 0 }, { 0.95, 0, 0 }, { 1.05, 0.07, 0 }, { 1.05, 0.26, 0 }, { 0.88, 0.36, 0 } };
    all.insert(all.end(), rest.begin(), rest.end());
    return all;
}

void piece(ObjWriter& mesh, const glm::dmat4& map, const Profile& profile, int steps)
{
    texturedSkin(mesh, placed(turned(profile, steps, sides), map), { 2, 2 });
}

void pawn(ObjWriter& mesh, const glm::dmat4& map)
{
    piece(mesh, map,
        withFoot({ { 0.62, 0.44, 0 }, { 0.43, 0.75, 0 }, { 0.33, 1.2, 0 }, { 0.35, 1.36, 0 }, { 0.6, 1.42, 0 },
            { 0.59, 1.5, 0 }, { 0.32, 1.57, 0 }, { 0.43, 1.73, 0 }, { 0.5, 1.95, 0 }, { 0.42, 2.2, 0 },
            { 0.22, 2.36, 0 }, { 0, 2.41, 0 } }),
        1);
}

void rook(ObjWriter& mesh, const glm::dmat4& map)
{
    piece(mesh, map,
        withFoot({ { 0.7, 0.52, 0 }, { 0.58, 1, 0 }, { 0.55, 1.7, 0 }, { 0.62, 1.88, 0 }, { 0.84, 1.98, 0 },
            { 0.86, 2.15, 0 }, { 0.85, 2.5, 0 }, { 0.8, 2.55, 0 }, { 0.6, 2.53, 0 }, { 0.57, 2.3, 0 }, { 0.3, 2.25, 0 },
            { 0, 2.25, 0 } }),
        2);
    for (int i = 0; i < 6; ++i) {
        const glm::dmat3 axes = turn(60.0 * i);
        texturedBox(mesh, glm::dvec3(map * glm::dvec4(axes * glm::dvec3(0, 2.62, 0.71), 1.0)),
            unit * glm::dvec3(0.2, 0.12, 0.1), 2 * unit, glm::dmat3(map) / unit * axes);
    }
}

void bishop(ObjWriter& mesh, const glm::dmat4& map)
{
    piece(mesh, map,
        withFoot({ { 0.66, 0.5, 0 }, { 0.46, 0.95, 0 }, { 0.36, 1.85, 0 }, { 0.4, 1.98, 0 }, { 0.64, 2.05, 0 },
            { 0.62, 2.14, 0 }, { 0.37, 2.22, 0 }, { 0.5, 2.48, 0 }, { 0.55, 2.72, 0 }, { 0.42, 3.05, 0 },
            { 0.18, 3.3, 0 }, { 0.1, 3.38, 0 }, { 0.17, 3.48, 0 }, { 0.12, 3.59, 0 }, { 0, 3.62, 0 } }),
        2);
}

void queen(ObjWriter& mesh, const glm::dmat4& map)
{
    std::vector<Ring> rings = turned(withFoot({ { 0.7, 0.52, 0 }, { 0.5, 1, 0 }, { 0.38, 2.2, 0 }, { 0.44, 2.36, 0 },
                                         { 0.72, 2.44, 0 }, { 0.7, 2.55, 0 }, { 0.42, 2.64, 0 }, { 0.48, 3.1, 0 },
                                         { 0.76, 3.62, 0 }, { 0.72, 3.68, 0 }, { 0.5, 3.58, 0 }, { 0.3, 3.72, 0 },
                                         { 0.13, 3.8, 0 }, { 0.2, 3.93, 0 }, { 0.14, 4.04, 0 }, { 0, 4.08, 0 } }),
        2, sides);
    for (Ring& ring : rings) { // the crown's rim has 9 points
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const double rim = std::exp(-std::pow((ring[i].y - 3.64) / 0.12, 2.0)) * std::hypot(ring[i].x, ring[i].z);
            ring[i].y += (i % 2 == 0 ? 0.12 : -0.12) * rim;
        }
    }
    texturedSkin(mesh, placed(rings, map), { 2, 2 });
}

void king(ObjWriter& mesh, const glm::dmat4& map)
{
    piece(mesh, map,
        withFoot({ { 0.72, 0.52, 0 }, { 0.52, 1, 0 }, { 0.4, 2.4, 0 }, { 0.46, 2.56, 0 }, { 0.76, 2.65, 0 },
            { 0.74, 2.77, 0 }, { 0.44, 2.86, 0 }, { 0.5, 3.3, 0 }, { 0.68, 3.82, 0 }, { 0.62, 3.93, 0 },
            { 0.3, 4.03, 0 }, { 0, 4.08, 0 } }),
        2);
    const auto bar = [&](double y, const glm::dvec3& half) {
        texturedBox(mesh, glm::dvec3(map * glm::dvec4(0, y, 0, 1)), unit * half, 2 * unit, glm::dmat3(map) / unit);
    };
    bar(4.34, { 0.08, 0.3, 0.07 });
    bar(4.38, { 0.24, 0.08, 0.065 });
}

void ear(ObjWriter& mesh, const glm::dmat4& map, double side)
{
    std::vector<Ring> rings;
    const std::vector<glm::dvec3> line { { -0.02, 2.4, 0.2 * side }, { -0.06, 2.75, 0.23 * side },
        { -0.02, 3.02, 0.25 * side } };
    const std::vector<Frame> frames = framesOn(curveThrough(line, 2), { 1, 0, 0 });
    for (std::size_t k = 0; k < frames.size(); ++k)
        rings.push_back(
            ringAround(frames[k], 10, k + 1 == frames.size() ? 0.0 : 0.15 - 0.028 * static_cast<double>(k)));
    texturedSkin(mesh, placed(rings, map), { 1, 1 });
}

/// A turned foot, and on it a neck that bends into a head.
void knight(ObjWriter& mesh, const glm::dmat4& map)
{
    piece(mesh, map, withFoot({ { 0.75, 0.5, 0 }, { 0.72, 0.72, 0 }, { 0.4, 0.8, 0 }, { 0, 0.8, 0 } }), 1);
    const std::vector<glm::dvec4> control { { 0.1, 0.7, 0, 0.74 }, { -0.14, 1.2, 0, 0.62 }, { -0.24, 1.8, 0, 0.5 },
        { -0.1, 2.35, 0, 0.42 }, { 0.32, 2.6, 0, 0.37 }, { 0.75, 2.45, 0, 0.3 }, { 1.08, 2.15, 0, 0.25 } };
    const std::vector<glm::dvec4> curve = curveThrough(control, 4);
    const std::vector<Frame> frames = framesOn({ curve.begin(), curve.end() }, { 0, 0, 1 });
    std::vector<Ring> rings;
    for (std::size_t k = 0; k < frames.size(); ++k)
        rings.push_back(ringAround(frames[k], 20, [&](double angle) {
            return curve[k].w * (0.78 - 0.22 * std::cos(2 * angle)); // flat at its sides
        }));
    rings.push_back(ringAround(frames.back(), 20, 0.0));
    texturedSkin(mesh, placed(rings, map), { 2, 2 });
    ear(mesh, map, -1);
    ear(mesh, map, 1);
}

struct Man {
    void (*make)(ObjWriter&, const glm::dmat4&);
    int file, rank; ///< rank 0 is nearest
    double facing; ///< degrees
};

void men(ObjWriter& mesh, const char* name, const char* material, std::initializer_list<Man> all)
{
    mesh.object(name, material);
    for (const Man& man : all) {
        const glm::dvec3 foot((man.file - 3.5) * square, 0, (3.5 - man.rank) * square);
        man.make(mesh, standing(foot, man.facing, unit));
    }
}

void boardAndTable(GeneratedScene& s)
{
    constexpr double half = 4 * square;
    s.mesh.object("board", "board");
    rectangle(s.mesh, { -half, 0, half }, { 2 * half, 0, 0 }, { 0, 0, -2 * half });
    s.mesh.object("frame", "table");
    texturedBox(s.mesh, { 0, -0.0155, 0 }, { half + 0.03, 0.015, half + 0.03 }, 0.2);
    s.mesh.object("cloth", "cloth");
    rectangle(s.mesh, { -1.2, -0.03, 0.9 }, { 2.4, 0, 0 }, { 0, 0, -1.8 }, { 8, 6 });
    s.mesh.object("wall", "wall");
    rectangle(s.mesh, { -1.6, -0.3, -0.75 }, { 3.2, 0, 0 }, { 0, 1.6, 0 }, { 8, 4 });
}

/// A board of 8 x 8 squares with a fine inlay in each.
image::RgbImage boardTexture()
{
    return paint(1024, 1024, [](double u, double v) {
        const double x = 8 * u, y = 8 * v;
        const bool dark = (static_cast<int>(x) + static_cast<int>(y)) % 2 == 0;
        const double in = std::max(std::abs(x - std::floor(x) - 0.5), std::abs(y - std::floor(y) - 0.5));
        const double grain =
            0.5 + 0.5 * std::sin(2 * std::numbers::pi * (dark ? 96 * u : 96 * v) + 6 * noise(16 * u, 16 * v, 16, 7));
        const glm::dvec3 wood = dark ? glm::mix(glm::dvec3(0.2, 0.08, 0.03), glm::dvec3(0.08, 0.03, 0.012), grain)
                                     : glm::mix(glm::dvec3(0.85, 0.66, 0.4), glm::dvec3(0.55, 0.36, 0.18), grain);
        const bool inlay = in > 0.3 && in < 0.38 && stripes(x + y, 4) > 0.0;
        return inlay ? (dark ? glm::dvec3(0.7, 0.5, 0.25) : glm::dvec3(0.25, 0.1, 0.05)) : wood;
    });
}

/// Rings of growth that run along the piece.
image::RgbImage turnedWood(const glm::dvec3& light, const glm::dvec3& dark, unsigned seed)
{
    return paint(256, 256, [=](double u, double v) {
        const double bend = noise(4 * u, 4 * v, 4, seed);
        const double ring = 0.5 + 0.5 * std::sin(2 * std::numbers::pi * (12 * v + 4 * bend));
        return glm::mix(light, dark, 0.7 * ring + 0.3 * noise(64 * u, 16 * v, 64, seed + 1));
    });
}

} // namespace

GeneratedScene makeChess()
{
    GeneratedScene s;
    s.name = "chess";
    s.comment = "Chess pieces on a board with a fine pattern; those in the middle are in focus";
    s.materials.push_back(textured(s, "board", boardTexture(), glm::vec3(0.85f), 0.1f, 40.0f));
    s.materials.push_back(textured(s, "table", wood({ 0.5, 0.3, 0.14 }, { 0.24, 0.11, 0.04 }, 6, 11), glm::vec3(0.8f)));
    s.materials.push_back(
        textured(s, "cloth", checkedCloth({ 0.75, 0.72, 0.62 }, { 0.08, 0.2, 0.3 }, 16), glm::vec3(0.9f)));
    s.materials.push_back(textured(
        s, "wall", wallpaper({ 0.62, 0.55, 0.4 }, { 0.55, 0.12, 0.08 }, { 0.1, 0.25, 0.18 }, 8), glm::vec3(0.9f)));
    s.materials.push_back(
        textured(s, "white", turnedWood({ 0.85, 0.7, 0.45 }, { 0.6, 0.4, 0.2 }, 3), glm::vec3(0.75f), 0.2f, 50.0f));
    s.materials.push_back(
        textured(s, "black", turnedWood({ 0.3, 0.1, 0.05 }, { 0.08, 0.025, 0.015 }, 5), glm::vec3(0.75f), 0.2f, 50.0f));
    boardAndTable(s);
    men(s.mesh, "white", "white",
        { { king, 4, 1, 0 }, { queen, 2, 2, 0 }, { rook, 0, 0, 0 }, { bishop, 5, 3, 0 }, { knight, 3, 4, 25 },
            { rook, 6, 1, 10 }, { pawn, 0, 2, 0 }, { pawn, 1, 1, 0 }, { pawn, 4, 3, 0 }, { pawn, 5, 1, 0 },
            { pawn, 7, 2, 0 }, { pawn, 3, 0, 0 } });
    men(s.mesh, "black", "black",
        { { king, 6, 7, 0 }, { queen, 3, 6, 0 }, { rook, 5, 7, 0 }, { bishop, 2, 4, 0 }, { knight, 5, 5, 200 },
            { rook, 0, 7, 0 }, { pawn, 0, 5, 0 }, { pawn, 1, 4, 0 }, { pawn, 4, 5, 0 }, { pawn, 6, 5, 0 },
            { pawn, 7, 6, 0 }, { pawn, 2, 6, 0 } });
    s.camera.eye = { 0.1f, 0.24f, 0.5f };
    s.camera.lookAt = { 0.0f, 0.015f, 0.02f };
    s.camera.verticalFov = 38.0f;
    s.camera.focusDistance = 0.5f;
    s.camera.apertureRadius = 0.026f;
    s.light = gaussianLight({ -0.75f, 1.15f, 0.35f }, { 0.0f, 0.0f, 0.0f }, 0.22f);
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0 }, { 0, 1, 0 }, 0.4, 0.62));
    s.background = glm::vec3(0.05f);
    s.bounces = 1;
    return s;
}

} // namespace wedge::generator
