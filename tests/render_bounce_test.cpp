// One bounce of light against closed forms and quadrature, ambient occlusion, and ways to find lights against each
// other.
#include "tests/render_oracles.h"
#include "tests/render_path_support.h"

#include <functional>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double pi = std::numbers::pi;
constexpr int width = 6, height = 4;

/// A patch at the origin, its normal y, so small that all pixels see the same.
SceneBuilder patch()
{
    SceneBuilder b;
    b.scene.materials[0].diffuse = { 0.8f, 0.6f, 0.4f };
    b.quad({ 0, 0, 0 }, { 0, 0, 0.004f }, { 0.004f, 0, 0 });
    b.camera({ 0.3f, 0.5f, 0.2f }, { 0, 0, 0 }, { 0, 1, 0 }, 0.2f);
    b.newObject();
    return b;
}

/// A regular polygon about the y axis at that height, its area that of a disk.
void addDisk(SceneBuilder& b, float at, float radius, std::uint32_t material)
{
    constexpr int corners = 96;
    const double step = 2 * pi / corners, round = radius * std::sqrt(step / std::sin(step));
    const auto corner = [&](int i) { return glm::vec3(round * std::cos(step * i), at, round * std::sin(step * i)); };
    for (int i = 0; i < corners; ++i)
        b.triangle({ 0, at, 0 }, corner(i), corner(i + 1), material);
}

std::uint32_t addMaterial(SceneBuilder& b, glm::vec3 diffuse)
{
    scene::Material material;
    material.diffuse = diffuse;
    b.scene.materials.push_back(material);
    return static_cast<std::uint32_t>(b.scene.materials.size() - 1);
}

render::Settings settingsOf(int spp, int bounces)
{
    render::Settings settings = sized(render::monteCarlo(spp), width, height);
    settings.bounces = bounces;
    return settings;
}

Moments everywhere(glm::dvec3 colour)
{
    std::vector<double> values;
    for (int i = 0; i < width * height; ++i)
        values.insert(values.end(), { colour.x, colour.y, colour.z });
    return exactly(std::move(values));
}

/// How much of a point's cosine-weighted hemisphere a coaxial disk covers.
double diskFactor(double at, double radius) { return radius * radius / (radius * radius + at * at); }

/// The same for a rectangle of half sizes a, b, centred above.
double rectangleFactor(double at, double a, double b)
{
    const double x = a / at, y = b / at, sx = std::sqrt(1 + x * x), sy = std::sqrt(1 + y * y);
    return 2 / pi * (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy));
}

/// A wall to the left of the patch, and lights of every kind before it.
SceneBuilder litWall(bool glossy)
{
    SceneBuilder b = patch();
    const std::uint32_t wall = addMaterial(b, { 0.5f, 0.6f, 0.7f });
    if (glossy) {
        b.scene.materials[0].specular = { 0.3f, 0.5f, 0.7f };
        b.scene.materials[0].exponent = 10;
        b.scene.materials[wall].specular = { 0.6f, 0.4f, 0.2f };
        b.scene.materials[wall].exponent = 8;
        b.scene.materials[wall].specularModel = scene::SpecularModel::Phong;
    }
    b.quad({ -0.5f, 1, 0 }, { 0, 0.9f, 0 }, { 0, 0, 1 }, wall);
    // Large and near, so that directions find them as often as points on them are chosen.
    b.light({ 0.1f, 1.3f, 0.2f }, { 0, 0.8f, 0 }, { 0.1f, 0, -0.9f }, scene::LightProfile::Gaussian, 4).radiance = { 4,
        2, 1 };
    b.light({ 0.2f, 2.2f, -0.3f }, { 0.7f, 0, 0 }, { 0, -0.4f, 0.6f }, scene::LightProfile::Uniform, 3).twoSided = true;
    b.scene.pointLights.push_back({ { 0.5f, 1.2f, 0.4f }, { 0.2f, 0.5f, 1 } });
    b.scene.directionalLights.push_back({ glm::normalize(glm::vec3(-1, -0.3f, 0.2f)), { 0.5f, 1, 0.2f } });
    return b;
}

