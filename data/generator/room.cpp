#include "data/generator/light_level.h"
#include "data/generator/patterns.h"
#include "data/generator/scene_writer.h"
#include "data/generator/shapes.h"
#include "data/generator/textured.h"

#include <cmath>
#include <numbers>
#include <string>

namespace wedge::generator {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double x = 2.4, y = 2.6, back = -2.5, front = 2.6; // the room, m
constexpr int bookKinds = 6;

void walls(ObjWriter& mesh)
{
    const auto wall = [&](const char* name, const char* material, const glm::dvec3& corner, const glm::dvec3& u,
                          const glm::dvec3& v, const glm::dvec2& repeats) {
        mesh.object(name, material);
        rectangle(mesh, corner, u, v, repeats);
    };
    const double depth = front - back;
    wall("floor", "floor", { -x, 0, front }, { 2 * x, 0, 0 }, { 0, 0, -depth }, { 3, 3 });
    wall("ceiling", "ceiling", { -x, y, back }, { 2 * x, 0, 0 }, { 0, 0, depth }, { 1, 1 });
    wall("back", "wall", { -x, 0, back }, { 2 * x, 0, 0 }, { 0, y, 0 }, { 3, 1.6 });
    wall("left", "wall", { -x, 0, front }, { 0, 0, -depth }, { 0, y, 0 }, { 3, 1.6 });
    wall("right", "wall", { x, 0, back }, { 0, 0, depth }, { 0, y, 0 }, { 3, 1.6 });
    mesh.object("rug", "rug");
    const auto pile = [](double u, double v) {
        const double wave = std::sin(9 * u + 4 * v) * std::sin(7 * v - 2 * u);
        return glm::dvec3(-1.35 + 2.7 * u, 0.012 + 0.005 * wave, 0.9 - 2.1 * v);
    };
    sheet(mesh, 90, 70, pile, { 4, 3 });
}

struct Book {
    glm::dvec3 centre, half;
    int kind;
};

/// A shelf against the back wall. Returns the books that stand in its rows.
std::vector<Book> shelf(ObjWriter& mesh, double left, double width, Random& random)
{
    constexpr double depth = 0.26, thick = 0.012, step = 0.34;
    constexpr int rows = 6;
    mesh.object("shelf", "shelf");
    const double z = back + 0.5 * depth, height = rows * step + 0.08;
    for (const double side : { left, left + width })
        texturedBox(mesh, { side, 0.5 * height, z }, { thick, 0.5 * height, 0.5 * depth }, 0.5);
    for (int row = 0; row <= rows; ++row)
        texturedBox(
            mesh, { left + 0.5 * width, 0.06 + row * step, z }, { 0.5 * width - thick, thick, 0.5 * depth }, 0.5);
    std::vector<Book> books;
    for (int row = 0; row < rows; ++row) {
        const double floor = 0.06 + row * step + thick;
        double at = left + thick;
        for (;;) {
            const double half = 0.5 * random.uniform(0.02, 0.048), tall = random.uniform(0.2, 0.3);
            if (at + 2 * half > left + width - thick)
                break;
            const double deep = random.uniform(0.15, 0.19);
            const int kind = static_cast<int>(random.uniform(0, bookKinds));
            if (random.uniform(0, 1) > 0.06) // some are lent out
                books.push_back({ { at + half, floor + 0.5 * tall, back + 0.02 + 0.5 * deep },
                    { half - 0.0008, 0.5 * tall, 0.5 * deep }, kind });
            at += 2 * half;
        }
    }
    return books;
}

void shelves(ObjWriter& mesh, Random& random)
{
    std::vector<Book> books;
    for (const double left : { -1.3, -0.12, 1.06 }) {
        const std::vector<Book> more = shelf(mesh, left, 1.16, random);
        books.insert(books.end(), more.begin(), more.end());
    }
    for (int kind = 0; kind < bookKinds; ++kind) { // the texture is once on each back
        mesh.object("books" + std::to_string(kind), "book" + std::to_string(kind));
        for (const Book& book : books) {
            if (book.kind == kind)
                texturedBox(mesh, book.centre, book.half, 2 * book.half.y);
        }
    }
}

/// A seat of that width: base, back, two arms, and cushions.
void sofa(ObjWriter& mesh, const char* name, const glm::dvec3& foot, double degrees, double width, int cushions)
{
    const glm::dmat3 axes = turn(degrees);
    const auto part = [&](const glm::dvec3& centre, const glm::dvec3& half, double radius) {
        roundedBox(mesh, foot + axes * centre, half, radius, 4, 0.5, axes);
    };
    mesh.object(name, "sofa");
    part({ 0, 0.16, 0 }, { 0.5 * width, 0.12, 0.4 }, 0.03);
    part({ 0, 0.5, -0.34 }, { 0.5 * width, 0.32, 0.1 }, 0.08);
    for (const double side : { -1.0, 1.0 })
        part({ side * (0.5 * width - 0.02), 0.34, 0.0 }, { 0.1, 0.26, 0.42 }, 0.08);
    const double each = (width - 0.24) / cushions;
    for (int i = 0; i < cushions; ++i)
        part({ -0.5 * width + 0.12 + (i + 0.5) * each, 0.34, 0.04 }, { 0.49 * each, 0.08, 0.34 }, 0.06);
    mesh.object(name + std::string("_pillow"), "pillow");
    roundedBox(mesh, foot + axes * glm::dvec3(0.28 * width, 0.56, -0.12), { 0.19, 0.19, 0.07 }, 0.068, 4, 0.4,
        axes * glm::dmat3(1, 0, 0, 0, 0.94, -0.342, 0, 0.342, 0.94));
}

void lathe(ObjWriter& mesh, const std::vector<glm::dvec3>& profile, const glm::dmat4& map, const glm::dvec2& repeats)
{
    texturedSkin(mesh, placed(turned(profile, 3, 48), map), repeats);
}

void vase(ObjWriter& mesh, const char* name, const char* material, const glm::dvec3& foot, double height)
{
    mesh.object(name, material);
    lathe(mesh,
        { { 0, 0, 0 }, { 0.22, 0, 0 }, { 0.24, 0.02, 0 }, { 0.33, 0.3, 0 }, { 0.34, 0.5, 0 }, { 0.2, 0.8, 0 },
            { 0.15, 0.9, 0 }, { 0.2, 1, 0 }, { 0.18, 1, 0 }, { 0.13, 0.9, 0 }, { 0.17, 0.8, 0 }, { 0.28, 0.5, 0 },
            { 0.2, 0.1, 0 }, { 0, 0.08, 0 } },
        standing(foot, 0, height), { 4, 3 });
}

void coffeeTable(ObjWriter& mesh)
{
    mesh.object("table", "shelf");
    roundedBox(mesh, { 0.0, 0.4, -0.15 }, { 0.52, 0.022, 0.3 }, 0.02, 3, 0.5);
    for (const double px : { -0.46, 0.46 }) {
        for (const double pz : { -0.38, 0.08 })
            texturedBox(mesh, { px, 0.19, pz }, { 0.025, 0.19, 0.025 }, 0.3);
    }
    vase(mesh, "table_vase", "vase", { -0.25, 0.421, -0.2 }, 0.26);
    mesh.object("table_books", "book0");
    texturedBox(mesh, { 0.2, 0.437, -0.1 }, { 0.14, 0.015, 0.1 }, 0.3, turn(20));
    mesh.object("table_books", "book3");
    texturedBox(mesh, { 0.2, 0.4645, -0.1 }, { 0.12, 0.012, 0.09 }, 0.3, turn(-10));
}

void lamp(ObjWriter& mesh)
{
    mesh.object("lamp", "metal");
    lathe(mesh,
        { { 0, 0, 0 }, { 0.14, 0, 0 }, { 0.15, 0.01, 0 }, { 0.1, 0.025, 0 }, { 0.03, 0.035, 0 }, { 0.015, 0.05, 0 },
            { 0.013, 0.1, 0 }, { 0.013, 0.5, 0 }, { 0.013, 1.45, 0 }, { 0, 1.47, 0 } },
        standing({ -1.95, 0, -1.2 }), { 1, 8 });
    mesh.object("shade", "pillow");
    std::vector<Ring> rings;
    for (int k = 0; k <= 16; ++k)
        rings.push_back(
            ringAround(frameAt({ -1.95, 1.3 + 0.02 * k, -1.2 }, { 0, 1, 0 }, { 0, 0, 1 }), 48, 0.24 - 0.006 * k));
    texturedSkin(mesh, rings, { 6, 2 });
}

/// Hangs in folds beside the left wall, from z to z + width.
void curtain(ObjWriter& mesh, double from, double width)
{
    mesh.object("curtain", "curtain");
    const auto point = [=](double u, double v) {
        const double fold = std::sin(2 * pi * 7 * u + 1.5 * std::sin(3 * v)) * (0.6 + 0.4 * (1 - v));
        return glm::dvec3(-x + 0.11 + 0.06 * fold, 0.05 + 2.35 * v, from + width * (1 - u));
    };
    sheet(mesh, 120, 40, point, { 3, 6 });
}

void pot(ObjWriter& mesh, const glm::dvec3& foot, double height)
{
    lathe(mesh,
        { { 0, 0, 0 }, { 0.35, 0, 0 }, { 0.37, 0.02, 0 }, { 0.5, 0.9, 0 }, { 0.52, 1, 0 }, { 0.47, 1, 0 },
            { 0.44, 0.88, 0 }, { 0, 0.86, 0 } },
        standing(foot, 0, height), { 4, 2 });
}

/// Long leaves on thin stalks out of a pot.
void plant(ObjWriter& mesh, const std::string& name, const glm::dvec3& foot, double size, int count, Random& random)
{
    mesh.object(name + "_pot", "vase");
    pot(mesh, foot, 0.3 * size);
    for (int i = 0; i < count; ++i) {
        const double angle = 2.39996 * i, lean = random.uniform(0.15, 0.9), tall = random.uniform(0.3, 1.0) * size;
        const glm::dvec3 out(std::cos(angle), 0, std::sin(angle));
        const glm::dvec3 root = foot + glm::dvec3(0, 0.27 * size, 0) + 0.06 * size * out;
        const glm::dvec3 tip = root + glm::dvec3(0, tall * (1 - 0.4 * lean), 0) + 0.35 * lean * tall * out;
        mesh.object(name + "_stalks", "stalk");
        tube(mesh,
            curveThrough(std::vector<glm::dvec3> { root, 0.5 * (root + tip) + glm::dvec3(0, 0.1 * tall, 0), tip }, 3),
            std::vector<double>(7, 0.005 * size), 5);
        mesh.object(name + "_leaves", "leaf");
        leaf(mesh, frameAt(tip, out + glm::dvec3(0, random.uniform(-0.1, 0.5), 0), { 0, 1, 0 }),
            size * random.uniform(0.22, 0.36), 0.12 * size, random.uniform(0.25, 0.6), 14, 6);
    }
}

void picture(ObjWriter& mesh, const char* material, const glm::dvec3& centre, double halfWidth, double halfHeight)
{
    mesh.object("picture", material);
    rectangle(
        mesh, centre + glm::dvec3(0.021, -halfHeight, halfWidth), { 0, 0, -2 * halfWidth }, { 0, 2 * halfHeight, 0 });
    mesh.object("frame", "shelf");
    for (const double side : { -1.0, 1.0 }) {
        texturedBox(mesh, centre + glm::dvec3(0.01, 0, side * halfWidth), { 0.02, halfHeight + 0.02, 0.02 }, 0.3);
        texturedBox(mesh, centre + glm::dvec3(0.01, side * halfHeight, 0), { 0.02, 0.02, halfWidth - 0.02 }, 0.3);
    }
}

void addMaterials(GeneratedScene& s)
{
    const auto add = [&](const std::string& name, image::RgbImage image, float tint, float specular = 0.0f,
                         float exponent = 1.0f) {
        s.materials.push_back(textured(s, name, std::move(image), glm::vec3(tint), specular, exponent));
    };
    add("floor", wood({ 0.55, 0.35, 0.18 }, { 0.3, 0.16, 0.07 }, 8, 71), 0.75f, 0.15f, 40.0f);
    add("wall", wallpaper({ 0.72, 0.68, 0.56 }, { 0.5, 0.55, 0.4 }, { 0.6, 0.35, 0.25 }, 12), 0.9f);
    add("rug", carpet({ 0.6, 0.52, 0.38 }, { 0.55, 0.08, 0.06 }, { 0.08, 0.14, 0.35 }, 6), 0.75f);
    add("shelf", wood({ 0.45, 0.26, 0.12 }, { 0.2, 0.09, 0.04 }, 3, 72), 0.75f, 0.15f, 30.0f);
    add("sofa", checkedCloth({ 0.25, 0.4, 0.45 }, { 0.12, 0.22, 0.3 }, 16), 0.9f);
    add("pillow", wallpaper({ 0.8, 0.7, 0.4 }, { 0.7, 0.2, 0.1 }, { 0.2, 0.35, 0.2 }, 4), 0.9f);
    add("curtain", checkedCloth({ 0.75, 0.65, 0.5 }, { 0.6, 0.25, 0.15 }, 12), 0.9f);
    add("vase", wallpaper({ 0.82, 0.8, 0.76 }, { 0.1, 0.2, 0.5 }, { 0.6, 0.2, 0.15 }, 4), 0.65f, 0.25f, 50.0f);
    add("leaf", veined({ 0.12, 0.36, 0.1 }, { 0.45, 0.6, 0.3 }), 0.85f, 0.12f, 20.0f);
    add("picture", wallpaper({ 0.5, 0.62, 0.72 }, { 0.8, 0.5, 0.1 }, { 0.15, 0.35, 0.15 }, 3), 0.9f);
    const glm::dvec3 covers[bookKinds] = { { 0.5, 0.08, 0.06 }, { 0.08, 0.2, 0.42 }, { 0.1, 0.32, 0.14 },
        { 0.65, 0.48, 0.18 }, { 0.3, 0.12, 0.3 }, { 0.6, 0.58, 0.5 } };
    for (int i = 0; i < bookKinds; ++i)
        add("book" + std::to_string(i), bookBack(covers[i], { 0.8, 0.65, 0.25 }, 80 + static_cast<unsigned>(i)), 0.85f,
            0.1f, 20.0f);
    s.materials.push_back(matt("ceiling", glm::vec3(0.78f, 0.77f, 0.74f)));
    s.materials.push_back(matt("stalk", glm::vec3(0.14f, 0.25f, 0.07f)));
    s.materials.push_back(glossy("metal", glm::vec3(0.3f, 0.28f, 0.25f), 0.45f, 60.0f));
}

} // namespace

