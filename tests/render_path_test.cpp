// Path tracing against furnaces: closed rooms whose light has a closed form after any number of bounces.
#include "tests/render_path_support.h"

#include <array>
#include <functional>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double pi = std::numbers::pi;
constexpr int quadratureSteps = 240;
const glm::vec3 emitted { 1.0f, 0.5f, 0.25f };

/// Walls that emit are found by directions alone: where all do every path brings the same, and points on them would
/// vary.
render::Settings bounced(int spp, int bounces, int width, int height)
{
    render::Settings settings = sized(render::monteCarlo(spp), width, height);
    settings.bounces = bounces;
    settings.lightSampling = render::LightSampling::Directions;
    return settings;
}

/// A room of the one material, seen from within. full: with things in it.
SceneBuilder furnace(const scene::Material& material, bool full)
{
    SceneBuilder b;
    b.scene.materials[0] = material;
    b.scene.materials[0].emission = emitted;
    b.box({ -1, -1, -1 }, { 1, 1, 1 });
    if (full) {
        b.newObject();
        b.box({ -0.7f, -0.8f, -0.6f }, { -0.2f, -0.1f, 0.2f });
        b.newObject();
        b.sphere({ 0.4f, -0.3f, -0.4f }, 0.35f, 6);
        flatten(b.scene);
    }
    b.camera({ 0.3f, 0.4f, 0.8f }, { -0.2f, -0.5f, -0.6f }, { 0, 1, 0 }, 90);
    return b;
}

/// emitted x (1 + r + ... + r^(bounces + 1)) of each channel, for each pixel: what walls send each other is direct
/// light.
Moments series(glm::dvec3 r, int bounces, std::size_t values)
{
    std::vector<double> out;
    for (std::size_t i = 0; i < values; ++i) {
        const int c = static_cast<int>(i % 3);
        double sum = 0;
        for (int k = 0; k <= bounces + 1; ++k)
            sum += std::pow(r[c], k);
        out.push_back(emitted[c] * sum);
    }
    return exactly(std::move(out));
}

/// Of each value, relative to what is expected.
double worstError(std::span<const float> values, const Moments& expected)
{
    REQUIRE(values.size() == expected.size());
    double worst = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        worst = std::max(worst, std::fabs(values[i] / expected.mean[i] - 1));
    return worst;
}

/// A specular lobe's albedo of a view at that angle, at steps of 2 degrees.
class AlbedoTable {
public:
    explicit AlbedoTable(const scene::Material& material)
    {
        const shared::Lobe lobe = shared::makeLobe(material.exponent, modelOf(material));
        const shared::Vec3 n = shared::vec3(0, 0, 1);
        for (int i = 0; i <= 45; ++i) {
            const double angle = i * pi / 90;
            const shared::Vec3 v = polar(angle);
            const auto reflected = [&](shared::Vec3 l) {
                return l.z > 0 ? shared::lobeValue(lobe, n, v, l) * l.z : 0.0f;
            };
            table_.push_back(LobeGrid(polar(angle, pi)).midpoints(0, 1, 0, 1, reflected, quadratureSteps));
        }
    }
    double at(double cosine) const
    {
        const double place = std::min(44.999, std::acos(std::min(cosine, 1.0)) * 90 / pi);
        const auto i = static_cast<std::size_t>(place);
        return table_[i] + (place - static_cast<double>(i)) * (table_[i + 1] - table_[i]);
    }

private:
    std::vector<double> table_;
};

/// Cosine at the wall of the box [-1, 1]^3 that a ray from inside meets.
double cosineMet(glm::dvec3 from, glm::dvec3 direction)
{
    double nearest = 1e30, cosine = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double t = direction[axis] == 0 ? 1e30 : ((direction[axis] > 0 ? 1 : -1) - from[axis]) / direction[axis];
        if (t > 1e-6 && t < nearest) {
            nearest = t;
            cosine = std::fabs(direction[axis]);
        }
    }
    return cosine;
}

