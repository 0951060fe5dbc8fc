// Normal maps and height maps: the normals that they make, and light on these against closed forms and explicit
// normals.
#include "effects/environment/environment.h"
#include "host/render/environment_table.h"
#include "tests/image_means.h"
#include "tests/lamp_room.h"
#include "tests/render_oracles.h"

#include <doctest/doctest.h>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int side = 24;

std::uint32_t texel(int r, int g, int b)
{
    return static_cast<std::uint32_t>(r) | static_cast<std::uint32_t>(g) << 8 | static_cast<std::uint32_t>(b) << 16
        | 0xff000000u;
}

/// The texel of a direction in the tangent space.
std::uint32_t texelOf(glm::dvec3 n)
{
    const auto byte = [](double v) { return static_cast<int>(std::lround(127.5 * (v + 1))); };
    n = glm::normalize(n);
    return texel(byte(n.x), byte(n.y), byte(n.z));
}

/// The direction of a texel, of strength 1.
glm::dvec3 directionOf(std::uint32_t rgba)
{
    const auto coordinate = [&](int shift) { return ((rgba >> shift) & 255u) / 127.5 - 1; };
    return glm::normalize(glm::dvec3(coordinate(0), coordinate(8), coordinate(16)));
}

/// A normal map of one direction.
scene::Texture constantMap(std::uint32_t rgba) { return { "", 1, 1, { rgba }, false }; }

/// Tilted by 35 degrees, to where u and v go.
const std::uint32_t tilted = texelOf({ 0.5, 0.28, 0.82 });

void mapNormals(SceneBuilder& b, const scene::Texture& texture, bool heights = false, float strength = 1)
{
    b.scene.textures = { texture };
    scene::Material& m = b.scene.materials[0];
    m.normalTexture = 0;
    m.normalIsHeight = heights;
    m.normalStrength = strength;
}

void addSky(scene::Scene& scene, glm::vec3 sky)
{
    auto p = std::make_shared<render::EnvironmentPicture>();
    p->width = p->height = 1;
    p->radiance = { sky.x, sky.y, sky.z };
    render::setEnvironment(scene, p);
}

/// A floor at y = 0 with u along z and v along x, all that a camera sees from above and aside.
SceneBuilder floorFromAbove()
{
    SceneBuilder b;
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
    b.camera({ 0.5f, 3, 0.4f }, { 0, 0, 0 }, { 0, 0, 1 }, 5);
    return b;
}

/// A direction of the tangent space on that floor.
glm::dvec3 onFloor(glm::dvec3 n) { return { n.y, n.z, n.x }; }

/// Normals of a frame, pixel by pixel.
std::vector<glm::dvec3> normalsOf(
    const scene::Scene& scene, const device::Device& device, render::Traversal traversal = render::Traversal::Wide)
{
    render::Options options = renderOptions();
    options.traversal = traversal;
    render::Renderer renderer(scene, device, options);
    renderer.render(sized(render::monteCarlo(1), side, side), {}, true);
    const std::vector<float> planes = pixels(renderer, "normal", { 0, 0, side, side });
    std::vector<glm::dvec3> out;
    for (std::size_t i = 0; i < planes.size(); i += planes.size() / (side * side)) // those without maps lie behind
        out.emplace_back(planes[i], planes[i + 1], planes[i + 2]);
    return out;
}

void checkNormals(const std::vector<glm::dvec3>& normals, glm::dvec3 expected, double tolerance = 1e-5)
{
    double worst = 0;
    for (const glm::dvec3& n : normals)
        worst = std::max(worst, glm::length(n - expected));
    CAPTURE(glm::length(normals[0]));
    CHECK(worst < tolerance);
}

/// Sets the texture coordinates of each vertex to those of a linear function of its position.
template <class Map>
void setTexcoords(scene::Scene& scene, const Map& map)
{
    scene::Geometry& g = scene.geometry;
    for (std::size_t v = 0; v < g.positions.size() / 3; ++v) {
        const glm::vec2 uv = map(glm::vec3(g.positions[3 * v], g.positions[3 * v + 1], g.positions[3 * v + 2]));
        g.texcoords[2 * v] = uv.x;
        g.texcoords[2 * v + 1] = uv.y;
    }
}

} // namespace