GeneratedScene makeRoom()
{
    GeneratedScene s;
    s.name = "room";
    s.comment = "A living room with shelves of books; a plant in front is out of focus";
    addMaterials(s);
    Random random(100);
    walls(s.mesh);
    shelves(s.mesh, random);
    sofa(s.mesh, "sofa", { 1.75, 0, -0.55 }, -90, 1.9, 2);
    sofa(s.mesh, "armchair", { -1.35, 0, -0.75 }, 60, 0.95, 1);
    coffeeTable(s.mesh);
    lamp(s.mesh);
    curtain(s.mesh, -0.4, 1.1);
    curtain(s.mesh, -2.3, 0.8);
    picture(s.mesh, "picture", { -x, 1.6, -1.0 }, 0.35, 0.45);
    plant(s.mesh, "far_plant", { -1.75, 0, -1.95 }, 1.2, 110, random);
    s.mesh.object("stand", "shelf");
    texturedBox(s.mesh, { 0.1, 0.37, 1.5 }, { 0.18, 0.37, 0.18 }, 0.5);
    plant(s.mesh, "near_plant", { 0.1, 0.74, 1.5 }, 0.6, 60, random);
    s.camera.eye = { 0.75f, 1.35f, 2.45f };
    s.camera.lookAt = { -0.1f, 0.85f, -1.0f };
    s.camera.verticalFov = 52.0f;
    s.camera.focusDistance = 3.2f;
    s.camera.apertureRadius = 0.05f;
    s.light.centre = { 0.1f, 2.55f, -0.3f };
    s.light.halfU = { 0.5f, 0.0f, 0.0f };
    s.light.halfV = { 0.0f, 0.0f, 0.5f }; // cross(halfU, halfV) looks down
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0 }, { 0, 1, 0 }, 0.5, 1.5));
    s.background = glm::vec3(0.0f);
    s.bounces = 1;
    return s;
}

} // namespace wedge::generator
