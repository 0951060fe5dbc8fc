#include "benchmarks/emissive/lamps.h"

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <random>

namespace wedge::benchmark {
namespace {

enum Materials : std::uint32_t { matt, glossy, glowing };

constexpr glm::vec3 radiance { 12, 11, 10 };
constexpr float halfSide = 0.25f;

void addQuad(scene::Scene& s, glm::vec3 centre, glm::vec3 u, glm::vec3 v, std::uint32_t material)
{
    scene::Geometry& g = s.geometry;
    const auto first = static_cast<std::uint32_t>(g.positions.size() / 3);
    for (const glm::vec3& corner : { centre - u - v, centre + u - v, centre + u + v, centre - u + v }) {
        g.positions.insert(g.positions.end(), { corner.x, corner.y, corner.z });
        g.normals.insert(g.normals.end(), { 0.0f, 0.0f, 0.0f });
        g.texcoords.insert(g.texcoords.end(), { 0.0f, 0.0f });
    }
    g.indices.insert(g.indices.end(), { first, first + 1, first + 2, first, first + 2, first + 3 });
    g.materialIds.insert(g.materialIds.end(), 2, material);
    g.objectIds.insert(g.objectIds.end(), 2, static_cast<std::uint32_t>(g.objectNames.size()));
}

void addBox(scene::Scene& s, glm::vec3 low, glm::vec3 high, std::uint32_t material)
{
    s.geometry.objectNames.emplace_back("box");
    const glm::vec3 centre = 0.5f * (low + high), half = 0.5f * (high - low);
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 out(0), u(0), v(0);
        out[axis] = half[axis];
        u[(axis + 1) % 3] = half[(axis + 1) % 3];
        v[(axis + 2) % 3] = half[(axis + 2) % 3];
        addQuad(s, centre + out, u, v, material);
        addQuad(s, centre - out, v, u, material);
    }
}

scene::Scene room()
{
    scene::Scene s;
    s.materials.resize(3);
    s.materials[matt].diffuse = glm::vec3(0.6f);
    s.materials[glossy].diffuse = { 0.4f, 0.5f, 0.3f };
    s.materials[glossy].specular = glm::vec3(0.3f);
    s.materials[glossy].exponent = 40;
    s.materials[glowing].diffuse = glm::vec3(0);
    s.materials[glowing].emission = radiance;
    s.geometry.objectNames = { "floor" };
    addQuad(s, { 0, 0, 0 }, { 0, 0, 3 }, { 3, 0, 0 }, matt);
    s.geometry.objectNames.emplace_back("wall");
    addQuad(s, { 0, 1.5f, -3 }, { 3, 0, 0 }, { 0, 1.5f, 0 }, matt);
    addBox(s, { -0.5f, 0, -0.4f }, { 0.1f, 0.6f, 0.2f }, glossy);
    addBox(s, { 0.7f, 0, -0.6f }, { 1.0f, 1.0f, -0.3f }, matt);
    s.camera.eye = { 0.6f, 1.6f, 4.2f };
    s.camera.lookAt = { 0, 0.6f, -0.2f };
    s.camera.verticalFov = 45;
    return s;
}

scene::Scene withLamps(const std::string& name, int count, bool meshes)
{
    scene::Scene s = room();
    s.path = name;
    std::mt19937 numbers(3);
    const auto within = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(std::ldexp(static_cast<double>(numbers()), -32));
    };
    const float half = halfSide / std::sqrt(static_cast<float>(count));
    for (int i = 0; i < count; ++i) {
        glm::vec3 centre { 0.3f, 1.9f, 0.2f };
        if (count > 1) {
            centre.x = within(-2, 2);
            centre.y = within(1.5f, 2.5f);
            centre.z = within(-2, 2);
        }
        if (meshes) {
            s.geometry.objectNames.emplace_back("lamp");
            addQuad(s, centre, { half, 0, 0 }, { 0, 0, half }, glowing);
            continue;
        }
        scene::AreaLight light;
        light.centre = centre;
        light.halfU = { half, 0, 0 };
        light.halfV = { 0, 0, half };
        light.radiance = radiance;
        light.profile = scene::LightProfile::Uniform;
        light.twoSided = true;
        s.areaLights.push_back(light);
    }
    return s;
}

} // namespace

std::vector<LampScene> lampScenes()
{
    std::vector<LampScene> out;
    out.push_back({ "quad", withLamps("quad", 1, false) });
    out.push_back({ "lamp", withLamps("lamp", 1, true) });
    out.push_back({ "thousand", withLamps("thousand", 1000, true) });
    out.push_back({ "quads64", withLamps("quads64", 64, false) });
    return out;
}

} // namespace wedge::benchmark
