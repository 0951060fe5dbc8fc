#pragma once

#include "host/scene/mesh_section.h"
#include "host/scene/scene.h"
#include "host/scene/sequence.h"
#include "host/scene/textures.h"
#include "host/scene/toml_reader.h"
#include "host/scene/warnings.h"

#include <filesystem>
#include <string>
#include <vector>

namespace wedge::scene {

/// A scene file's text, read once, of which more moments can be had.
class SceneFile {
public:
    /// Reads all of it into the scene, whose path and defaults are there. Scene and warnings must outlive this.
    SceneFile(const std::string& text, const std::filesystem::path& path, const LoadOptions& options, Scene& scene,
        Warnings& warnings);
    SceneFile(const SceneFile&) = delete;
    SceneFile& operator=(const SceneFile&) = delete;

    /// As Sequence::at().
    Moment at(double later);

private:
    void read(Scene& scene, Warnings& warnings);
    /// Whether anything has keys but styles of shadows.
    bool hasOtherKeys();

    std::filesystem::path path_;
    toml::table document_;
    TextureSet textures_;
    TableReader root_;
    std::optional<SceneMeshes> meshes_;
    Moment start_; ///< without geometry
    std::vector<AreaLight> brought_; ///< by extensions, as of the scene's bounds at the start
    Settings settings_;
};

} // namespace wedge::scene