TEST_CASE("mapped normals follow the texture's axes, mirrored, turned, sheared, and from behind")
{
    struct Axes {
        glm::dvec2 u, v; // of the texture over x and z
    };
    const Axes all[] = { { { 0, 1 }, { 1, 0 } }, { { 0, -1 }, { 1, 0 } }, { { 1, 0 }, { 0, 1 } },
        { { -3, 2 }, { 0.4, 0.7 } }, { { 0.02, 0 }, { 0.01, -0.01 } } };
    onEveryDevice([&](const device::Device& device) {
        for (const Axes& axes : all)
            for (const bool below : { false, true })
                for (const bool own : { false, true }) {
                    const bool isMirrored = below && own; // the mesh, by a transform
                    SceneBuilder b = floorFromAbove();
                    mapNormals(b, constantMap(tilted));
                    setTexcoords(b.scene, [&](glm::vec3 p) {
                        return glm::vec2(
                            glm::dot(axes.u, glm::dvec2(p.x, p.z)), glm::dot(axes.v, glm::dvec2(p.x, p.z)));
                    });
                    if (own) {
                        // Against the winding: the normals say where the outside is.
                        for (std::size_t i = 1; i < b.scene.geometry.normals.size(); i += 3)
                            b.scene.geometry.normals[i] = -1;
                    }
                    if (below)
                        b.scene.camera.eye.y *= -1;
                    if (isMirrored) {
                        scene::Geometry& g = b.scene.geometry;
                        for (std::size_t i = 0; i < g.positions.size(); i += 3)
                            g.positions[i] *= -1;
                        for (std::size_t i = 0; i < g.indices.size(); i += 3)
                            std::swap(g.indices[i], g.indices[i + 1]);
                    }
                    // Where u grows and v does not, and the other way round.
                    const double area = axes.u.x * axes.v.y - axes.u.y * axes.v.x;
                    const glm::dvec3 alongU(axes.v.y / area, 0, -axes.v.x / area),
                        alongV(-axes.u.y / area, 0, axes.u.x / area);
                    const glm::dvec3 t = glm::normalize(alongU),
                                     across = glm::normalize(alongV - t * glm::dot(t, alongV));
                    const glm::dvec3 up(0, own ? -1 : 1, 0), n = directionOf(tilted);
                    glm::dvec3 outside = n.x * t + n.y * across + n.z * up;
                    outside.x *= isMirrored ? -1 : 1;
                    const bool isOutside = below == own;
                    CAPTURE(axes.u.x);
                    CAPTURE(below);
                    CAPTURE(own);
                    checkNormals(normalsOf(b.scene, device), isOutside ? outside : -outside);
                }
    });
}

TEST_CASE("a linear ramp of heights is the tilted plane, and its strength scales slopes")
{
    constexpr int width = 16, height = 8;
    scene::Texture ramp { "", width, height, {}, false };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            ramp.rgba.push_back(texel(10 * x + 6 * y, 10 * x + 6 * y, 10 * x + 6 * y));
    onEveryDevice([&](const device::Device& device) {
        for (const float strength : { 1.0f, 12.0f, -12.0f }) {
            SceneBuilder b = floorFromAbove();
            // Its middle is seen, far from where it wraps.
            mapNormals(b, ramp, true, strength);
            const glm::dvec3 slopes(-strength * 10 / 255.0, -strength * 6 / 255.0, 1);
            checkNormals(normalsOf(b.scene, device), onFloor(glm::normalize(slopes)), 1e-4);
            b.scene.materials[0].normalIsHeight = false;
            b.scene.textures = { constantMap(tilted) };
            const glm::dvec3 n = directionOf(tilted);
            checkNormals(
                normalsOf(b.scene, device), onFloor(glm::normalize(glm::dvec3(strength * n.x, strength * n.y, n.z))));
        }
    });
}

