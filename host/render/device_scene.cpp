#include "host/render/device_scene.h"

#include "host/render/effect.h"
#include "host/render/glass.h"
#include "host/render/quadrature.h"
#include "kernels/shared/bsdf.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>

namespace wedge::render {
namespace {

shared::Vec3 toVec3(glm::vec3 v) { return shared::vec3(v.x, v.y, v.z); }

std::uint32_t textureId(int index) { return index < 0 ? WEDGE_NO_TEXTURE : static_cast<std::uint32_t>(index); }

/// The mean of the profile over one axis: its integral over [-1, 1], halved.
double profileMean(const scene::AreaLight& light)
{
    if (light.profile == scene::LightProfile::Uniform) {
        return 1.0;
    }
    const double cut = light.cut;
    return std::sqrt(std::acos(-1.0) / 2.0) * std::erf(cut / std::sqrt(2.0)) / cut;
}

std::vector<shared::MaterialData> materialData(const scene::Scene& scene)
{
    std::vector<shared::MaterialData> out;
    const std::vector<std::uint32_t> nesting = nestings(scene);
    for (const scene::Material& m : scene.materials) {
        shared::MaterialData d {};
        d.diffuse = toVec3(m.diffuse);
        d.specular = toVec3(m.specular);
        d.emission = toVec3(m.emission);
        d.kind = kindOf(m);
        d.exponent = d.kind == WEDGE_MICROFACETS ? m.roughness : m.exponent;
        if (d.kind == WEDGE_MIRROR || d.kind == WEDGE_GLASS) {
            d.diffuse = toVec3(m.transmission);
            d.exponent = m.index;
            d.medium = mediumOf(scene, static_cast<std::uint32_t>(out.size()));
            d.nesting = nesting[out.size()];
        }
        d.diffuseTexture = textureId(m.diffuseTexture);
        d.specularTexture = textureId(m.specularTexture);
        d.exponentTexture = textureId(m.exponentTexture);
        d.emissionTexture = textureId(m.emissionTexture);
        d.normalTexture = textureId(m.normalTexture);
        d.normalIsHeight = m.normalIsHeight ? 1 : 0;
        d.normalStrength = m.normalStrength;
        out.push_back(d);
    }
    return out;
}

std::size_t texelCount(const scene::Scene& scene)
{
    std::size_t count = 0;
    for (const scene::Texture& t : scene.textures) {
        count += t.rgba.size();
    }
    return count;
}

std::vector<shared::DeltaLight> deltaLightData(const scene::Scene& scene)
{
    std::vector<shared::DeltaLight> out;
    for (const scene::PointLight& light : scene.pointLights) {
        out.push_back({ toVec3(light.position), 0, toVec3(light.intensity), 0 });
    }
    for (const scene::DirectionalLight& light : scene.directionalLights) {
        out.push_back({ toVec3(-light.direction), 1, toVec3(light.irradiance), 0 });
    }
    return out;
}

/// Of these, which are all of the scene's, those whose shadows have no style.
std::vector<shared::DeltaLight> plainLightData(const scene::Scene& scene, const std::vector<shared::DeltaLight>& all)
{
    std::vector<shared::DeltaLight> out;
    out.reserve(all.size());
    const std::size_t points = scene.pointLights.size();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool plain =
            i < points ? scene.pointLights[i].styles.empty() : scene.directionalLights[i - points].styles.empty();
        if (plain) {
            out.push_back(all[i]);
        }
    }
    return out;
}

constexpr double farDiameters = 16.0;

/// Probabilities of what is not in a list of lights.
struct Shares {
    float emitters, environment;
};

/// Probabilities with which path vertices choose each light: by what it sends out, so that strong ones are sampled
/// more. A directional light counts with what falls on the scene, and so does what is beyond it, and what is farther
/// away than `farDiameters` of the scene. emitters: power of the meshes that emit. environment: luminance over all
/// directions.
Shares setPicks(std::vector<shared::AreaLight>& area, std::vector<shared::DeltaLight>& delta, double emitters,
    double environment, const scene::Bounds& bounds, float diameter)
{
    const double beyond = environment * diameter * diameter;
    const glm::vec3 middle = bounds.empty() ? glm::vec3(0.0f) : 0.5f * (bounds.lo + bounds.hi);
    const auto powerOf = [&](const shared::AreaLight& l) {
        const double power = double { shared::luminance(l.power) } * (l.twoSided != 0 ? 2.0 : 1.0);
        const double away = glm::length(glm::vec3(l.centre.x, l.centre.y, l.centre.z) - middle) / diameter;
        return away > farDiameters ? power / (away * away) : power;
    };
    const auto fluxOf = [&](const shared::DeltaLight& l) {
        return shared::luminance(l.colour) * (l.directional != 0 ? diameter * diameter : 4.0f);
    };
    double total = emitters + beyond;
    for (const shared::AreaLight& l : area) {
        total += powerOf(l);
    }
    for (const shared::DeltaLight& l : delta) {
        total += fluxOf(l);
    }
    const double scale = total > 0 ? 1.0 / total : 0.0;
    for (shared::AreaLight& l : area) {
        l.pick = static_cast<float>(powerOf(l) * scale);
    }
    for (shared::DeltaLight& l : delta) {
        l.pick = static_cast<float>(fluxOf(l) * scale);
    }
    return { static_cast<float>(emitters * scale), static_cast<float>(beyond * scale) };
}

/// What the bytes of textures mean: those of colours, which are sRGB-encoded, then those of plain numbers.
std::array<float, 512> texelTable()
{
    std::array<float, 512> table {};
    for (std::size_t i = 0; i < 256; ++i) {
        const double v = static_cast<double>(i) / 255.0;
        table[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
        table[256 + i] = static_cast<float>(v);
    }
    return table;
}

} // namespace

std::uint32_t kindOf(const scene::Material& m)
{
    if (m.specularModel == scene::SpecularModel::Mirror) {
        return WEDGE_MIRROR;
    }
    if (m.specularModel == scene::SpecularModel::Glass) {
        return WEDGE_GLASS;
    }
    if (m.specular == glm::vec3(0.0f)) {
        return WEDGE_LAMBERT;
    }
    switch (m.specularModel) {
    case scene::SpecularModel::Phong:
        return WEDGE_PHONG;
    case scene::SpecularModel::BlinnPhong:
        return WEDGE_BLINN_PHONG;
    case scene::SpecularModel::Ggx:
        return WEDGE_MICROFACETS;
    case scene::SpecularModel::Mirror:
    case scene::SpecularModel::Glass:
        break;
    }
    return WEDGE_LAMBERT;
}

double profileArea(const scene::AreaLight& light)
{
    const double mean = profileMean(light);
    return 4.0 * glm::length(glm::cross(light.halfU, light.halfV)) * mean * mean;
}

shared::AreaLight deviceLight(const scene::AreaLight& light)
{
    const double halfU = glm::length(light.halfU);
    const double halfV = glm::length(light.halfV);
    const glm::vec3 normal = glm::cross(light.halfU, light.halfV);
    const double area = profileArea(light);
    const bool gaussian = light.profile == scene::LightProfile::Gaussian;
    shared::AreaLight d {};
    d.centre = toVec3(light.centre);
    d.halfU = toVec3(light.halfU);
    d.halfV = toVec3(light.halfV);
    d.normal = toVec3(glm::normalize(normal));
    d.cut = gaussian ? light.cut : 1.0f;
    d.erfCut = static_cast<float>(std::erf(d.cut / std::sqrt(2.0)));
    // A uniform light counts as a Gaussian cut at one standard deviation, side 2 sigma as in A_l = (2 sigma)^2.
    d.sigma = static_cast<float>(std::sqrt(halfU * halfV) / d.cut);
    d.profile = gaussian ? WEDGE_PROFILE_GAUSSIAN : WEDGE_PROFILE_UNIFORM;
    d.power = toVec3(light.radiance * static_cast<float>(area));
    d.radiance = toVec3(light.radiance);
    d.profileArea = static_cast<float>(area);
    d.twoSided = light.twoSided ? 1 : 0;
    d.visible = light.visible ? 1 : 0;
    d.sharedPick = WEDGE_PICK_ELSEWHERE;
    return d;
}

void DeviceScene::plan(device::MemoryPlan& plan, const PreparedScene& scene, const Hierarchy& hierarchy)
{
    const scene::Geometry& g = scene.geometry;
    const SceneLights& lights = scene.lights();
    plan.addItems("BVH nodes", hierarchy.nodes().size(), 1);
    plan.addItems("triangle blocks", hierarchy.blocks().size(), 1);
    plan.addItems("positions", g.positions.size(), sizeof(float));
    plan.addItems("normals", g.normals.size(), sizeof(float));
    plan.addItems("texture coordinates", g.texcoords.size(), sizeof(float));
    plan.addItems("indices", g.indices.size(), sizeof(std::uint32_t));
    plan.addItems("material ids", g.materialIds.size(), sizeof(std::uint32_t));
    plan.addItems("object ids", g.objectIds.size(), sizeof(std::uint32_t));
    plan.addItems("materials", scene.materials.size(), sizeof(shared::MaterialData));
    plan.addItems("texels", texelCount(scene), sizeof(std::uint32_t));
    if (const EmitterList& list = lights.emitters; !list.list.empty()) {
        plan.addItems("emitters", list.list.size(), sizeof(shared::Emitter));
        plan.addItems("emitters' probabilities", list.picks.size(), sizeof(float));
    }
    if (const EmitterList& list = lights.shared; !list.list.empty()) {
        plan.addItems("shared lights", list.list.size(), sizeof(shared::Emitter));
        plan.addItems("shared lights' probabilities", list.picks.size(), sizeof(float));
    }
    if (!lights.beyond->numbers.empty()) {
        plan.addItems("environment's table", lights.beyond->numbers.size(), sizeof(float));
    }
    if (scene.traits().moves) {
        plan.addItems("positions at closing", g.positionsAtClose.size(), sizeof(float));
        plan.addItems("normals at closing", g.normalsAtClose.size(), sizeof(float));
    }
}

DeviceScene::DeviceScene(
    const PreparedScene& scene, const Hierarchy& hierarchy, const device::Device& device, device::TimedQueue& queue)
    : nodes(device::Buffer<std::byte>::readOnly(device, queue, hierarchy.nodes(), "BVH nodes"))
    , blocks(device::Buffer<std::byte>::readOnly(device, queue, hierarchy.blocks(), "triangle blocks"))
    , positions(device::Buffer<float>::readOnly(device, queue, scene.geometry.positions, "positions"))
    , normals(device::Buffer<float>::readOnly(device, queue, scene.geometry.normals, "normals"))
    , texcoords(device::Buffer<float>::readOnly(device, queue, scene.geometry.texcoords, "texture coordinates"))
    , positionsAtClose(
          device::Buffer<float>::readOnly(device, queue, scene.geometry.positionsAtClose, "positions at closing"))
    , normalsAtClose(
          device::Buffer<float>::readOnly(device, queue, scene.geometry.normalsAtClose, "normals at closing"))
    , indices(device::Buffer<std::uint32_t>::readOnly(device, queue, scene.geometry.indices, "indices"))
    , materialIds(device::Buffer<std::uint32_t>::readOnly(device, queue, scene.geometry.materialIds, "material ids"))
    , objectIds(device::Buffer<std::uint32_t>::readOnly(device, queue, scene.geometry.objectIds, "object ids"))
    , materials(device, scene.materials.size(), "materials")
    , textures(device, scene.textures.size(), "textures")
    , texels(device, texelCount(scene), "texels")
    , srgbToLinear(device, 512, "sRGB table")
    , areaLights(device, scene.areaLights.size(), "area lights")
    , deltaLights(device, scene.pointLights.size() + scene.directionalLights.size(), "point and directional lights")
    , plainLights(device, deltaLights.size(), "lights without a style")
    , emitters(device, scene.lights().emitters.list.size(), "emitters")
    , sharedLights(device, scene.lights().shared.list.size(), "shared lights")
    , emitterPicks(device, scene.lights().emitters.picks.size(), "emitters' probabilities")
    , sharedPicks(device, scene.lights().shared.picks.size(), "shared lights' probabilities")
    , environment(device, 1, "environment")
    , environmentTable(device, scene.lights().beyond->numbers.size(), "environment's table")
    , environmentBandwidth(scene.picture())
{
    const SceneLights& lights = scene.lights();
    materials.upload(queue, materialData(scene));
    std::vector<shared::TextureData> infos;
    std::size_t offset = 0;
    for (const scene::Texture& t : scene.textures) {
        infos.push_back({ static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(t.width),
            static_cast<std::uint32_t>(t.height), 0 });
        texels.upload(queue, t.rgba, offset);
        offset += t.rgba.size();
    }
    textures.upload(queue, infos);
    srgbToLinear.upload(queue, texelTable());
    for (const scene::AreaLight& light : scene.areaLights) {
        areaLightList.push_back(deviceLight(light));
        areaLightList.back().lift = scene.directLights().lifts[areaLightList.size() - 1];
    }
    for (std::size_t i = 0; i < lights.shared.quadPicks.size(); ++i) {
        areaLightList[i].sharedPick = lights.shared.quadPicks[i];
    }
    for (const OwnLight& light : scene.directLights().own) {
        const std::vector<float> rule = lightNodes(light.quad);
        quadratures.emplace_back(device, rule.size(), "light quadrature");
        quadratures.back().upload(queue, rule);
    }
    std::vector<shared::DeltaLight> delta = deltaLightData(scene);
    const scene::Bounds bounds = scene::sceneBounds(scene);
    const glm::vec3 extent = bounds.empty() ? glm::vec3(1.0f) : bounds.hi - bounds.lo;
    diameter = bounds.empty() ? 1.0f : glm::length(extent);
    largestDimension = std::max({ extent.x, extent.y, extent.z });
    const Shares shares =
        setPicks(areaLightList, delta, lights.emitters.power, lights.beyond->irradiance, bounds, diameter);
    emitterShare = shares.emitters;
    environmentShare = shares.environment;
    environment.upload(queue, std::span(&lights.beyond->map, 1));
    environmentTable.upload(queue, lights.beyond->numbers);
    emitters.upload(queue, lights.emitters.list);
    emitterPicks.upload(queue, lights.emitters.picks);
    emitterCount = lights.emitters.count;
    sharedLights.upload(queue, lights.shared.list);
    sharedPicks.upload(queue, lights.shared.picks);
    const EmitterList& ofTerm = scene.ofSharedTerm();
    sharedTerm = { .ofEmitters = scene.directLights().shareEmitters(),
        .quads = !scene.directLights().sharedQuads.empty(),
        .count = ofTerm.count,
        .low = ofTerm.low,
        .high = ofTerm.high,
        .directedWithin = ofTerm.directedWithin };
    areaLights.upload(queue, areaLightList);
    deltaLights.upload(queue, delta);
    deltaLightCount = static_cast<std::uint32_t>(delta.size());
    const std::vector<shared::DeltaLight> plain = plainLightData(scene, delta);
    plainLights.upload(queue, plain);
    plainLightCount = static_cast<std::uint32_t>(plain.size());
    assert(scene.traits().moves == hierarchy.moves);
}

} // namespace wedge::render