/// Radiance that a point of the wall sends in direction `out`, by a grid over each area light.
glm::dvec3 wallRadiance(const scene::Scene& scene, glm::dvec3 at, glm::dvec3 out)
{
    constexpr int steps = 16;
    const scene::Material& m = scene.materials[1];
    const glm::dvec3 n(1, 0, 0);
    glm::dvec3 sum(0);
    for (const scene::AreaLight& light : scene.areaLights)
        for (int i = 0; i < steps * steps; ++i) {
            const int column = i % steps, row = i / steps;
            const double a = 2 * (column + 0.5) / steps - 1, b = 2 * (row + 0.5) / steps - 1;
            const glm::dvec3 d = pointOf(light, a, b) - at;
            sum += glm::dvec3(light.radiance)
                * (profileAt(light, a, b) * geometry(n, d, lightNormal(light), light.twoSided) * lightArea(light)
                    / (steps * steps))
                * reflectance(m, n, out, glm::normalize(d));
        }
    for (const scene::PointLight& light : scene.pointLights) {
        const glm::dvec3 d = glm::dvec3(light.position) - at, l = glm::normalize(d);
        sum +=
            glm::dvec3(light.intensity) * (std::max(0.0, glm::dot(n, l)) / glm::dot(d, d)) * reflectance(m, n, out, l);
    }
    for (const scene::DirectionalLight& light : scene.directionalLights) {
        const glm::dvec3 l = -glm::dvec3(light.direction);
        sum += glm::dvec3(light.irradiance) * std::max(0.0, glm::dot(n, l)) * reflectance(m, n, out, l);
    }
    return sum;
}

/// What the patch reflects of that towards the camera.
glm::dvec3 patchRadiance(const scene::Scene& scene)
{
    constexpr int steps = 48;
    const glm::dvec3 n(0, 1, 0), view = glm::normalize(glm::dvec3(scene.camera.eye));
    glm::dvec3 sum(0);
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
            const glm::dvec3 at(-0.5, 0.1 + 1.8 * (i + 0.5) / steps, 2 * (k + 0.5) / steps - 1);
            const glm::dvec3 l = glm::normalize(at);
            sum += wallRadiance(scene, at, -l) * reflectance(scene.materials[0], n, view, l)
                * (geometry(n, at, { 1, 0, 0 }, false) * 1.8 * 2 / (steps * steps));
        }
    return sum;
}

/// The box of data/scenes/cornell.toml, with a light of each other kind.
scene::Scene cornell(bool glossy)
{
    const char* data = std::getenv("WEDGE_TEST_DATA");
    scene::Scene scene = scene::loadScene((data != nullptr ? std::string(data) : "data") + "/scenes/cornell.toml");
    scene::AreaLight second = scene.areaLights.at(0);
    second.centre = { -0.6f, 1.2f, 0.6f };
    second.halfU = { 0.2f, 0, 0 };
    second.halfV = { 0, 0.15f, 0.1f };
    second.profile = scene::LightProfile::Gaussian;
    second.twoSided = true;
    second.radiance = { 3, 6, 9 };
    scene.areaLights.push_back(second);
    scene.pointLights.push_back({ { 0.6f, 1.5f, 0.5f }, { 0.3f, 0.3f, 0.3f } });
    if (glossy)
        for (std::size_t i = 0; i < scene.materials.size(); ++i) {
            scene::Material& m = scene.materials[i];
            m.specular = 0.6f * m.diffuse;
            m.diffuse *= 0.4f;
            m.exponent = 20;
            m.specularModel = i % 2 == 0 ? scene::SpecularModel::Phong : scene::SpecularModel::BlinnPhong;
        }
    return scene;
}

} // namespace