TEST_CASE("without tangents there is no map: the bits are those of a scene without it")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene plain = smallScene();
        setTexcoords(plain, [](glm::vec3 p) { return glm::vec2(p.x + p.y, 2 * (p.x + p.y)); });
        scene::Scene mapped = plain;
        mapped.textures = { constantMap(tilted) };
        mapped.materials[0].normalTexture = 0;
        render::Renderer a(plain, device, renderOptions()), b(mapped, device, renderOptions());
        render::Settings settings = sized(render::axisAligned(16), side, side);
        settings.bounces = 1;
        CHECK(renderPixels(a, settings) == renderPixels(b, settings));
        CHECK(a.buildOptions().find("WEDGE_NORMAL_MAPS") == std::string::npos);
        CHECK(b.buildOptions().find("WEDGE_NORMAL_MAPS") != std::string::npos);
    });
}

TEST_CASE("a tilted normal under an even sky receives what lies above both horizons, in every kind of frame")
{
    const glm::vec3 sky(0.4f, 0.6f, 0.9f);
    onEveryDevice([&](const device::Device& device) {
        SceneBuilder b = floorFromAbove();
        mapNormals(b, constantMap(tilted));
        addSky(b.scene, sky);
        const auto share = static_cast<float>(0.5 + 0.5 * directionOf(tilted).z);
        const glm::vec3 expected = sky * b.scene.materials[0].diffuse * share;
        for (const auto traversal : { render::Traversal::Wide, render::Traversal::Scalar })
            for (const bool lens : { false, true }) {
                b.scene.camera.apertureRadius = lens ? 0.05f : 0.0f;
                render::Options options = renderOptions();
                options.traversal = traversal;
                render::Renderer renderer(b.scene, device, options);
                for (const bool filtered : { false, true }) {
                    CAPTURE(static_cast<int>(traversal));
                    CAPTURE(lens);
                    CAPTURE(filtered);
                    render::Settings s = sized(filtered ? render::axisAligned(64) : render::monteCarlo(64), side, side);
                    s.bounces = 1;
                    checkMean(renderPixels(renderer, s), expected, 3e-3);
                    s.antialias = true;
                    checkMean(renderPixels(renderer, s), expected, 3e-3);
                }
            }
    });
}

TEST_CASE("a tilted normal under a lamp receives the integral over it, where it moves, too")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = floorFromAbove();
        b.scene.camera.verticalFov = 0.2f;
        mapNormals(b, constantMap(tilted));
        // Partly below the horizon of the mapped normal.
        b.light({ -1.6f, 1, -0.2f }, { 0, 0, 0.4f }, { 0.3f, 0.6f, 0 }, scene::LightProfile::Uniform, 5).twoSided =
            true;
        const scene::AreaLight& light = b.scene.areaLights[0];
        const glm::dvec3 n = onFloor(directionOf(tilted));
        constexpr int steps = 400;
        double sum = 0;
        int below = 0;
        for (int i = 0; i < steps; ++i)
            for (int k = 0; k < steps; ++k) {
                const glm::dvec3 d = pointOf(light, 2 * (i + 0.5) / steps - 1, 2 * (k + 0.5) / steps - 1);
                sum += geometry(n, d, lightNormal(light), true) / 3.14159265358979;
                below += glm::dot(n, d) < 0 ? 1 : 0;
            }
        CHECK(below > steps * steps / 20);
        CHECK(below < steps * steps * 3 / 4);
        const glm::vec3 expected =
            static_cast<float>(5 * lightArea(light) * sum / (steps * steps)) * b.scene.materials[0].diffuse;
        for (const bool moving : { false, true }) {
            CAPTURE(moving);
            if (moving) {
                scene::Geometry& g = b.scene.geometry;
                g.positionsAtClose = g.positions;
                g.normalsAtClose = g.normals;
                for (std::size_t i = 0; i < g.positions.size(); i += 3)
                    g.positionsAtClose[i] += 0.5f;
                b.scene.shutterClose = 1;
                b.scene.camera.apertureRadius = 0.002f;
            }
            render::Renderer renderer(b.scene, device, renderOptions());
            checkMean(renderPixels(renderer, sized(render::monteCarlo(256), side, side)), expected, 4e-3);
            checkMean(renderPixels(renderer, sized(render::axisAligned(64), side, side)), expected, 6e-3);
        }
    });
}

