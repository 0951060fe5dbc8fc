#include "host/scene/scene_file.h"

#include "host/scene/camera_section.h"
#include "host/scene/material_section.h"
#include "host/scene/scene_sections.h"
#include "host/scene/style_section.h"

#include <algorithm>

namespace wedge::scene {
namespace {

bool hasKeys(const std::vector<ShadowStyle>& styles)
{
    return std::ranges::any_of(styles, [](const ShadowStyle& style) { return !style.keys.empty(); });
}

bool stylesHaveKeys(const Scene& scene)
{
    const auto has = [](const auto& light) { return hasKeys(light.styles); };
    return std::ranges::any_of(scene.pointLights, has) || std::ranges::any_of(scene.directionalLights, has)
        || std::ranges::any_of(scene.areaLights, has);
}

/// All but the geometry.
Moment momentOf(const Scene& scene)
{
    return { scene.shutterOpen, scene.shutterClose, scene.camera, scene.cameraAtClose, scene.areaLights,
        scene.pointLights, scene.directionalLights, {} };
}

} // namespace

SceneFile::SceneFile(const std::string& text, const std::filesystem::path& path, const LoadOptions& options,
    Scene& scene, Warnings& warnings)
    : path_(path)
    , document_(parseToml(text, path_))
    , textures_(options.maxTexturePixels)
    , root_(document_, path_, "the scene")
{
    read(scene, warnings);
    start_ = momentOf(scene);
    settings_ = scene.settings;
}

void SceneFile::read(Scene& scene, Warnings& warnings)
{
    readImage(root_, scene);
    readIntegrator(root_, scene);
    readSequence(root_, scene);
    readBackground(root_, scene);
    readShutter(root_, scene);
    readLights(root_, scene, warnings);
    readExtensions(root_, scene, warnings);
    // Materials before the meshes that choose among them, meshes before the camera that may have to frame them.
    scene.materials = readMaterials(root_, textures_, warnings);
    for (const char* later : { "mesh", "camera" })
        root_.has(later);
    root_.finish(); // a wrong key is told before large meshes are read
    meshes_.emplace(root_, scene, textures_, warnings);
    meshes_->place(scene, warnings);
    checkObjectNames(root_, scene.geometry);
    readCamera(root_, scene, warnings);
    brought_ = lightsOfExtensions(scene);
    scene.areaLights.insert(scene.areaLights.end(), brought_.begin(), brought_.end());
    scene.textures = textures_.take();
    scene.onlyStylesChange = stylesHaveKeys(scene) && !hasOtherKeys();
}

bool SceneFile::hasOtherKeys()
{
    std::vector<TableReader> lights = root_.tables("light");
    std::optional<TableReader> camera = root_.table("camera");
    return meshes_->mayMove() || (camera && camera->has("key"))
        || std::ranges::any_of(lights, [](TableReader& light) { return light.has("key"); });
}

Moment SceneFile::at(double later)
{
    Scene scene;
    Warnings told; // with the scene itself
    scene.settings = settings_;
    scene.shutterOpen = start_.shutterOpen + later;
    scene.shutterClose = start_.shutterClose + later;
    readLights(root_, scene, told);
    scene.areaLights.insert(scene.areaLights.end(), brought_.begin(), brought_.end());
    const bool moves = meshes_->mayMove();
    if (moves)
        meshes_->place(scene, told);
    if (root_.has("camera")) {
        readCamera(root_, scene, told);
    } else {
        scene.camera = start_.camera;
    }
    Moment moment = momentOf(scene);
    if (moves)
        moment.geometry = std::move(scene.geometry);
    return moment;
}

} // namespace wedge::scene
