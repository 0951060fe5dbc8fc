#include "benchmarks/common/fingerprint.h"

#include "host/render/effect.h"

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

void add(Fingerprint& f, const glm::vec3& v)
{
    f.add(v.x);
    f.add(v.y);
    f.add(v.z);
}

void add(Fingerprint& f, const scene::Material& m)
{
    add(f, m.diffuse);
    add(f, m.specular);
    add(f, m.emission);
    f.add(m.exponent);
    f.add(static_cast<int>(m.specularModel));
    for (const int texture : { m.diffuseTexture, m.specularTexture, m.exponentTexture, m.emissionTexture }) {
        f.add(texture);
    }
    if (m.opacity < 1.0f || m.opacityTexture >= 0) {
        f.add(m.opacity);
        f.add(m.opacityTexture);
    }
}

void add(Fingerprint& f, const scene::AreaLight& l)
{
    for (const glm::vec3& v : { l.centre, l.halfU, l.halfV, l.radiance }) {
        add(f, v);
    }
    f.add(static_cast<int>(l.profile));
    f.add(l.cut);
    f.add(l.twoSided);
    f.add(l.visible);
}

void add(Fingerprint& f, const scene::Camera& c)
{
    for (const glm::vec3& v : { c.eye, c.lookAt, c.up }) {
        add(f, v);
    }
    for (const float value : { c.verticalFov, c.apertureRadius, c.focusDistance }) {
        f.add(value);
    }
    f.add(static_cast<int>(c.apertureProfile));
}

void addLights(Fingerprint& f, const scene::Scene& scene)
{
    for (const scene::AreaLight& light : scene.areaLights) {
        add(f, light);
    }
    for (const scene::PointLight& light : scene.pointLights) {
        add(f, light.position);
        add(f, light.intensity);
    }
    for (const scene::DirectionalLight& light : scene.directionalLights) {
        add(f, light.direction);
        add(f, light.irradiance);
    }
}

/// Radiance, axes, and whether the camera sees it.
void add(Fingerprint& f, const render::EnvironmentPicture& picture)
{
    f.add(picture.width);
    f.add(picture.height);
    f.add(std::span<const float>(picture.radiance));
    for (const glm::vec3& axis : { picture.right, picture.up, picture.back }) {
        add(f, axis);
    }
    f.add(picture.seen);
    if (!picture.shown.empty()) {
        f.add(std::span<const float>(picture.shown));
    }
}

} // namespace

void Fingerprint::add(std::string_view text)
{
    add(text.size());
    hash_.addBytes(text.data(), text.size());
}

std::string Fingerprint::text() const { return fmt::format("{:016x}", hash_.value()); }

void add(Fingerprint& f, const scene::Scene& scene)
{
    const scene::Geometry& g = scene.geometry;
    for (const std::vector<float>* floats :
        { &g.positions, &g.normals, &g.texcoords, &g.positionsAtClose, &g.normalsAtClose }) {
        f.add(std::span<const float>(*floats));
    }
    for (const std::vector<std::uint32_t>* ids : { &g.indices, &g.materialIds, &g.objectIds }) {
        f.add(std::span<const std::uint32_t>(*ids));
    }
    for (const scene::Material& material : scene.materials) {
        add(f, material);
    }
    for (const scene::Texture& texture : scene.textures) {
        f.add(texture.width);
        f.add(texture.height);
        f.add(std::span<const std::uint32_t>(texture.rgba));
    }
    f.add(scene.areaLights.size());
    f.add(scene.pointLights.size());
    addLights(f, scene);
    add(f, scene.background);
    if (const auto picture = render::pictureOf(scene)) {
        add(f, *picture);
    }
    add(f, scene.camera);
    if (scene.cameraAtClose) {
        add(f, *scene.cameraAtClose);
    }
    f.add(static_cast<int>(scene.shutterProfile));
}

} // namespace wedge::benchmark