TEST_CASE("a sphere by a normal map looks like a finely cut plane with a sphere's normals")
{
    constexpr int texels = 128, cells = 96;
    // Over [-1, 1]^2: a dome, flat outside.
    const auto dome = [](double x, double y) {
        const double r2 = x * x + y * y;
        return r2 < 0.8 ? glm::dvec3(x, y, std::sqrt(1 - r2)) : glm::dvec3(0, 0, 1);
    };
    scene::Texture map { "", texels, texels, {}, false };
    for (int y = 0; y < texels; ++y)
        for (int x = 0; x < texels; ++x)
            map.rgba.push_back(texelOf(dome(2 * (x + 0.5) / texels - 1, 2 * (y + 0.5) / texels - 1)));
    onEveryDevice([&](const device::Device& device) {
        SceneBuilder mapped, cut;
        for (SceneBuilder* b : { &mapped, &cut }) {
            b->scene.materials[0].specular = glm::vec3(0.3f);
            b->scene.materials[0].exponent = 10;
            b->light({ 1, 1.5f, 2 }, { 0.3f, 0, 0 }, { 0, 0.3f, 0 }, scene::LightProfile::Uniform, 5).twoSided = true;
            b->scene.directionalLights.push_back({ glm::normalize(glm::vec3(0.5f, -0.3f, -1)), glm::vec3(0.5f) });
            b->camera({ 0, 0, 2.5f }, { 0, 0, 0 }, { 0, 1, 0 }, 38);
        }
        mapped.quad({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 });
        mapNormals(mapped, map);
        const float half = 1.0f / cells;
        for (int y = 0; y < cells; ++y)
            for (int x = 0; x < cells; ++x)
                cut.quad({ -1 + static_cast<float>(2 * x + 1) * half, -1 + static_cast<float>(2 * y + 1) * half, 0 },
                    { half, 0, 0 }, { 0, half, 0 });
        scene::Geometry& g = cut.scene.geometry;
        for (std::size_t i = 0; i < g.positions.size(); i += 3) {
            const glm::dvec3 n = dome(g.positions[i], g.positions[i + 1]);
            for (int k = 0; k < 3; ++k)
                g.normals[i + static_cast<std::size_t>(k)] = static_cast<float>(n[k]);
        }
        render::Renderer a(mapped.scene, device, renderOptions()), b(cut.scene, device, renderOptions());
        const render::Settings settings = sized(render::monteCarlo(64), 48, 48);
        const std::vector<float> p = renderPixels(a, settings), q = renderPixels(b, settings);
        std::vector<float> differences;
        for (std::size_t i = 0; i < p.size(); ++i)
            differences.push_back(std::fabs(p[i] - q[i]));
        std::ranges::nth_element(differences, differences.begin() + static_cast<std::ptrdiff_t>(p.size() * 9 / 10));
        CHECK(differences[p.size() * 9 / 10] < 0.02f);
        CHECK(rmse(p, q) < 0.02);
        // Without the map it is another picture.
        mapped.scene.materials[0].normalTexture = -1;
        render::Renderer flat(mapped.scene, device, renderOptions());
        CHECK(rmse(renderPixels(flat, settings), q) > 0.05);
    });
}