/// Radiance of the pixels of an empty furnace after one or two reflections, by quadrature over directions.
Moments glossyFurnace(render::Renderer& renderer, const render::Settings& settings, const AlbedoTable& albedo)
{
    const scene::Material& m = renderer.scene().materials[0];
    const image::Window all { 0, 0, settings.width, settings.height };
    renderer.render(settings, {}, true);
    const std::vector<float> position = pixels(renderer, "position", all);
    const std::vector<float> normal = pixels(renderer, "normal", all);
    const shared::Lobe lobe = shared::makeLobe(m.exponent, modelOf(m));
    std::vector<double> out;
    for (std::size_t i = 0; i < position.size(); i += 3) {
        const glm::dvec3 at(position[i], position[i + 1], position[i + 2]);
        const glm::dvec3 n(normal[i], normal[i + 1], normal[i + 2]);
        const glm::dvec3 view = glm::normalize(glm::dvec3(renderer.scene().camera.eye) - at);
        const glm::dvec3 kd(m.diffuse), ks(m.specular);
        const double own = albedo.at(glm::dot(n, view));
        glm::dvec3 reflected = kd + ks * own;
        if (settings.bounces == 1) {
            const shared::Vec3 sharedNormal = toVec3(n), sharedView = toVec3(view);
            const LobeGrid grid(toVec3(2 * glm::dot(n, view) * n - view));
            const auto overHemisphere = [&](const auto& f) { // of f x cosine x the albedo where the direction leads
                const auto integrand = [&](shared::Vec3 l) {
                    const double cosine = shared::vecDot(sharedNormal, l);
                    return cosine > 0 ? f(l) * cosine * albedo.at(cosineMet(at, { l.x, l.y, l.z })) : 0.0;
                };
                return grid.midpoints(0, 1, 0, 1, integrand, quadratureSteps);
            };
            const double byLambert = overHemisphere([](shared::Vec3) { return 1 / pi; });
            const double byLobe =
                overHemisphere([&](shared::Vec3 l) { return shared::lobeValue(lobe, sharedNormal, sharedView, l); });
            reflected += kd * kd + kd * ks * (byLambert + own) + ks * ks * byLobe;
        }
        for (int channel = 0; channel < 3; ++channel)
            out.push_back(emitted[channel] * (1 + reflected[channel]));
    }
    return exactly(std::move(out));
}

/// A one-colour texture of that sRGB value, and the linear value.
double addTexture(scene::Scene& scene, std::uint32_t level)
{
    scene::Texture texture;
    texture.width = texture.height = 2;
    texture.rgba.assign(4, level * 0x010101u | 0xff000000u);
    scene.textures.push_back(texture);
    const double x = level / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

} // namespace

TEST_CASE("a white furnace of Lambert surfaces is a geometric series, in each pixel")
{
    onEveryDevice([](const device::Device& device) {
        scene::Material material;
        material.diffuse = { 0.8f, 0.5f, 1.0f };
        for (const bool full : { false, true }) {
            const SceneBuilder b = furnace(material, full);
            render::Renderer renderer(b.scene, device, renderOptions());
            for (const int bounces : { 0, 1, 2 })
                for (const bool filtered : { false, true }) {
                    CAPTURE(full);
                    CAPTURE(bounces);
                    CAPTURE(filtered);
                    render::Settings settings = bounced(16, bounces, 24, 18);
                    if (filtered) {
                        settings = sized(render::axisAligned(16), 24, 18);
                        settings.bounces = bounces;
                        settings.lightSampling = render::LightSampling::Directions;
                    }
                    const std::vector<float> image = renderPixels(renderer, settings);
                    // Every path sends the same on, so nothing varies. A ray that left the room would show.
                    CHECK(worstError(image, series(material.diffuse, bounces, image.size())) < 1e-5);
                }
        }
    });
}

TEST_CASE("a white furnace of textured surfaces")
{
    onEveryDevice([](const device::Device& device) {
        scene::Material material;
        material.diffuse = { 0.9f, 0.7f, 0.5f };
        SceneBuilder b = furnace(material, true);
        scene::Material& m = b.scene.materials[0];
        const double reflects = addTexture(b.scene, 188), emits = addTexture(b.scene, 230);
        m.diffuseTexture = 0;
        m.emissionTexture = 1;
        m.emission /= static_cast<float>(emits);
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const int bounces : { 0, 1 }) {
            const std::vector<float> image = renderPixels(renderer, bounced(16, bounces, 24, 18));
            CHECK(worstError(image, series(reflects * glm::dvec3(m.diffuse), bounces, image.size())) < 1e-4);
        }

        // Of two colours, each pixel reflects by its own.
        b.scene.textures[0].rgba = { 0xff203040u, 0xffc0e0ffu, 0xffc0e0ffu, 0xff203040u };
        render::Renderer checked(b.scene, device, renderOptions());
        const std::vector<float> image = renderPixels(checked, bounced(16, 0, 24, 18), true);
        const std::vector<float> kd = pixels(checked, "albedo", { 0, 0, 24, 18 });
        double worst = 0, least = 1, most = 0;
        for (std::size_t i = 0; i < image.size(); ++i) {
            worst = std::max(worst, std::fabs(image[i] / (emitted[static_cast<int>(i % 3)] * (1.0 + kd[i])) - 1));
            least = std::min(least, static_cast<double>(kd[i]));
            most = std::max(most, static_cast<double>(kd[i]));
        }
        CHECK(worst < 1e-4);
        CHECK(most - least > 0.3);
    });
}

