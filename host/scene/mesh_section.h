#pragma once

#include "host/scene/mesh_files.h"
#include "host/scene/scene.h"
#include "host/scene/textures.h"
#include "host/scene/toml_reader.h"
#include "host/scene/warnings.h"

#include <vector>

namespace wedge::scene {

/// Every [[mesh]] of a scene file. The files are read once, and instances can be placed as of any number of times.
class SceneMeshes {
public:
    /// Reads the files and adds their materials to the scene, behind those that are already there, which a mesh may
    /// choose by name. All that is handed over must outlive this.
    SceneMeshes(TableReader& root, Scene& scene, TextureSet& textures, Warnings& warnings);

    /// Adds all instances to the scene's geometry, as they are when its shutter opens and closes. scene: the one of
    /// the constructor, or one with its materials.
    void place(Scene& scene, Warnings& warnings);

    /// Whether any of them has keys or shapes.
    bool mayMove();

private:
    /// A [[mesh]] whose file is read.
    struct MeshTable {
        TableReader table;
        const MeshFiles::Entry& entry;
    };

    void readFiles(TableReader& root, Warnings& warnings);

    MeshFiles files_;
    std::vector<MeshTable> meshes_;
    std::vector<Material> named_; ///< the scene file's own
};

} // namespace wedge::scene