TEST_CASE("no furnace makes bumps brighter than what is around, whatever the texels are")
{
    std::mt19937 random(3);
    scene::Texture noise { "", 8, 8, {}, false };
    for (int i = 0; i < 64; ++i)
        noise.rgba.push_back(static_cast<std::uint32_t>(random()) | 0xff000000u);
    onEveryDevice([&](const device::Device& device) {
        for (const bool heights : { false, true })
            for (const bool shiny : { false, true }) {
                SceneBuilder b;
                mapNormals(b, noise, heights, heights ? 3.0f : 1.0f);
                scene::Material& m = b.scene.materials[0];
                m.diffuse = glm::vec3(shiny ? 0.3f : 1.0f);
                m.specular = glm::vec3(shiny ? 0.7f : 0.0f);
                m.specularModel = scene::SpecularModel::Ggx;
                b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
                b.box({ -0.5f, 0, -0.5f }, { 0.5f, 1, 0.5f });
                b.camera({ 0.4f, 1.5f, 4.5f }, { 0, 0.4f, 0 });
                addSky(b.scene, glm::vec3(1));
                render::Renderer renderer(b.scene, device, renderOptions());
                render::Settings s = sized(render::monteCarlo(64), side, side);
                s.bounces = 8;
                const std::vector<float> image = renderPixels(renderer, s);
                const Mean mean = meanOf(image, 1);
                CAPTURE(mean.value);
                CHECK(notFinite(image) == 0);
                CHECK(mean.value <= 1 + 3 * mean.deviation);
                CHECK(mean.value > 0.4);
                if (!shiny)
                    CHECK(*std::ranges::max_element(image) < 1.2f);
            }
    });
}

TEST_CASE("what filters make of bumps has the mean of what paths find, and keeps them")
{
    constexpr int texels = 16;
    scene::Texture waves { "", texels, texels, {}, false };
    for (int y = 0; y < texels; ++y)
        for (int x = 0; x < texels; ++x)
            waves.rgba.push_back(texelOf({ 0.7 * std::sin(2 * 3.14159265358979 * x / texels),
                0.7 * std::sin(2 * 3.14159265358979 * y / texels), 1 }));
    onEveryDevice([&](const device::Device& device) {
        SceneBuilder b;
        mapNormals(b, waves);
        b.quad({ 0, 0, 0 }, { 0, 0, 2 }, { 2, 0, 0 });
        b.quad({ 0, 1, -1 }, { 2, 0, 0 }, { 0, 1, 0 });
        setTexcoords(b.scene, [](glm::vec3 p) { return glm::vec2(1.5f * p.x, 1.5f * (p.y - p.z)); });
        b.newObject();
        scene::Material grey;
        b.box({ -0.4f, 0.3f, -0.4f }, { 0.1f, 0.8f, 0.1f }, addMaterial(b, grey));
        b.light({ 0.8f, 2, 0.7f }, { 0.3f, 0, 0 }, { 0, 0, 0.3f }, scene::LightProfile::Gaussian, 12).twoSided = true;
        b.camera({ 0.4f, 1.2f, 2.4f }, { 0, 0.5f, -0.4f });
        for (const bool sky : { false, true }) {
            CAPTURE(sky);
            if (sky)
                addSky(b.scene, glm::vec3(0.3f, 0.35f, 0.5f));
            for (const bool lens : { false, true }) {
                CAPTURE(lens);
                b.scene.camera.apertureRadius = lens ? 0.01f : 0.0f;
                render::Renderer renderer(b.scene, device, renderOptions());
                const auto image = [&](bool filtered, int spp, std::uint32_t seed) {
                    render::Settings s = sized(filtered ? render::axisAligned(spp) : render::monteCarlo(spp), 48, 48);
                    s.bounces = 1;
                    s.seed = seed;
                    return renderPixels(renderer, s);
                };
                const std::vector<float> reference = image(false, 512, 77);
                double filtered = 0, plain = 0, meanFiltered = 0;
                for (std::uint32_t seed = 0; seed < 3; ++seed) {
                    const std::vector<float> f = image(true, 16, seed);
                    filtered += rmse(f, reference);
                    plain += rmse(image(false, 16, seed), reference);
                    meanFiltered += meanOf(f, 1).value / 3;
                }
                CHECK(meanFiltered == doctest::Approx(meanOf(reference, 1).value).epsilon(0.006));
                MESSAGE("error filtered over plain: ", filtered / plain);
                CHECK(filtered < 0.6 * plain);
            }
        }
    });
}
