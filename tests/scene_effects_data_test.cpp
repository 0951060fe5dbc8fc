// The generated scenes with lens, motion and textures: that they hold what they are for.

#include <algorithm>
#include <cmath>
#include <set>

#include <doctest/doctest.h>

#include "data/generator/patterns.h"
#include "data/generator/scene_writer.h"
#include "data/generator/textured.h"
#include "scene_sound.h"

using namespace scene_test;
using wedge::generator::GeneratedScene;
using wedge::scene::loadScene;
using wedge::scene::Scene;

namespace {

/// Where a point is in a picture of 640 x 480, and the radius of its circle of confusion, all in pixels.
struct Seen {
    glm::vec2 at { 0.0f };
    float blur = 0.0f;
    bool inView = false;
};

Seen seen(const Scene& s, const glm::vec3& point)
{
    const auto& c = s.camera;
    const glm::vec3 forward = glm::normalize(c.lookAt - c.eye), right = glm::normalize(glm::cross(forward, c.up));
    const glm::vec3 to = point - c.eye;
    const float depth = glm::dot(to, forward), scale = 240.0f / std::tan(glm::radians(0.5f * c.verticalFov));
    Seen out;
    out.at = scale / depth * glm::vec2(glm::dot(to, right), glm::dot(to, glm::cross(right, forward)));
    out.inView = depth > 0.0f && std::abs(out.at.x) < 320.0f && std::abs(out.at.y) < 240.0f;
    out.blur = scale * c.apertureRadius * std::abs(1.0f / depth - 1.0f / c.focusDistance);
    return out;
}

/// Writes a generated scene, reads it, and checks what all of these scenes have: size, textures with detail and their
/// coordinates, matt and glossy materials, a light, a bounce.
Scene checkEffects(const GeneratedScene& made, std::size_t size)
{
    const TemporaryFolder folder;
    wedge::generator::writeScene(made, folder.path("out"));
    Scene s = loadScene(folder.path("out/" + made.name + ".toml"));
    CAPTURE(made.name);
    CHECK(s.warnings.empty());
    checkSound(s);
    const double count = static_cast<double>(s.geometry.indices.size()) / 3.0;
    CHECK(count == static_cast<double>(wedge::generator::triangles(made)));
    CHECK(std::abs(count - static_cast<double>(size)) <= 0.1 * static_cast<double>(size));
    CHECK(s.settings.bounces == 1);
    CHECK(s.areaLights.size() == 1);
    std::size_t glossy = 0, matt = 0;
    for (const auto& m : s.materials)
        (m.specular == glm::vec3(0.0f) ? matt : glossy) += 1;
    CHECK(glossy > 0);
    CHECK(matt > 0);
    CHECK(s.textures.size() == made.textures.size());
    for (const auto& t : s.textures) {
        CAPTURE(t.path);
        const std::set<std::uint32_t> colours(t.rgba.begin(), t.rgba.end());
        CHECK(t.width >= 64);
        CHECK(colours.size() > 8);
        std::size_t changes = 0; // between texels beside each other
        for (std::size_t i = 1; i < t.rgba.size(); ++i)
            changes += t.rgba[i] != t.rgba[i - 1];
        CHECK(changes > t.rgba.size() / 20);
    }
    std::size_t flat = 0; // textured triangles on which the texture does not vary
    const auto& g = s.geometry;
    for (std::size_t i = 0; i < g.indices.size(); i += 3) {
        const auto uv = [&](std::size_t c) {
            const std::size_t v = g.indices[i + c];
            return glm::dvec2(g.texcoords[2 * v], g.texcoords[2 * v + 1]);
        };
        const glm::dvec2 a = uv(1) - uv(0), b = uv(2) - uv(0);
        flat += s.materials[g.materialIds[i / 3]].diffuseTexture >= 0 && !(std::abs(a.x * b.y - a.y * b.x) > 0.0);
    }
    CHECK(flat == 0);
    return s;
}

/// That the lens does something: much in view is in focus, much is blurred, and nothing by more than `most` pixels.
void checkLens(const Scene& s, float most)
{
    REQUIRE(s.camera.apertureRadius > 0.0f);
    REQUIRE(s.camera.focusDistance > 0.0f);
    std::size_t sharp = 0, blurred = 0, all = 0;
    float largest = 0.0f;
    for (std::size_t v = 0; v < s.geometry.positions.size() / 3; ++v) {
        const Seen p = seen(s, vectorAt(s.geometry.positions, v));
        if (!p.inView)
            continue;
        ++all;
        sharp += p.blur < 2.0f;
        blurred += p.blur > 5.0f;
        largest = std::max(largest, p.blur);
    }
    CAPTURE(s.path);
    CAPTURE(largest);
    CHECK(sharp > all / 20);
    CHECK(blurred > all / 20);
    CHECK(largest > 10.0f);
    CHECK(largest < most);
}

/// The range over an object's vertices of a value at each.
template <class Value>
glm::vec2 rangeOver(const Scene& s, const std::string& object, const Value& value)
{
    glm::vec2 range(1e30f, -1e30f);
    const auto& g = s.geometry;
    for (std::size_t i = 0; i < g.indices.size(); ++i) {
        if (g.objectNames[g.objectIds[i / 3] - 1] == object) {
            const float x = value(g.indices[i]);
            range = { std::min(range.x, x), std::max(range.y, x) };
        }
    }
    return range;
}

/// How far a vertex goes over the picture while the shutter is open, in pixels.
float travel(const Scene& s, std::size_t vertex)
{
    const glm::vec3 a = vectorAt(s.geometry.positions, vertex), b = vectorAt(s.geometry.positionsAtClose, vertex);
    return glm::length(seen(s, b).at - seen(s, a).at);
}

void checkMotion(const Scene& s)
{
    REQUIRE(wedge::scene::geometryMoves(s));
    CHECK_FALSE(wedge::scene::cameraMoves(s));
    const auto pixels = [&](const std::string& object) {
        return rangeOver(s, object, [&](std::size_t v) { return travel(s, v); });
    };
    const glm::vec2 board = pixels("board"), vase = pixels("vase"), flag = pixels("flag");
    CHECK(board.x > 10.0f);
    CHECK(board.y < 40.0f);
    CHECK(vase.x > 10.0f);
    CHECK(vase.y < 40.0f);
    CHECK(vase.y - vase.x > 5.0f); // it turns
    CHECK(flag.x < 0.5f); // fixed at its pole
    CHECK(flag.y > 10.0f);
    CHECK(flag.y < 40.0f);
    for (const std::string rest : { "ball", "floor", "back", "left", "right", "ceiling", "pole" })
        CHECK(pixels(rest) == glm::vec2(0.0f));
    // The ball is above the board all the time, so that its shadow stays on it.
    const auto x = [&](const std::vector<float>& p) { return [&p](std::size_t v) { return p[3 * v]; }; };
    const glm::vec2 ball = rangeOver(s, "ball", x(s.geometry.positions));
    for (const std::vector<float>* p : { &s.geometry.positions, &s.geometry.positionsAtClose }) {
        const glm::vec2 over = rangeOver(s, "board", x(*p));
        CHECK(over.x < ball.x);
        CHECK(over.y > ball.y);
    }
    CHECK(s.camera.eye.y > 0.0f);
}

} // namespace

