#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "host/scene/scene.h"
#include "host/scene/scene_file.h"

namespace wedge::scene {

/// What loadScene does once a scene file is read. path: for messages, and what its files are relative to.
Scene parseScene(const std::string& text, const std::filesystem::path& path);

/// As loadScene(), into a new scene. Returns the scene file, of which more moments can be had; null for a bare mesh.
/// Scene and warnings must outlive it.
std::unique_ptr<SceneFile> readScene(
    const std::string& path, const LoadOptions& options, Scene& scene, Warnings& warnings);

} // namespace wedge::scene