TEST_CASE("a furnace of glossy surfaces: one and two reflections by quadrature")
{
    onEveryDevice([](const device::Device& device) {
        for (const scene::SpecularModel model : { scene::SpecularModel::Phong, scene::SpecularModel::BlinnPhong })
            for (const float exponent : { 4.0f, 50.0f }) {
                scene::Material material;
                material.diffuse = { 0.5f, 0.3f, 0.0f };
                material.specular = { 0.3f, 0.6f, 1.0f };
                material.exponent = exponent;
                material.specularModel = model;
                const AlbedoTable albedo(material);
                const SceneBuilder b = furnace(material, false);
                render::Renderer renderer(b.scene, device, renderOptions());
                for (const int bounces : { 0, 1 }) {
                    CAPTURE(static_cast<int>(model));
                    CAPTURE(exponent);
                    CAPTURE(bounces);
                    const render::Settings settings = bounced(256, bounces, 6, 4);
                    checkAgreement(
                        moments(renderer, settings, Part::Beauty, 8), glossyFurnace(renderer, settings, albedo), 3e-4);
                }
            }
    });
}

TEST_CASE("Russian roulette leaves the mean of long paths alone")
{
    onEveryDevice([](const device::Device& device) {
        scene::Material material;
        material.diffuse = { 0.8f, 0.5f, 0.3f };
        const SceneBuilder b = furnace(material, false);
        render::Renderer renderer(b.scene, device, renderOptions());
        const Moments image = moments(renderer, bounced(128, 30, 12, 9), Part::Beauty, 8);
        checkAgreement(image, series(material.diffuse, 30, image.size()), 1e-5);
        // It is played: red paths end early and late, so their sums vary.
        CHECK(*std::ranges::max_element(image.variance) > 0);

        // Where nothing is lost, it is not.
        material.diffuse = glm::vec3(1);
        const SceneBuilder white = furnace(material, false);
        render::Renderer whiteRenderer(white.scene, device, renderOptions());
        const std::vector<float> whiteImage = renderPixels(whiteRenderer, bounced(4, 30, 12, 9));
        CHECK(worstError(whiteImage, series(glm::dvec3(1), 30, whiteImage.size())) < 1e-4);
    });
}

TEST_CASE("an integrating sphere: light is everywhere the same, and in a white one none is lost")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.scene.materials[0].diffuse = { 1.0f, 0.9f, 0.5f };
        b.sphere({ 0, 0, 0 }, 1, 40);
        flatten(b.scene);
        // A cap of it glows, behind the camera.
        b.scene.materials.push_back(b.scene.materials[0]);
        b.scene.materials[1].emission = glm::vec3(3);
        double cap = 0, all = 0;
        for (std::size_t i = 0; i < b.scene.geometry.materialIds.size(); ++i) {
            std::array<glm::dvec3, 3> corner;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t v = 3 * b.scene.geometry.indices[3 * i + k];
                const std::vector<float>& p = b.scene.geometry.positions;
                corner[k] = { p[v], p[v + 1], p[v + 2] };
            }
            const double area = 0.5 * glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
            const bool glows = (corner[0] + corner[1] + corner[2]).z > 3 * 0.8;
            b.scene.geometry.materialIds[i] = glows ? 1 : 0;
            all += area;
            cap += glows ? area : 0;
        }
        b.camera({ 0, 0, 0.5f }, { 0, 0, -1 }, { 0, 1, 0 }, 80);
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const int bounces : { 0, 3, 19 }) {
            CAPTURE(bounces);
            const Moments image = moments(renderer, bounced(64, bounces, 12, 12), Part::Beauty, 4);
            std::vector<double> expected;
            for (std::size_t i = 0; i < image.size(); ++i) {
                const double r = b.scene.materials[0].diffuse[static_cast<int>(i % 3)];
                double sum = 0;
                for (int k = 1; k <= bounces + 1; ++k)
                    sum += std::pow(r, k);
                expected.push_back(3 * cap / all * sum);
            }
            // Facets: the sphere is round to a few parts in a thousand.
            checkAgreement(image, exactly(std::move(expected)), 5e-3);
        }
    });
}
