// Materials against integrals of their reflection in double, by every method and kind of frame.
#include "kernels/shared/bsdf.h"
#include "tests/glass_support.h"
#include "tests/image_means.h"
#include "tests/lobe_grid.h"
#include "tests/render_oracles.h"
#include "tests/render_support.h"

#include <doctest/doctest.h>

using namespace wedge;
using namespace wedge::test;

namespace {

scene::Material ggx(float roughness, glm::vec3 diffuse, glm::vec3 specular)
{
    scene::Material m;
    m.specularModel = scene::SpecularModel::Ggx;
    m.roughness = roughness;
    m.diffuse = diffuse;
    m.specular = specular;
    return m;
}

shared::Lobe lobeOf(const scene::Material& m)
{
    return shared::lobeOf(shared::microfacetGloss(m.roughness, toVec3(m.diffuse), toVec3(m.specular)));
}

/// A floor at y = 0, all that a camera sees that is `angle` from its normal, in a narrow field of view.
SceneBuilder floorSeenAt(const scene::Material& material, double angle)
{
    SceneBuilder b;
    b.scene.materials[0] = material;
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
    const glm::vec3 away(static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle)), 0);
    b.camera(3.0f * away, { 0, 0, 0 }, { 0, 0, 1 }, 0.2f);
    return b;
}

render::Settings settings(bool filtered, int spp)
{
    return sized(filtered ? render::axisAligned(spp) : render::monteCarlo(spp), 24, 24);
}

constexpr render::LightSampling samplings[] = { render::LightSampling::Both, render::LightSampling::Lights,
    render::LightSampling::Directions };

} // namespace

TEST_CASE("microfacets under an even sky reflect their albedo of it, in every kind of frame")
{
    onEveryDevice([](const device::Device& device) {
        for (const float roughness : { 0.1f, 0.4f, 1.0f })
            for (const double angle : { 0.2, 1.2 }) {
                const scene::Material material =
                    ggx(roughness, glm::vec3(0.5f, 0.3f, 0.1f), glm::vec3(0.04f, 0.2f, 0.4f));
                const shared::Vec3 v = polar(angle), up = shared::vec3(0, 0, 1);
                const shared::Lobe lobe = lobeOf(material);
                const double albedo = LobeGrid(shared::vec3(-v.x, 0, v.z)).overSphere([&](shared::Vec3 l) {
                    return l.z > 0 ? shared::lobeValue(lobe, up, v, l) * l.z : 0.0f;
                });
                const glm::vec3 expected = even * (material.diffuse + static_cast<float>(albedo) * material.specular);
                SceneBuilder b = floorSeenAt(material, angle);
                addSky(b.scene, { even });
                for (const bool lens : { false, true }) {
                    b.scene.camera.apertureRadius = lens ? 0.005f : 0.0f;
                    render::Renderer renderer(b.scene, device, renderOptions());
                    for (const bool filtered : { false, true }) {
                        CAPTURE(roughness);
                        CAPTURE(angle);
                        CAPTURE(lens);
                        CAPTURE(filtered);
                        checkMean(renderPixels(renderer, settings(filtered, 256)), expected, filtered ? 0.01 : 2e-3);
                    }
                }
            }
    });
}

TEST_CASE("microfacets under a lamp reflect its integral over lobe and cosine, by each technique and by filters")
{
    onEveryDevice([](const device::Device& device) {
        for (const float roughness : { 0.1f, 0.35f, 0.8f }) {
            const double angle = 0.9;
            const scene::Material material = ggx(roughness, glm::vec3(0.1f), glm::vec3(0.3f, 0.5f, 0.8f));
            SceneBuilder b = floorSeenAt(material, angle);
            // Where the mirrored view goes, but for a little.
            b.light({ -1.5f, 1.3f, 0.1f }, { 0, 0, 0.4f }, { 0.25f, 0.3f, 0 }, scene::LightProfile::Uniform, 5)
                .twoSided = true;
            const scene::AreaLight& light = b.scene.areaLights[0];
            const shared::Lobe lobe = lobeOf(material);
            const shared::Vec3 up = shared::vec3(0, 1, 0),
                               v = shared::vec3(
                                   static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle)), 0);
            constexpr int steps = 400;
            double matt = 0, shiny = 0;
            for (int i = 0; i < steps; ++i)
                for (int k = 0; k < steps; ++k) {
                    const glm::dvec3 d = pointOf(light, 2 * (i + 0.5) / steps - 1, 2 * (k + 0.5) / steps - 1);
                    const double g = geometry({ 0, 1, 0 }, d, lightNormal(light), true);
                    matt += g / 3.14159265358979;
                    shiny += g * shared::lobeValue(lobe, up, v, toVec3(glm::vec3(glm::normalize(d))));
                }
            const double scale = 5 * lightArea(light) / (steps * steps);
            const glm::vec3 expected = static_cast<float>(matt * scale) * material.diffuse
                + static_cast<float>(shiny * scale) * material.specular;
            CAPTURE(roughness);
            for (const bool lens : { false, true }) {
                CAPTURE(lens);
                b.scene.camera.apertureRadius = lens ? 0.005f : 0.0f;
                render::Renderer renderer(b.scene, device, renderOptions());
                for (const render::LightSampling sampling : samplings) {
                    // Directions alone find no lamp in frames with a lens, whatever the material.
                    if (lens && sampling == render::LightSampling::Directions)
                        continue;
                    CAPTURE(static_cast<int>(sampling));
                    render::Settings s = settings(false, 256);
                    s.lightSampling = sampling;
                    checkMean(renderPixels(renderer, s), expected, 4e-3);
                }
                checkMean(renderPixels(renderer, settings(true, 64)), expected, 0.01);
            }
        }
    });
}

