#include "data/generator/light_level.h"
#include "data/generator/patterns.h"
#include "data/generator/scene_writer.h"
#include "data/generator/shapes.h"
#include "data/generator/textured.h"

#include <array>
#include <cmath>
#include <numbers>

namespace wedge::generator {
namespace {

/// Where (u, v) lies on a twig of leaves that grows along v: 0 beside them, 1 on the twig, 2 and more on leaves.
int onTwig(double u, double v)
{
    constexpr int leaves = 9;
    for (int i = 0; i < leaves; ++i) {
        // In pairs, the last one at the tip.
        const double side = i == leaves - 1 ? 0.0 : i % 2 == 0 ? 1.0 : -1.0;
        const double angle = side * 0.9, length = 0.21 - 0.008 * i;
        const glm::dvec2 along(std::sin(angle), std::cos(angle));
        const glm::dvec2 d = glm::dvec2(u - 0.5, v - 0.12 - 0.085 * i) - along * length;
        const double x = glm::dot(d, along) / length, y = (d.x * along.y - d.y * along.x) / (0.42 * length);
        if (std::fabs(x) < 1 && std::fabs(y) < 1 - x * x)
            return 2 + i;
    }
    return std::fabs(u - 0.5) < 0.012 && v < 0.85 ? 1 : 0;
}

image::RgbImage leafMask()
{
    return paint(256, 256, [](double u, double v) { return glm::dvec3(onTwig(u, v) > 0 ? 1.0 : 0.0); });
}

image::RgbImage leafColours()
{
    return paint(256, 256, [](double u, double v) {
        const int part = onTwig(u, v);
        return part == 1 ? glm::dvec3(0.2, 0.12, 0.05)
                         : glm::dvec3(0.12 + 0.012 * part, 0.34 + 0.02 * (part % 3), 0.05)
                * (0.8 + 0.4 * noise(24 * u, 24 * v, 24, 71));
    });
}

double barkHeight(double u, double v)
{
    const double ridges = noise(12 * u, 3 * v, 3, 72);
    return 0.7 * (1 - std::fabs(2 * ridges - 1)) + 0.3 * noise(36 * u, 18 * v, 18, 73);
}

/// A leaning branch.
void branch(ObjWriter& mesh, const glm::dvec3& from, const glm::dvec3& to, double thick, double thin)
{
    std::vector<glm::dvec3> line =
        curveThrough<glm::dvec3>({ from, 0.5 * (from + to) + glm::dvec3(0, 0.08, 0), to }, 6);
    std::vector<Ring> rings;
    const std::vector<Frame> frames = framesOn(line, glm::dvec3(0, 0, 1));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(frames.size() - 1);
        rings.push_back(ringAround(frames[i], 12, thick + t * (thin - thick)));
    }
    texturedSkin(mesh, rings, { 2, 2.0 * glm::length(to - from) });
}

/// Two cards that cross along the way from a place outwards.
void crossedCards(ObjWriter& mesh, const glm::dvec3& at, const glm::dvec3& outwards, double size, double roll)
{
    const Frame f = frameAt(at, outwards, std::fabs(outwards.y) > 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
    for (const double turned : { roll, roll + std::numbers::pi / 2 }) {
        const glm::dvec3 across = size * (std::cos(turned) * f.left + std::sin(turned) * f.up);
        rectangle(mesh, at - 0.5 * across, across, size * f.along);
    }
}

} // namespace

GeneratedScene makeCardTree()
{
    GeneratedScene s;
    s.name = "card_tree";
    s.comment = "A tree whose leaves are pictures with holes on 640 cards";
    s.materials.push_back(matt("ground", { 0.4f, 0.42f, 0.3f }));
    scene::Material bark = textured(s, "bark",
        paint(
            256, 256, [](double u, double v) { return glm::dvec3(0.32, 0.22, 0.14) * (0.4 + 0.9 * barkHeight(u, v)); }),
        glm::vec3(1.0f));
    bark.normalTexture = static_cast<int>(s.textures.size());
    bark.normalIsHeight = true;
    bark.normalStrength = 12.0f;
    s.textures.push_back(
        { "bark_heights", paint(256, 256, [](double u, double v) { return glm::dvec3(barkHeight(u, v)); }) });
    s.materials.push_back(bark);
    scene::Material leaf = textured(s, "leaf", leafColours(), glm::vec3(1.0f));
    leaf.opacityTexture = static_cast<int>(s.textures.size());
    s.textures.push_back({ "leaf_mask", leafMask() });
    s.materials.push_back(leaf);

    s.mesh.object("ground", "ground");
    rectangle(s.mesh, { -8, 0, 8 }, { 16, 0, 0 }, { 0, 0, -16 });
    s.mesh.object("trunk", "bark");
    branch(s.mesh, { 0, -0.05, 0 }, { 0.05, 1.7, 0 }, 0.17, 0.1);
    const std::array<glm::dvec3, 6> tips { glm::dvec3(0.8, 2.4, 0.3), glm::dvec3(-0.7, 2.5, 0.4),
        glm::dvec3(0.1, 2.9, -0.1), glm::dvec3(0.3, 2.3, -0.8), glm::dvec3(-0.5, 2.2, -0.6),
        glm::dvec3(0.05, 2.2, 0.9) };
    for (const glm::dvec3& tip : tips)
        branch(s.mesh, { 0.04, 1.35 + 0.1 * tip.x, 0 }, tip, 0.07, 0.015);
    s.mesh.object("leaves", "leaf");
    Random random(74);
    for (int i = 0; i < 320; ++i) {
        const glm::dvec3 way = glm::normalize(random.inBall());
        const double depth = random.uniform(0.35, 1.0);
        const glm::dvec3 at = glm::dvec3(0.05, 2.4, 0) + depth * way * glm::dvec3(1.2, 0.9, 1.2);
        const glm::dvec3 outwards = glm::normalize(way + 0.7 * random.inBall() + glm::dvec3(0, 0.2, 0));
        crossedCards(s.mesh, at, outwards, random.uniform(0.3, 0.45), random.uniform(0.0, std::numbers::pi));
    }
    s.camera.eye = { 0.6f, 1.5f, 5.3f };
    s.camera.lookAt = { 0.1f, 1.72f, 0.0f };
    s.camera.verticalFov = 40.0f;
    s.light = gaussianLight({ -3.5f, 7.0f, 3.5f }, { 0.0f, 1.5f, 0.0f }, 0.7f);
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0 }, { 0, 1, 0 }, 0.42, 0.6));
    s.antialias = true;
    s.bounces = 1;
    return s;
}

} // namespace wedge::generator