TEST_CASE("one bounce from a disk lit from below, and direct light of a rectangle that glows")
{
    onEveryDevice([](const device::Device& device) {
        for (const float radius : { 0.5f, 1.0f, 3.0f }) {
            CAPTURE(radius);
            SceneBuilder b = patch();
            const glm::dvec3 kd(b.scene.materials[0].diffuse), rho(0.9, 0.7, 0.5);
            addDisk(b, 0.8f, radius, addMaterial(b, rho));
            // Aslant, so that the patch's shadow falls where it does not matter; of three, which a path chooses from.
            glm::dvec3 irradiance(0);
            for (const glm::vec3 towards : { glm::vec3(1, 1, 0), glm::vec3(0, 2, 1), glm::vec3(-1, 3, -1) }) {
                const glm::vec3 colour = glm::abs(towards) + 0.5f, direction = glm::normalize(towards);
                b.scene.directionalLights.push_back({ direction, colour });
                irradiance += glm::dvec3(colour) * static_cast<double>(direction.y);
            }
            render::Renderer renderer(b.scene, device, renderOptions());
            checkAgreement(moments(renderer, settingsOf(256, 1), Part::Indirect, 8),
                everywhere(kd * rho * irradiance / pi * diskFactor(0.8, radius)), 1e-3);
        }
        for (const float half : { 0.5f, 2.0f, 3000.0f }) { // the last one is as good as endless: E = pi L
            CAPTURE(half);
            SceneBuilder b = patch();
            const std::uint32_t glow = addMaterial(b, { 0, 0, 0 });
            b.scene.materials[glow].emission = { 2, 1, 3 };
            b.quad({ 0, 1.5f, 0 }, { half, 0, 0 }, { 0, 0, 2 * half }, glow);
            render::Renderer renderer(b.scene, device, renderOptions());
            const double factor = rectangleFactor(1.5, half, 2 * half);
            CHECK((half < 1000 || std::fabs(factor - 1) < 1e-5));
            checkAgreement(moments(renderer, settingsOf(256, 0), Part::Beauty, 8),
                everywhere(glm::dvec3(b.scene.materials[0].diffuse) * glm::dvec3(2, 1, 3) * factor), 1e-3);
        }
    });
}

TEST_CASE("ambient occlusion: a point under a disk sees what the disk leaves open, as far as it looks")
{
    onEveryDevice([](const device::Device& device) {
        for (const float radius : { 0.3f, 1.0f, 5.0f })
            for (const float reach : { 0.0f, 0.5f, 1.2f }) { // the disk is at 0.7
                CAPTURE(radius);
                CAPTURE(reach);
                SceneBuilder b = patch();
                b.scene.materials[0].diffuse = glm::vec3(0.1f); // which does not matter
                addDisk(b, 0.7f, radius, 0);
                render::Renderer renderer(b.scene, device, renderOptions());
                render::Settings settings = settingsOf(256, 0);
                settings.integrator = render::Integrator::AmbientOcclusion;
                settings.indirect.ambientDistance = reach;
                double within = radius;
                if (reach > 0)
                    within = std::min(within, std::sqrt(std::max(0.0, reach * reach - 0.49)));
                const Moments open = everywhere(glm::dvec3(1 - diskFactor(0.7, within)));
                checkAgreement(moments(renderer, settings, Part::Indirect, 8), open, 1e-3);
                checkAgreement(moments(renderer, settings, Part::Beauty, 8), open, 1e-3);
            }
    });
}

TEST_CASE("one bounce from a wall under lights of every kind agrees with quadrature, however lights are found")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool glossy : { false, true }) {
            const SceneBuilder b = litWall(glossy);
            const Moments expected = everywhere(patchRadiance(b.scene));
            render::Renderer renderer(b.scene, device, renderOptions());
            for (const auto way :
                { render::LightSampling::Both, render::LightSampling::Lights, render::LightSampling::Directions })
                for (const auto sampler : { render::Sampler::Sobol, render::Sampler::Stratified }) {
                    CAPTURE(glossy);
                    CAPTURE(static_cast<int>(way));
                    CAPTURE(static_cast<int>(sampler));
                    render::Settings settings = settingsOf(400, 1);
                    settings.lightSampling = way;
                    settings.sampler = sampler;
                    checkAgreement(moments(renderer, settings, Part::Indirect, 8), expected, 1e-3);
                }
        }
    });
}

TEST_CASE("lights found by points on them, by directions and by both give one image in a Cornell box")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool glossy : { false, true }) {
            const scene::Scene scene = cornell(glossy);
            render::Renderer renderer(scene, device, renderOptions());
            for (const int bounces : { 1, 2, 5 }) {
                CAPTURE(glossy);
                CAPTURE(bounces);
                const auto image = [&](render::LightSampling way) {
                    render::Settings settings = sized(render::monteCarlo(25), 20, 20);
                    settings.bounces = bounces;
                    settings.lightSampling = way;
                    return moments(renderer, settings, Part::Indirect, 8);
                };
                const Moments both = image(render::LightSampling::Both);
                const Moments lights = image(render::LightSampling::Lights);
                const Moments directions = image(render::LightSampling::Directions);
                checkAgreement(lights, both);
                checkAgreement(directions, both);
                checkAgreement(directions, lights);
                CHECK(both.average() > 0.01);
            }
        }
    });
}

