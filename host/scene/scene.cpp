#include "host/scene/scene.h"

namespace wedge::scene {
namespace {

template <class T>
std::size_t bytesOf(const std::vector<T>& v)
{
    return v.size() * sizeof(T);
}

} // namespace

Bounds sceneBounds(const Scene& scene)
{
    Bounds bounds;
    const std::vector<float>& p = scene.geometry.positions;
    for (const std::uint32_t index : scene.geometry.indices) {
        const std::size_t at = 3 * std::size_t { index };
        const glm::vec3 point(p[at], p[at + 1], p[at + 2]);
        bounds.lo = glm::min(bounds.lo, point);
        bounds.hi = glm::max(bounds.hi, point);
    }
    return bounds;
}

Summary summary(const Scene& scene)
{
    const Geometry& g = scene.geometry;
    Summary s;
    s.triangles = g.indices.size() / 3;
    s.vertices = g.positions.size() / 3;
    s.objects = g.objectNames.size();
    s.materials = scene.materials.size();
    s.textures = scene.textures.size();
    s.areaLights = scene.areaLights.size();
    s.pointLights = scene.pointLights.size();
    s.directionalLights = scene.directionalLights.size();
    s.geometryBytes = bytesOf(g.positions) + bytesOf(g.normals) + bytesOf(g.texcoords) + bytesOf(g.indices)
        + bytesOf(g.materialIds) + bytesOf(g.objectIds);
    for (const Texture& texture : scene.textures)
        s.textureBytes += bytesOf(texture.rgba);
    s.bounds = sceneBounds(scene);
    return s;
}

} // namespace wedge::scene
