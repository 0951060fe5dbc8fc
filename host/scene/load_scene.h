#pragma once

#include <filesystem>
#include <string>

#include "host/scene/scene.h"

namespace wedge::scene {

/// What loadScene does once a scene file is read. path: for messages, and what its files are relative to.
Scene parseScene(const std::string& text, const std::filesystem::path& path);

} // namespace wedge::scene
