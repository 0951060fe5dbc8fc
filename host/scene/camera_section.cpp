#include "host/scene/camera_section.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "host/scene/camera_framing.h"
#include "host/scene/keyframes.h"
#include "host/scene/rounding.h"
#include "host/scene/validate.h"

namespace wedge::scene {
namespace {

/// Of the way from eye to look_at so much may be off at either end.
constexpr double viewOff = 1e-3;

/// Where the camera is, and where it looks.
struct View {
    glm::vec3 eye, lookAt;
};

/// What of a table has no value here is `otherwise`. Warns where single precision shows.
View readView(TableReader& table, const View& otherwise, Warnings& warnings)
{
    const glm::dvec3 eye = table.point("eye").value_or(glm::dvec3(otherwise.eye));
    const glm::dvec3 lookAt = table.point("look_at").value_or(glm::dvec3(otherwise.lookAt));
    const double size = viewOff * glm::distance(eye, lookAt);
    for (const auto& [key, place] : { std::pair("eye", eye), std::pair("look_at", lookAt) })
        warnOfRounding(place, size, table.where(key), fmt::format("camera's {}", key), warnings);
    return { glm::vec3(eye), glm::vec3(lookAt) };
}

void readLens(TableReader& table, Camera& camera)
{
    camera.apertureRadius = static_cast<float>(table.number("aperture", 0.0, mostAperture).value_or(0.0));
    camera.focusDistance = static_cast<float>(table.number("focus", leastFocus, mostFocus).value_or(0.0));
    if (table.choice("aperture_profile", { "uniform", "gaussian" }).value_or("uniform") == "gaussian")
        camera.apertureProfile = ApertureProfile::Gaussian;
}

/// Where the camera stands and looks at the time of each of its keys.
struct CameraKeys {
    std::vector<double> times;
    std::vector<Camera> cameras;
};

/// A key has from the camera's table what it does not say itself.
CameraKeys readKeys(TableReader& table, const Camera& camera, Warnings& warnings)
{
    CameraKeys keys;
    for (TableReader& key : table.tables("key")) {
        keys.times.push_back(readKeyTime(key, keys.times));
        Camera posed = camera;
        const View view = readView(key, { camera.eye, camera.lookAt }, warnings);
        posed.eye = view.eye;
        posed.lookAt = view.lookAt;
        posed.up = glm::vec3(key.vector("up").value_or(glm::dvec3(camera.up)));
        key.finish();
        keys.cameras.push_back(posed);
    }
    return keys;
}

glm::vec3 between(const glm::vec3& a, const glm::vec3& b, double weight)
{
    // In double precision, so that rounding to single gives a back where both are the same: rest is no motion.
    return glm::vec3(glm::mix(glm::dvec3(a), glm::dvec3(b), weight));
}

Camera cameraAt(double time, const Camera& camera, const CameraKeys& keys, const std::string& where)
{
    Camera posed = camera;
    if (!keys.times.empty()) {
        const KeySpan span = spanAt(keys.times, time);
        const Camera &a = keys.cameras[span.from], &b = keys.cameras[span.to];
        posed.eye = between(a.eye, b.eye, span.weight);
        posed.lookAt = between(a.lookAt, b.lookAt, span.weight);
        posed.up = between(a.up, b.up, span.weight);
    }
    checkCamera(posed, keys.times.empty() ? where : fmt::format("{}: at time {:g}", where, time));
    posed.up = glm::vec3(glm::normalize(glm::dvec3(posed.up))); // its length may be beyond single precision
    return posed;
}

} // namespace

void readShutter(TableReader& root, Scene& scene)
{
    auto table = root.table("shutter");
    if (!table)
        return;
    scene.shutterOpen = table->number("open").value_or(0.0);
    scene.shutterClose = table->require("close", table->number("close"));
    if (scene.shutterClose < scene.shutterOpen)
        table->fail("close", "is before open", fmt::format("{:g} and {:g}", scene.shutterClose, scene.shutterOpen),
            "close it when it opens or later");
    if (table->choice("profile", { "box", "gaussian" }).value_or("box") == "gaussian")
        scene.shutterProfile = ShutterProfile::Gaussian;
    table->finish();
}

void readCamera(TableReader& root, Scene& scene, Warnings& warnings)
{
    auto table = root.table("camera");
    if (!table) {
        scene.camera = frameBounds(sceneBounds(scene), double(scene.settings.width) / scene.settings.height);
        return;
    }
    Camera& camera = scene.camera;
    for (const char* key : { "eye", "look_at" })
        table->require(key, table->point(key));
    const View view = readView(*table, {}, warnings);
    camera.eye = view.eye;
    camera.lookAt = view.lookAt;
    camera.up = glm::vec3(table->vector("up").value_or(glm::dvec3(camera.up)));
    camera.verticalFov = static_cast<float>(table->number("fov").value_or(double { camera.verticalFov }));
    readLens(*table, camera);
    const CameraKeys keys = readKeys(*table, camera, warnings);
    table->finish();
    const std::string where = root.where("camera");
    const Camera own = camera;
    camera = cameraAt(scene.shutterOpen, own, keys, where);
    Camera atClose = cameraAt(scene.shutterClose, own, keys, where);
    if (camera.eye == atClose.eye && camera.lookAt == atClose.lookAt && camera.up == atClose.up)
        return;
    if (camera.focusDistance == 0.0f) // the lens does not change while the shutter is open
        camera.focusDistance = glm::distance(camera.eye, camera.lookAt);
    atClose.focusDistance = camera.focusDistance;
    scene.cameraAtClose = atClose;
}

} // namespace wedge::scene