TEST_CASE("a light close to a coarse mesh of smooth normals is one, however it is found, and as without samples")
{
    // Shadow rays start where the curved surface would be, off the triangles: the light is not to look nearer from
    // there.
    onEveryDevice([](const device::Device& device) {
        for (const bool glossy : { false, true }) {
            SceneBuilder b;
            if (glossy) {
                b.scene.materials[0].specular = glm::vec3(0.4f);
                b.scene.materials[0].exponent = 20;
            }
            b.newObject();
            b.sphere({ 0, 0, 0 }, 1, 5);
            b.light({ 0.05f, 1.1f, 0 }, { 0.2f, 0, 0 }, { 0, 0, 0.2f }, scene::LightProfile::Uniform, 1);
            b.camera({ 0, 2.5f, 2.5f }, { 0, 1, 0 }, { 0, 1, 0 }, 6);
            render::Renderer renderer(b.scene, device, renderOptions());
            const auto image = [&](render::Settings settings, render::LightSampling way) {
                settings = sized(settings, 16, 16);
                settings.lightSampling = way;
                return moments(renderer, settings, Part::Beauty, 8);
            };
            const Moments points = image(render::monteCarlo(1024), render::LightSampling::Lights);
            render::Settings ratio = render::axisAligned(1024);
            ratio.filtering = render::Filtering::None;
            CAPTURE(glossy);
            CHECK(points.average() > 0.1);
            checkAgreement(image(render::monteCarlo(1024), render::LightSampling::Directions), points, 1e-3);
            checkAgreement(image(render::monteCarlo(1024), render::LightSampling::Both), points, 1e-3);
            checkAgreement(image(ratio, render::LightSampling::Both), points, 1e-3);
        }
    });
}

TEST_CASE("where reflected directions begin to help points on a light there is no seam")
{
    // They are followed where they are as dense as the points: within a circle under a light, and of a sharp lobe where
    // it is narrower than the light. Some of a packet's receivers are in, some are out.
    onEveryDevice([](const device::Device& device) {
        for (const float exponent : { 0.0f, 30.0f }) {
            SceneBuilder b;
            if (exponent > 0) {
                b.scene.materials[0].specular = glm::vec3(0.4f);
                b.scene.materials[0].exponent = exponent;
            }
            b.newObject();
            b.quad({ 0, 0, 0 }, { 4, 0, 0 }, { 0, 0, -4 });
            b.light({ 0, 0.45f, 0 }, { 0.25f, 0, 0 }, { 0, 0, 0.25f }, scene::LightProfile::Uniform, 1);
            b.camera({ 0, 2, 1.2f }, { 0, 0, -0.1f }, { 0, 1, 0 }, 40);
            render::Renderer renderer(b.scene, device, renderOptions());
            const auto image = [&](render::LightSampling way) {
                render::Settings settings = sized(render::monteCarlo(256), 32, 32);
                settings.lightSampling = way;
                return moments(renderer, settings, Part::Beauty, 8);
            };
            const Moments points = image(render::LightSampling::Lights), both = image(render::LightSampling::Both);
            CAPTURE(exponent);
            CHECK(points.average() > 0.01);
            checkAgreement(both, points, 1e-3);
        }
    });
}

TEST_CASE("points exactly on the edge of two walls do not see past either")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = cornell(false);
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings settings = sized(render::monteCarlo(64), 512, 512);
        settings.crop = { 0, 0, 64, 64 };
        settings.integrator = render::Integrator::AmbientOcclusion;
        settings.indirect.ambientDistance = 0.5f;
        renderer.render(settings);
        const auto open =
            planesOf(renderer.frame().layout, renderer.frame().planes("beauty").downloadAll(renderer.queue()));
        const auto object =
            planesOf(renderer.frame().layout, renderer.frame().counts("objectId").downloadAll(renderer.queue()));
        // The edge of ceiling and wall runs along the image's diagonal, through the pixels' very centres.
        int onEdge = 0;
        for (int i = 0; i < 64; ++i) {
            CAPTURE(i);
            onEdge += object.at(i, i) != 0 ? 1 : 0;
            CHECK(open.at(i, i) < 0.8f);
        }
        CHECK(onEdge > 40);
    });
}
