#include "host/render/metadata.h"

#include <cmath>

namespace wedge::render {
namespace {

struct CameraBasis {
    glm::vec3 right, up, forward;
};

CameraBasis basisOf(const scene::Camera& camera)
{
    const glm::vec3 forward = glm::normalize(camera.lookAt - camera.eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
    return { right, glm::cross(right, forward), forward };
}

} // namespace

const char* version() { return WEDGE_VERSION; }

std::array<float, 16> worldToCamera(const scene::Camera& camera)
{
    const CameraBasis b = basisOf(camera);
    const glm::vec3 eye = camera.eye;
    return { b.right.x, b.up.x, b.forward.x, 0, //
        b.right.y, b.up.y, b.forward.y, 0, //
        b.right.z, b.up.z, b.forward.z, 0, //
        -glm::dot(b.right, eye), -glm::dot(b.up, eye), -glm::dot(b.forward, eye), 1 };
}

std::array<float, 16> worldToNdc(const scene::Camera& camera, int width, int height)
{
    // The columns are linear forms of the world point: x' = 0.5 w + right / (2 tan), y' = 0.5 w - up / (2 tan),
    // z' = w - 1, w' = distance along the view.
    const std::array<float, 16> c = worldToCamera(camera);
    const float halfHeight = std::tan(0.5f * glm::radians(camera.verticalFov));
    const float halfWidth = halfHeight * static_cast<float>(width) / static_cast<float>(height);
    std::array<float, 16> m {};
    for (std::size_t row = 0; row < 4; ++row) {
        const float x = c[4 * row], y = c[4 * row + 1], z = c[4 * row + 2];
        m[4 * row] = 0.5f * z + 0.5f * x / halfWidth;
        m[4 * row + 1] = 0.5f * z - 0.5f * y / halfHeight;
        m[4 * row + 2] = z - (row == 3 ? 1.0f : 0.0f);
        m[4 * row + 3] = z;
    }
    return m;
}

std::map<std::string, image::MetadataValue> frameMetadata(
    const Renderer& renderer, const Settings& settings, const FrameStatistics& statistics)
{
    const scene::Camera camera = scene::middleCamera(renderer.scene());
    const device::DeviceInfo& device = renderer.device().info();
    std::map<std::string, image::MetadataValue> out;
    out["wedgeVersion"] = std::string(version());
    out["scene"] = renderer.scene().path;
    out["worldToCamera"] = worldToCamera(camera);
    out["worldToNDC"] = worldToNdc(camera, settings.width, settings.height);
    out["renderTimeSeconds"] = static_cast<float>(1e-3 * statistics.wallMilliseconds);
    out["samplesPerPixel"] = static_cast<float>(statistics.sppMean);
    // As text: an int attribute is signed, and a seed has all 32 bits.
    out["seed"] = std::to_string(settings.seed);
    if (settings.frame) {
        out["frame"] = static_cast<int>(*settings.frame);
    }
    out["complete"] = statistics.complete ? 1 : 0;
    out["device"] = device.name;
    out["driver"] = device.platform + " " + device.driver;
    out["buildOptions"] = renderer.buildOptions();
    out["traversal"] = traversalName(renderer.traversal());
    out["depthConvention"] = std::string(renderer.frame().distributed
            ? "distance from the lens' centre to the mean of the points hit in metres, +inf on a miss"
            : "distance along the ray from the camera in metres, +inf on a miss");
    out["primarySamplesPerPixel"] = static_cast<float>(statistics.primarySpp);
    out["apertureRadius"] = camera.apertureRadius;
    out["focusDistance"] = scene::distanceInFocus(renderer.scene().camera);
    out["apertureProfile"] = std::string(scene::profileName(camera.apertureProfile));
    out["shutterOpen"] = static_cast<float>(renderer.scene().shutterOpen);
    out["shutterClose"] = static_cast<float>(renderer.scene().shutterClose);
    out["shutterProfile"] = std::string(scene::profileName(renderer.scene().shutterProfile));
    for (const auto& [name, value] : describe(settings)) {
        out[name == "method" ? name : "method." + name] = value;
    }
    out["method.antialias"] = std::string(settings.antialias ? "true" : "false");
    return out;
}

} // namespace wedge::render
