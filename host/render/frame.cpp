#include "host/render/frame.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wedge::render {
namespace {

/// A step near the golden section of count and coprime to it, so that the next one of many strips is distant.
std::uint32_t tileStep(std::uint32_t count)
{
    std::uint32_t step = std::max(1u, static_cast<std::uint32_t>(0.618034 * count));
    while (std::gcd(step, count) != 1) {
        ++step;
    }
    return step;
}

shared::Vec3 toVec3(glm::vec3 v) { return shared::vec3(v.x, v.y, v.z); }

struct Axes {
    glm::vec3 eye, forward, right, down; ///< as in FrameParams
};

/// height: of the image in pixels.
Axes axesOf(const scene::Camera& camera, std::uint32_t height)
{
    const glm::vec3 forward = glm::normalize(camera.lookAt - camera.eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
    const glm::vec3 down = -glm::cross(right, forward);
    // Pixels are square: the vertical field of view sets the step in both directions.
    const float step = 2.0f * std::tan(0.5f * glm::radians(camera.verticalFov)) / static_cast<float>(height);
    return { camera.eye, forward, right * step, down * step };
}

} // namespace

shared::FrameParams frameParams(
    const scene::Scene& scene, const PlaneLayout& layout, const image::Window& window, std::uint32_t seed)
{
    const Axes axes = axesOf(scene::middleCamera(scene), layout.imageHeight());
    shared::FrameParams p {};
    p.width = layout.width;
    p.height = layout.height;
    p.stride = layout.stride;
    p.planeSize = static_cast<std::uint32_t>(layout.size);
    setRectangle(p, window);
    p.tilesX = (p.x1 - p.x0 + WEDGE_TILE - 1) / WEDGE_TILE;
    p.tileCount = p.tilesX * ((p.y1 - p.y0 + WEDGE_TILE - 1) / WEDGE_TILE);
    p.tileStep = tileStep(p.tileCount / WEDGE_STRIP_TILES);
    p.seed = seed;
    p.eye = toVec3(axes.eye);
    p.forward = toVec3(axes.forward);
    p.right = toVec3(axes.right);
    p.down = toVec3(axes.down);
    p.background = toVec3(scene.background);
    p.margin = layout.margin;
    return p;
}

shared::CameraParams cameraParams(const scene::Scene& scene, std::uint32_t height, std::uint32_t pixelFilter)
{
    const scene::Camera& camera = scene.camera;
    const Axes open = axesOf(camera, height);
    const Axes close = axesOf(scene.cameraAtClose.value_or(camera), height);
    shared::CameraParams p {};
    p.eye = toVec3(open.eye);
    p.forward = toVec3(open.forward);
    p.right = toVec3(open.right);
    p.down = toVec3(open.down);
    p.eyeMotion = toVec3(close.eye - open.eye);
    p.forwardMotion = toVec3(close.forward - open.forward);
    p.rightMotion = toVec3(close.right - open.right);
    p.downMotion = toVec3(close.down - open.down);
    p.apertureRadius = camera.apertureRadius;
    p.focusDistance = scene::distanceInFocus(camera);
    p.gaussianAperture = camera.apertureProfile == scene::ApertureProfile::Gaussian ? 1 : 0;
    p.gaussianShutter = scene.shutterProfile == scene::ShutterProfile::Gaussian ? 1 : 0;
    p.pixelFilter = pixelFilter;
    p.erfCut = std::erf(WEDGE_APERTURE_CUT / std::sqrt(2.0f));
    p.shutter = scene::geometryMoves(scene) || scene::cameraMoves(scene) ? 1 : 0;
    p.pixelStep = glm::length(open.right);
    return p;
}

} // namespace wedge::render
