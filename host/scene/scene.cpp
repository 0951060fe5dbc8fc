#include "host/scene/scene.h"

namespace wedge::scene {
namespace {

template <class T>
std::size_t bytesOf(const std::vector<T>& v)
{
    return v.size() * sizeof(T);
}

glm::vec3 vertexAt(const std::vector<float>& p, std::size_t vertex)
{
    return { p[3 * vertex], p[3 * vertex + 1], p[3 * vertex + 2] };
}

std::size_t movingTriangles(const Geometry& g)
{
    std::size_t count = 0;
    for (std::size_t i = 0; !g.positionsAtClose.empty() && i < g.indices.size(); i += 3) {
        bool moves = false;
        for (std::size_t c = i; c < i + 3; ++c)
            moves = moves || vertexAt(g.positions, g.indices[c]) != vertexAt(g.positionsAtClose, g.indices[c]);
        count += moves;
    }
    return count;
}

} // namespace

float distanceInFocus(const Camera& camera)
{
    return camera.focusDistance > 0.0f ? camera.focusDistance : glm::distance(camera.eye, camera.lookAt);
}

Camera middleCamera(const Scene& scene)
{
    Camera camera = scene.camera;
    if (cameraMoves(scene)) {
        const Camera& close = *scene.cameraAtClose;
        camera.eye = 0.5f * (camera.eye + close.eye);
        camera.lookAt = 0.5f * (camera.lookAt + close.lookAt);
        camera.up = 0.5f * (camera.up + close.up);
    }
    return camera;
}

const char* profileName(ApertureProfile profile)
{
    return profile == ApertureProfile::Gaussian ? "gaussian" : "uniform";
}

const char* profileName(ShutterProfile profile) { return profile == ShutterProfile::Gaussian ? "gaussian" : "box"; }

Bounds sceneBounds(const Scene& scene)
{
    Bounds bounds;
    for (const std::vector<float>* p : { &scene.geometry.positions, &scene.geometry.positionsAtClose }) {
        for (std::size_t i = 0; !p->empty() && i < scene.geometry.indices.size(); ++i) {
            const glm::vec3 point = vertexAt(*p, scene.geometry.indices[i]);
            bounds.lo = glm::min(bounds.lo, point);
            bounds.hi = glm::max(bounds.hi, point);
        }
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
        + bytesOf(g.materialIds) + bytesOf(g.objectIds) + bytesOf(g.positionsAtClose) + bytesOf(g.normalsAtClose);
    s.movingTriangles = movingTriangles(g);
    for (const Texture& texture : scene.textures)
        s.textureBytes += bytesOf(texture.rgba);
    s.bounds = sceneBounds(scene);
    return s;
}

} // namespace wedge::scene