TEST_CASE("chess: pieces in the middle are in focus, the nearest and the farthest blurred by 10 to 16 pixels")
{
    const Scene s = checkEffects(wedge::generator::makeChess(), 21'000);
    checkLens(s, 30.0f);
    float sharpest = 1e30f, nearest = 0.0f, farthest = 0.0f;
    for (std::size_t i = 0; i < s.geometry.indices.size(); ++i) {
        const std::string& object = s.geometry.objectNames[s.geometry.objectIds[i / 3] - 1];
        const glm::vec3 p = vectorAt(s.geometry.positions, s.geometry.indices[i]);
        const Seen at = seen(s, p);
        if ((object != "white" && object != "black") || !at.inView)
            continue;
        sharpest = std::min(sharpest, at.blur);
        const bool isNear = glm::length(p - s.camera.eye) < s.camera.focusDistance;
        (isNear ? nearest : farthest) = std::max(isNear ? nearest : farthest, at.blur);
    }
    CHECK(sharpest < 0.5f);
    CHECK(nearest > 10.0f);
    CHECK(nearest < 16.0f);
    CHECK(farthest > 10.0f);
    CHECK(farthest < 16.0f);
}

TEST_CASE("still life, toasters and room: their sizes, and a lens that blurs what is near and far")
{
    checkLens(checkEffects(wedge::generator::makeStillLife(), 128'000), 20.0f);
    checkLens(checkEffects(wedge::generator::makeToasters(), 2'500), 20.0f);
    checkLens(checkEffects(wedge::generator::makeRoom(), 100'000), 25.0f);
}

TEST_CASE("the moving Cornell box: what moves goes 10 to 40 pixels, the rest stays; the same through a lens")
{
    const Scene pinhole = checkEffects(wedge::generator::makeMovingCornell(), 9'400);
    CHECK(pinhole.camera.apertureRadius == 0.0f);
    checkMotion(pinhole);
    const Scene lens = checkEffects(wedge::generator::makeMovingLens(), 9'400);
    checkMotion(lens);
    checkLens(lens, 25.0f);
    CHECK(lens.geometry.positions == pinhole.geometry.positions);
    CHECK(lens.geometry.positionsAtClose == pinhole.geometry.positionsAtClose);
}

TEST_CASE("the tree of cards has leaves with holes and a trunk with bumps")
{
    const GeneratedScene made = wedge::generator::makeCardTree();
    const TemporaryFolder folder;
    wedge::generator::writeScene(made, folder.path("out"));
    const Scene s = loadScene(folder.path("out/card_tree.toml"));
    CHECK(s.warnings.empty());
    checkSound(s);
    CHECK(s.geometry.indices.size() / 3 == wedge::generator::triangles(made));
    CHECK(s.settings.antialias);
    CHECK(made.mesh.text() == wedge::generator::makeCardTree().mesh.text());
    const auto named = [&](const std::string& name) -> const wedge::scene::Material& {
        return *std::ranges::find(s.materials, name, &wedge::scene::Material::name);
    };
    CHECK(named("bark").normalTexture >= 0);
    CHECK(named("bark").normalIsHeight);
    REQUIRE(named("leaf").opacityTexture >= 0);
    // Between a quarter and three quarters of a card are leaves.
    const wedge::scene::Texture& mask = s.textures[static_cast<std::size_t>(named("leaf").opacityTexture)];
    const auto leaves = std::ranges::count_if(mask.rgba, [](std::uint32_t t) { return (t & 255u) > 127u; });
    CHECK(leaves > static_cast<std::ptrdiff_t>(mask.rgba.size() / 4));
    CHECK(leaves < static_cast<std::ptrdiff_t>(mask.rgba.size() * 3 / 4));
}

TEST_CASE("scenes with textures are the same in every run")
{
    const GeneratedScene a = wedge::generator::makeToasters(), b = wedge::generator::makeToasters();
    CHECK(a.mesh.text() == b.mesh.text());
    REQUIRE(a.textures.size() == b.textures.size());
    for (std::size_t i = 0; i < a.textures.size(); ++i)
        CHECK(a.textures[i].image.rgb == b.textures[i].image.rgb);
    CHECK(wedge::generator::makeStillLife().mesh.text() == wedge::generator::makeStillLife().mesh.text());
}

TEST_CASE("patterns: noise stays in its range, repeats without a seam, and stripes take turns")
{
    float least = 1.0f, most = 0.0f;
    for (int i = 0; i < 400; ++i) {
        const double x = 0.173 * i, y = 0.091 * i;
        const double n = wedge::generator::noise(x, y, 16, 5);
        least = std::min(least, static_cast<float>(n));
        most = std::max(most, static_cast<float>(n));
        CHECK(wedge::generator::noise(x + 16, y - 16, 16, 5) == doctest::Approx(n));
    }
    CHECK(least >= 0.0f);
    CHECK(most <= 1.0f);
    CHECK(most - least > 0.5f);
    CHECK(wedge::generator::stripes(0.1, 2) == 0.0);
    CHECK(wedge::generator::stripes(0.3, 2) == 1.0);
    CHECK(wedge::generator::stripes(0.6, 2) == 0.0);
    const wedge::image::RgbImage up = wedge::generator::paint(1, 2, [](double, double v) { return glm::dvec3(v); });
    CHECK(up.rgb[0] == doctest::Approx(0.75)); // the first row is the upper one
    CHECK(up.rgb[3] == doctest::Approx(0.25));
}

TEST_CASE("shapes: counts, and faces and normals that look outside")
{
    const auto check = [](const wedge::generator::ObjWriter& mesh, std::size_t triangles, const glm::vec3& middle) {
        const TemporaryFolder folder;
        const Scene s =
            loadScene(folder.write("s.toml", "[[mesh]]\nfile = '" + folder.write("x.obj", mesh.text()) + "'"));
        CHECK(mesh.triangles() == triangles);
        REQUIRE(s.geometry.indices.size() == 3 * triangles);
        std::size_t inward = 0;
        for (std::size_t t = 0; t < triangles; ++t) {
            const glm::vec3 a = corner(s.geometry, t, 0), b = corner(s.geometry, t, 1), c = corner(s.geometry, t, 2);
            const glm::vec3 out = (a + b + c) / 3.0f - middle;
            inward += !(glm::dot(glm::cross(b - a, c - a), out) > 0.0f);
            for (std::size_t i = 0; i < 3; ++i)
                inward += !(glm::dot(vectorAt(s.geometry.normals, s.geometry.indices[3 * t + i]), out) > 0.0f);
        }
        CHECK(inward == 0);
    };
    const glm::dvec3 middle(1, 2, 3);
    wedge::generator::ObjWriter box, rounded, ball;
    wedge::generator::texturedBox(box, middle, { 0.5, 0.4, 0.3 }, 1.0, wedge::generator::turn(30));
    check(box, 12, middle);
    wedge::generator::roundedBox(rounded, middle, { 0.5, 0.4, 0.3 }, 0.1, 2, 1.0, wedge::generator::turn(30));
    check(rounded, 300, middle);
    const std::vector<glm::dvec3> arc { { 0, -1, 0 }, { 0.7, -0.7, 0 }, { 1, 0, 0 }, { 0.7, 0.7, 0 }, { 0, 1, 0 } };
    wedge::generator::texturedSkin(ball,
        wedge::generator::placed(wedge::generator::turned(arc, 2, 12), wedge::generator::standing(middle)), { 1, 1 });
    check(ball, 2 * 12 * 7, middle); // 8 bands, of which those at the poles are of triangles
}