TEST_CASE("microfacets: what filters make has the mean of what paths find, under a lamp and a sky")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.scene.materials[0] = ggx(0.5f, glm::vec3(0.5f), glm::vec3(0.04f));
        b.scene.materials.push_back(ggx(0.3f, glm::vec3(0.0f), glm::vec3(0.9f, 0.6f, 0.3f)));
        b.newObject();
        b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
        b.newObject();
        b.box({ -0.9f, 0, -0.5f }, { -0.2f, 0.6f, 0.0f });
        b.newObject();
        b.sphere({ 0.4f, 0.4f, 0.5f }, 0.4f, 24, 1);
        b.light({ 0.2f, 3, 0.3f }, { 0.5f, 0, 0 }, { 0, 0, 0.5f }, scene::LightProfile::Gaussian, 8).twoSided = true;
        b.camera({ 0, 1.2f, 3 }, { 0, 0.2f, 0 });
        addSky(b.scene, { even });
        for (const bool lens : { false, true }) {
            CAPTURE(lens);
            b.scene.camera.apertureRadius = lens ? 0.02f : 0.0f;
            render::Renderer renderer(b.scene, device, renderOptions());
            render::Settings filtered = sized(render::axisAligned(64), 48, 48),
                             plain = sized(render::monteCarlo(64), 48, 48);
            filtered.bounces = plain.bounces = 2;
            CHECK(meanOverSeeds(renderer, filtered, 6)
                == doctest::Approx(meanOverSeeds(renderer, plain, 6)).epsilon(0.006));
        }
    });
}

TEST_CASE("microfacets: no furnace makes them brighter than what is around, and little is lost where they are smooth")
{
    onEveryDevice([](const device::Device& device) {
        for (const float roughness : { 0.15f, 1.0f }) {
            SceneBuilder b;
            b.scene.materials[0] = ggx(roughness, glm::vec3(0.0f), glm::vec3(1.0f));
            b.scene.materials.push_back(ggx(roughness, glm::vec3(0.9f), glm::vec3(0.1f)));
            b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
            b.sphere({ 0, 0.6f, 0 }, 0.5f, 24, 1);
            b.camera({ 0, 1.5f, 4.5f }, { 0, 0.4f, 0 });
            addSky(b.scene, { even });
            render::Renderer renderer(b.scene, device, renderOptions());
            render::Settings s = settings(false, 256);
            s.bounces = 32;
            const Mean mean = meanOf(renderPixels(renderer, s), 1);
            CAPTURE(mean.value);
            CHECK(mean.value <= even.y + 3 * mean.deviation);
            CHECK(mean.value > (roughness < 1 ? 0.97 : 0.7) * even.y);
        }
    });
}

TEST_CASE("a coarse ball of smooth microfacets in an even sky is seen nowhere, its rim neither, nor in a mirror")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool mirrored : { false, true })
            for (const float roughness : { 0.0f, 0.05f, 0.1f }) {
                CAPTURE(mirrored);
                CAPTURE(roughness);
                SceneBuilder b;
                b.scene.materials[0] = ggx(roughness, glm::vec3(0), glm::vec3(1));
                b.sphere({ 0, 0, 0 }, 1, 24);
                b.camera({ 0, 0, 4 }, { 0, 0, 0 }, { 0, 1, 0 }, 30);
                if (mirrored) {
                    b.quad({ 0, 0, 4 }, { 1, 0, 0 }, { 0, 1, 0 }, addMaterial(b, mirror()));
                    b.camera({ 0, 0, 3.9f }, { 0, 0, 8 }, { 0, 1, 0 }, 30);
                }
                addSky(b.scene, { even });
                render::Renderer renderer(b.scene, device, renderOptions());
                render::Settings s = sized(render::monteCarlo(64), 160, 120);
                // The middle of the ball is seen in the mirror again and again; that takes bounces.
                s.bounces = mirrored ? 8 : 1;
                const std::vector<float> image = renderPixels(renderer, s);
                REQUIRE(notFinite(image) == 0);
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    float least = 1e9f;
                    for (std::size_t i = channel; i < image.size(); i += 3)
                        least = std::min(least, image[i]);
                    CHECK(least > 0.85f * even[static_cast<int>(channel)]);
                }
                CHECK(meanOf(image, 0).value == doctest::Approx(even.x).epsilon(2e-3));
            }
    });
}

TEST_CASE("a white plate below a coarse ball of smooth microfacets in an even sky is as bright as the sky")
{
    onEveryDevice([](const device::Device& device) {
        for (const float roughness : { 0.0f, 0.1f }) {
            CAPTURE(roughness);
            SceneBuilder b;
            b.scene.materials[0].diffuse = glm::vec3(1);
            b.quad({ 0, 0, 0 }, { 0, 0, 0.01f }, { 0.01f, 0, 0 });
            b.newObject();
            b.sphere({ 0, 1.2f, 0 }, 1, 6, addMaterial(b, ggx(roughness, glm::vec3(0), glm::vec3(1))));
            b.camera({ 0.7f, 0.1f, 0 }, { 0, 0, 0 }, { 0, 1, 0 }, 0.2f);
            addSky(b.scene, { even });
            render::Renderer renderer(b.scene, device, renderOptions());
            render::Settings s = sized(render::monteCarlo(1024), 16, 16);
            s.bounces = 8;
            // Of lobes at the ball's rim a tenth may still be below its faces. With normals that do not bend it is
            // 0.964.
            checkMean(renderPixels(renderer, s), even, 4e-3);
        }
    });
}
